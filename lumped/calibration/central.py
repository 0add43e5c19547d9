"""The best of links alone, for simulators without area springs: a sheet of Cauchy's moduli near this one.

Central springs give a layer C12 = C66, so that D12 and D66 cannot both be matched unless ν = 1/3. Required is

    D11 = a D,  D12 = D66 = b D,  A11 = c A,  A12 = A66 = (b/a) c A,  S = S*,

with a, b, c of ν from a table, trained to make the worst of a set of scenes the least wrong
(`lumped.calibration.central_table`, `make central`); at ν = 1/3 they are 1, 1/3, 1. Then no solve is needed:
with σ = Σ z_k²/lz² of layers, σ' of gaps, G11 lz² = S*x lx²/s, G12 lz² = p of a gap and r = lx/ly,

    C66 lz² = (b D − σ' p)/σ,   C11 lz² = (a D − σ' G11 lz²)/σ,   p = (b/a) G11 lz²,

diagonals have C66, axial links what is left of C11, C11 − r² C66, cross-layer links along the cell G11 − r²
G12, and lz is such that A11 is matched. Cells of r² > a/b would ask for negative axial links: there diagonals
carry what leaves these at zero, and D66 is missed.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration, plan_spacing
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.central_table import ROWS
from lumped.calibration.report import report
from lumped.lattice import Grid
from lumped.spring_constants import Springs, by_direction
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Sheet

STEPS = 30  # of the layer distance: δ is small and depends little on it


def coefficients(poisson: float) -> np.ndarray:
    """Of Poisson's ratio: a, b, c; the worst error trained for of bent and of stretched scenes, and that of
    `cauchy` on the bent ones. Linear between the table's rows, constant beyond them."""
    from scipy.interpolate import make_interp_spline

    at, *columns = np.array(ROWS).T
    found: np.ndarray = make_interp_spline(at, np.transpose(columns), k=1)(np.clip(poisson, at[0], at[-1]))
    return found


def central(sheet: Sheet, material: Material, grid: Grid) -> Calibration:
    """Links alone. Raises BadInput where one would be negative: many layers of cells much wider than the
    sheet is thick."""
    a, b, c, bent, stretched, cauchy = coefficients(material.poisson).tolist()
    spacing, layers = plan_spacing(sheet, grid), grid[2]
    target = moduli.of_sheet(sheet, material, spacing)
    springs = _springs(target, spacing, layers, (a, b))
    wanted = c * target.membrane[0, 0]
    for _ in range(STEPS):
        got = moduli.of_springs(springs, (*spacing, springs.layer_distance), layers).membrane
        off = float(np.sqrt(got[0, 0] * got[1, 1])) / wanted
        springs = _springs(target, spacing, layers, (a, b), springs.layer_distance * np.sqrt(off))
    found = report("central", each_cell(sheet, material, grid), springs)
    cost = (
        f"the moduli make the worst of the training scenes wrong by {bent:.1%} where they bend and by "
        f"{stretched:.1%} where they stretch; those of 'cauchy' by {cauchy:.1%} where they bend"
    )
    return replace(found, remarks=(*found.remarks, cost))


def _springs(
    target: moduli.Moduli,
    spacing: tuple[float, float],
    layers: int,
    share: tuple[float, float],
    distance: float | None = None,
) -> Springs:
    """The links with D11 = a D, D12 = D66 = b D, S* at a layer distance [m], or at h/√3."""
    lx, ly = spacing
    rigidity = float(target.bending[0, 0])
    lz2 = distance**2 if distance is not None else 4.0 * rigidity / float(target.membrane[0, 0])
    sigma, sigma_gap = moduli.second_moment(layers), moduli.second_moment(layers - 1)
    ratios = np.array([lx**2 / ly**2, ly**2 / lx**2])
    a, b = share

    gap = target.shear * np.array([lx**2, ly**2]) / moduli.shear_gaps(layers)  # G11 lz², G22 lz² [N·m]
    p = min(b / a * float(np.sqrt(gap[0] * gap[1])), *(gap / ratios))
    layer = (a * rigidity - sigma_gap * gap) / sigma  # C11 lz², C22 lz²
    twist = min((b * rigidity - sigma_gap * p) / sigma, *(layer / ratios))
    if twist <= 0.0:
        raise BadInput(f"calibration 'central': {layers} layers need cells as small as the sheet is thick")
    axial = (layer - twist * ratios) / lz2
    cross = (gap - p * ratios) / 2.0
    return Springs.made(
        axial=by_direction(axial[0] * ly / lx, axial[1] * lx / ly),
        diagonal=twist * (lx**2 + ly**2) / (2.0 * lx * ly * lz2),
        vertical=8.0 * rigidity / lz2 * lx * ly / min(spacing) ** 2,
        cross=by_direction(
            cross[0] * (lx**2 + lz2) * ly / (lx**3 * lz2), cross[1] * (ly**2 + lz2) * lx / (ly**3 * lz2)
        ),
        cross_diagonal=p * (lx**2 + ly**2 + lz2) / (4.0 * lx * ly * lz2),
        layer_distance=float(np.sqrt(lz2)),
    )
