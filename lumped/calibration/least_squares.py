"""Springs that meet the moduli as nearly as they can: bounded least squares on A, D and S.

For cells that are not square, more than two layers, or a layer distance that is given, where the closed
form does not apply. Links are kept nonnegative; area springs are free. Residuals are relative to the
sheet's own moduli (off-diagonal terms to D11 and A11). Bending and shear weigh more than stretching,
since a soft sheet bends first.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import least_squares

from lumped import moduli
from lumped.calibration.calibration import plan_spacing
from lumped.lattice import Grid
from scenes import Material, PerDirection, Sheet, SpringSet

BENDING_WEIGHT, SHEAR_WEIGHT, MEMBRANE_WEIGHT = 1.0, 1.0, 0.3


def bounded_least_squares(
    sheet: Sheet, material: Material, grid: Grid, layer_distance: float | None = None
) -> tuple[SpringSet, tuple[str, ...]]:
    """Springs and notes on every modulus missed by more than 1 % (D12, A12 as shares of D11, A11).

    Unknowns: axial and cross along x and y, diagonal, cross_diagonal ≥ 0; area, mid_area of any sign; the
    layer distance unless given. kz = 4 × the layer's stiffness, as in the closed form.
    """
    lx, ly = plan_spacing(sheet, grid)
    layers = grid[2]
    asked = moduli.of_sheet(sheet, material, (lx, ly))
    heights = np.arange(layers) - (layers - 1) / 2
    thickness_scale = sheet.thickness / (layers - 1)

    def springs_of(unknowns: np.ndarray) -> SpringSet:
        distance = layer_distance if layer_distance is not None else thickness_scale * np.exp(unknowns[8])
        stiffness = asked.bending[0, 0] / ((heights**2).sum() * distance**2)
        x_axial, y_axial, diagonal, x_cross, y_cross, cross_diagonal, area, mid_area = (
            stiffness * unknowns[:8]
        )
        return SpringSet(
            axial=PerDirection(x=x_axial, y=y_axial),
            diagonal=diagonal,
            vertical=4.0 * stiffness,
            cross=PerDirection(x=x_cross, y=y_cross),
            cross_diagonal=cross_diagonal,
            area=area,
            mid_area=mid_area,
            layer_distance=distance,
        )

    upper = np.triu_indices(2)

    def misses(unknowns: np.ndarray) -> np.ndarray:
        springs = springs_of(unknowns)
        got = moduli.of_springs(springs, (lx, ly, springs.layer_distance), layers)
        rows = []
        for mine, theirs, weight in (
            (got.bending, asked.bending, BENDING_WEIGHT),
            (got.membrane, asked.membrane, MEMBRANE_WEIGHT),
        ):
            in_plane = (mine - theirs)[:2, :2][upper] / theirs[0, 0]
            twist = (mine[2, 2] - theirs[2, 2]) / theirs[2, 2]
            rows.append(weight * np.append(in_plane, twist))
        rows.append(SHEAR_WEIGHT * (got.shear - asked.shear) / asked.shear)
        return np.concatenate(rows)

    start = np.array(
        [0.5, 0.5, 0.25, 0.5, 0.5, 0.25, 0.1, 0.1] + ([] if layer_distance is not None else [0.0])
    )
    low = np.array([0.0] * 6 + [-np.inf] * 2 + ([] if layer_distance is not None else [-2.0]))
    high = np.array([np.inf] * 8 + ([] if layer_distance is not None else [2.0]))
    best = least_squares(misses, start, bounds=(low, high), xtol=1e-14, ftol=1e-14, gtol=1e-14, max_nfev=2000)
    springs = springs_of(best.x)
    got = moduli.of_springs(springs, (lx, ly, springs.layer_distance), layers).named(square=False)
    wanted = asked.named(square=False)
    scale = {name: wanted[name] if "12" not in name else wanted[name.replace("12", "11")] for name in wanted}
    missed = {name: (got[name] - wanted[name]) / scale[name] for name in wanted}
    notes = tuple(f"{name} is missed by {miss:+.1%}" for name, miss in missed.items() if abs(miss) > 0.01)
    return springs, notes
