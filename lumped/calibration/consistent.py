"""Springs that meet D, A and the shear stiffness S* of the grid all together, in closed form (square cells).

With C11 = ka + kd + kA, C12 = kd + kA, C66 = kd per layer, p = C66's share of a gap and q = 2p its isotropic
companion, one gap's shear stiffness 3 p lz²/l², L layers, σ = Σ z_k²/lz², σ' = Σ z_g²/lz² and
s = (Σ t_g)²/Σ t_g² (see `lumped.moduli`), the five conditions

    s · 3 p lz²/l² = S*                       shear
    σ kd lz² + σ' p lz² = D (1 − ν)/2         twisting
    L kd + (L − 1) p = A (1 − ν)/2            in-plane shear
    σ (kd + kA) lz² + σ' (p − δ) lz² = ν D    Poisson's ratio in bending
    L (kd + kA) + (L − 1)(p − δ) + m = ν A    Poisson's ratio in stretching

have one solution. For two layers it is

    lz² = [4 D + (2/3) S* l²/(1 − ν)]/A,  kd = D (1 − ν)/lz²,  ka = 2 kd,  kA = D (3ν − 1)/lz²,
    p = S* l²/(3 lz²),  kdT = p (l² + lz²)/l²,  kddT = p (2 l² + lz²)/(4 l²),
    m = ν A − 2 (kd + kA) − (p − δ).

kz is free: 4 C = 8 D/lz² with two layers; it sets only the thickness relaxation δ and the stiffest frequency.
Source: the project's lattice theory, sections 1–3, extended here to L layers; S* is MacNeal's (1978).
"""

from __future__ import annotations

import math

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration, plan_spacing, report
from lumped.calibration.least_squares import bounded_least_squares
from lumped.lattice import Grid
from scenes import Material, Sheet, SpringSet


def consistent(
    sheet: Sheet, material: Material, grid: Grid, k: float | None = None, layer_distance: float | None = None
) -> Calibration:
    """Closed form on square cells; on unequal spacings, a given layer distance, or where the closed form
    would need a negative link, bounded least squares on the same moduli.

    Raises ValueError when k is given: this method finds every stiffness itself.
    """
    if k is not None:
        raise ValueError(
            f"k = {k:g}: calibration 'consistent' finds its stiffnesses itself; k goes with 'uniform'"
        )
    lx, ly = plan_spacing(sheet, grid)
    if layer_distance is None and abs(lx - ly) < 1e-9 * lx:
        springs = closed_form(sheet, material, lx, grid[2])
        if springs is not None:
            return report(
                "consistent", sheet, material, grid, springs, admissible(springs, (lx, ly), grid[2])
            )
    springs, notes = bounded_least_squares(sheet, material, grid, layer_distance)
    return report(
        "consistent", sheet, material, grid, springs, (*notes, *admissible(springs, (lx, ly), grid[2]))
    )


def closed_form(sheet: Sheet, material: Material, spacing: float, layers: int) -> SpringSet | None:
    """The springs of square cells of side `spacing` [m]; None where a link would be negative."""
    nu = material.poisson
    asked = moduli.of_sheet(sheet, material, (spacing, spacing))
    bending, membrane, shear = asked.bending[0, 0], asked.membrane[0, 0], asked.shear[0]
    heights = np.arange(layers) - (layers - 1) / 2
    sigma = float((heights**2).sum())
    sigma_gap = float((((heights[1:] + heights[:-1]) / 2) ** 2).sum())
    gaps = layers - 1
    p_lz2 = shear * spacing**2 / (3.0 * moduli.shear_gaps(layers))
    kd_lz2 = (bending * (1.0 - nu) / 2.0 - sigma_gap * p_lz2) / sigma
    if kd_lz2 <= 0.0:
        return None
    lz2 = (layers * kd_lz2 + gaps * p_lz2) / (membrane * (1.0 - nu) / 2.0)
    p, kd = p_lz2 / lz2, kd_lz2 / lz2
    l1, l2 = spacing**2 + lz2, 2.0 * spacing**2 + lz2
    cross, cross_diagonal = p * l1 / spacing**2, p * l2 / (4.0 * spacing**2)
    vertical = 8.0 * bending / lz2
    gap_shear = 3.0 * p * lz2 / spacing**2
    relaxation = gap_shear**2 / (
        vertical * lz2 / spacing**2
        + 4.0 * cross * lz2**2 / (l1 * spacing**2)
        + 4.0 * cross_diagonal * lz2**2 / (l2 * spacing**2)
    )
    c12 = (nu * bending / lz2 - sigma_gap * (p - relaxation)) / sigma
    return SpringSet(
        axial=2.0 * kd,
        diagonal=kd,
        vertical=vertical,
        cross=cross,
        cross_diagonal=cross_diagonal,
        area=c12 - kd,
        mid_area=nu * membrane - layers * c12 - gaps * (p - relaxation),
        layer_distance=math.sqrt(lz2),
    )


def admissible(springs: SpringSet, spacing: tuple[float, float], layers: int) -> tuple[str, ...]:
    """A note where area springs are negative (ν < 1/3): admissible while the cell's energy stays positive.

    Raises ValueError where it does not.
    """
    if springs.area >= 0.0 and springs.mid_area >= 0.0:
        return ()
    areas = f"area = {springs.area:.4g}, mid_area = {springs.mid_area:.4g} N/m"
    got = moduli.of_springs(springs, (*spacing, springs.layer_distance), layers)
    lowest = min(np.linalg.eigvalsh(form)[0] for form in (got.membrane, got.bending))
    if lowest <= 0.0:
        raise ValueError(f"{areas}: the cell's energy is not positive")
    return (f"{areas}: negative area springs are admissible here, the cell's energy is positive",)
