"""Springs that meet D, A and the shear stiffness S* of the grid all at once, in closed form.

Square cells of side l, two layers at distance lz (docs/theory.md, section 3; S* is MacNeal's):

    lz² = [4 D + (2/3) S* l²/(1 − ν)]/A,  kd = D (1 − ν)/lz²,  ka = 2 kd,  kA = D (3ν − 1)/lz²,
    p = S* l²/(3 lz²),  kdT = p (l² + lz²)/l²,  kddT = p (2 l² + lz²)/(4 l²),
    m = ν A − 2 (kd + kA) − (p − δ),      kz = 8 D/lz² (free: it sets only δ and the stiffest frequency).

Here for cells of sides lx, ly (r = lx/ly) and L layers. The cross-layer links between two layers have the in-
plane form G11 = S*x lx²/(s lz²), G22 = S*y ly²/(s lz²), G12 = G66 = P whatever their split, s the shear gaps
of `lumped.moduli`, and a share d of it at most goes to the furthest diagonals, d = ⅓ by default. With σ = Σ
z_k²/lz² and σ' = Σ z_g²/lz² of layers and gaps, a layer's form is

    C = (D − σ' lz² (G − δ))/(σ lz²),

of which diagonals take the share f = min(1, (C11 − C12)/2C66(r² − 1)), of an isotropic one 1/(r² − 1), of C66
(r ≥ 1; likewise with C22 for r < 1; more would ask for negative links along the cell, see
`lumped.springs.laws`), shear springs the rest, area springs C12 − f C66, axial links
what is left of C11 and C22. What the sheet's A has beyond L C + (L − 1)(G − δ) goes to the mid-surface: m to
A12, the rest to strain springs, with lz the least for which none is negative. On square cells all of those
vanish if P is G11/3. A cell of a graded grid has its layers as far apart as its neighbours: lz is then given,
and larger.

What lz leaves free is the cost of a strain that varies across a cell. A cell bent in its plane, ε_x = χ y,
has the links along x on its two sides stretched and nothing else: with E_x of A11 in those it stores ½ E_x (χ
ly/2)² per area, where the sheet, free to contract, stores ½ (A11 − A12²/A22) χ² ly²/12. So links along the
sides should carry E_x = (A11 − A12²/A22)/3, a third of an isotropic sheet's E h, and what belongs to the
whole cell the rest. At the least lz they carry up to three times as much, so that a coarse lattice is too
stiff in its plane, and layers at bent edges and in soft sheets too wide. Further apart the layers bend and
shear as before with less in each: the sides carry a third (`gradients`) from

    lz² = [L (C11 − C12 + (1 − r²) f C66) + (L − 1)(G11 − P r²)] lz²/E_x

on, and its like along y; the mid-surface has the rest. A long cell (l ≫ h) bent by θ is too soft by

    θ²/12 − w θ²/8 + (1 − w)² θ²/(k + 40 w/3),    w = S* lz²/8D,    k = kz lz²/D,

a chord for an arc, the diagonals that shorten as it bends, and the columns that shorten (docs/theory.md, 3);
k = 8 costs more than the chord, so these sheets, which may bend far, have columns FIRMER: k = 32.

The diagonals' share d is free too. Against a wave of wave number q at the angle θ to the grid the stiffness
of square cells is too small by (q l)² sin² 2θ/48 times

    5 + 3ν − (21 d − 9 d²)/(1 + t) − 12 d t/(1 + t),    1 + t = 12 D/(S* l²),

which is 3ν − 1 + 2 S*/κGh for a third and vanishes (`waves`) for a d from 0.27 to 0.54, ν from 0 to ½.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from scipy.linalg import eigvalsh

from lumped.calibration.calibration import by_direction
from lumped.moduli import Moduli, second_moment, shear_gaps
from sheetbench.scenes import SpringSet

FIRMER = 4.0  # columns of a lattice with `gradients`, at no cost to the explicit step of cells of 5 h or more


def closed_form(
    target: Moduli,
    spacing: tuple[float, float],
    layers: int,
    layer_distance: float | None = None,
    gradients: bool = False,
    waves: bool = False,
) -> SpringSet | None:
    """The springs that have the requested moduli; None where a link would be negative (many layers on coarse
    grids: there the cross-layer links alone bend too stiffly), and where a layer distance [m] that is given
    is less than the cell needs. gradients: whether layers are so far apart that strains in the plane that
    vary across a cell cost what they cost the sheet; waves: whether oblique waves of bending are right in l²,
    of oblong cells as if they were squares of the same area."""
    lx, ly = spacing
    sigma, sigma_gap = second_moment(layers), second_moment(layers - 1)
    gap = target.shear * np.array([lx**2, ly**2]) / shear_gaps(layers)  # G11 lz², G22 lz² [N·m]
    ratios = np.array([lx**2 / ly**2, ly**2 / lx**2])
    bracket = 5.0 + 3.0 * target.bending[0, 1] / target.bending[0, 0]
    upright = (FIRMER if gradients else 1.0) * vertical(target, spacing, 1.0)  # kz lz² [N·m]
    share = diagonals_for_waves(target, lx * ly, bracket) if waves else 1.0 / 3.0
    least = float(min(target.bending[0, 0], target.bending[1, 1]))
    share *= min(1.0, 4.0 * float(target.bending[2, 2]) / least)  # of sheets that are soft in shear less
    p = share * float(min(gap.max(), *(1.5 * gap / ratios)))
    gap_form = np.array([[gap[0], p, 0.0], [p, gap[1], 0.0], [0.0, 0.0, p]])

    lz2 = 0.0 if layer_distance is None else layer_distance**2
    relaxation = _relaxation(target, gap, p, spacing, lz2, upright) if lz2 else np.zeros((3, 3))
    for _ in range(50):  # δ is small and depends little on lz: a fixed point
        relaxed = gap_form - relaxation
        layer = (target.bending - sigma_gap * relaxed) / sigma
        lattice = layers * layer + (layers - 1) * relaxed
        by_diagonals = _by_diagonals(layer, ratios)
        axial = np.diag(layer)[:2] - layer[0, 1] + by_diagonals * layer[2, 2] * (1.0 - ratios)
        if fibres := _has_fibres(target, layer, axial):
            by_diagonals, axial = 0.0, 1.0 / (3.0 * np.diag(np.linalg.inv(layer))[:2])
            needed = float(eigvalsh(lattice, target.membrane)[-1])
        else:
            needed = max(
                (lattice[0, 0] - lattice[0, 1]) / (target.membrane[0, 0] - target.membrane[0, 1]),
                (lattice[1, 1] - lattice[0, 1]) / (target.membrane[1, 1] - target.membrane[0, 1]),
                lattice[2, 2] / target.membrane[2, 2],
            )
        if gradients:
            on_sides = layers * axial + (layers - 1) * (gap - p * ratios)
            needed = max(needed, float((on_sides / _on_sides(target.membrane)).max()))
        if layer_distance is not None:
            if needed > lz2 * (1.0 + 1e-9):
                return None
            break
        if needed <= 0.0 or abs(needed - lz2) < 1e-15 * needed:
            break
        lz2 = needed
        relaxation = _relaxation(target, gap, p, spacing, lz2, upright)
    if lz2 <= 0.0 or layer[2, 2] <= 0.0:
        return None
    if min(axial) < 0.0 or (fibres and np.linalg.eigvalsh(layer)[0] <= 0.0):
        return None
    l1x, l1y, l2 = lx**2 + lz2, ly**2 + lz2, lx**2 + ly**2 + lz2
    rest = target.membrane * lz2 - lattice
    area, mid_area = layer[0, 1] - by_diagonals * layer[2, 2], rest[0, 1]
    more: dict[str, Any] = {}
    if fibres:
        area = mid_area = 0.0
        stretch = np.diag(layer)[:2] - axial
        more = {"stretch": by_direction(stretch[0] / lz2, stretch[1] / lz2)}
        for cells, form in (("", layer), ("mid_", rest)):
            more |= {
                f"{cells}coupling_xy": form[0, 1] / lz2,
                f"{cells}coupling_x": form[0, 2] / lz2,
                f"{cells}coupling_y": form[1, 2] / lz2,
            }
    rest[:2, :2] -= mid_area
    rest[np.abs(rest) < 1e-12 * target.membrane[0, 0] * lz2] = 0.0
    return SpringSet(
        axial=by_direction(axial[0] * ly / lx / lz2, axial[1] * lx / ly / lz2),
        diagonal=by_diagonals * layer[2, 2] * (lx**2 + ly**2) / (2.0 * lx * ly * lz2),
        vertical=upright / lz2,
        cross=by_direction(
            (gap[0] - p * ratios[0]) * l1x * ly / (2.0 * lx**3 * lz2),
            (gap[1] - p * ratios[1]) * l1y * lx / (2.0 * ly**3 * lz2),
        ),
        cross_diagonal=p * l2 / (4.0 * lx * ly * lz2),
        area=area / lz2,
        mid_area=mid_area / lz2,
        shear=(1.0 - by_diagonals) * layer[2, 2] / lz2,
        mid_shear=rest[2, 2] / lz2,
        mid_stretch=by_direction(rest[0, 0] / lz2, rest[1, 1] / lz2),
        layer_distance=math.sqrt(lz2),
        **more,
    )


def _has_fibres(target: Moduli, layer: np.ndarray, axial: np.ndarray) -> bool:
    """Whether the layer's cells need couplings: at an angle to the fibres, and where area springs would leave
    the links along the sides, of a sheet that is not isotropic, less than the third of E h of `gradients`."""
    stretching, shearing = target.bending[0, 0] - target.bending[0, 1], 2.0 * target.bending[2, 2]
    if target.oblique:
        return True
    if math.isclose(stretching, shearing, rel_tol=1e-9) or np.linalg.eigvalsh(layer)[0] <= 0.0:
        return False
    return bool(np.any(axial < 1.0 / (3.0 * np.diag(np.linalg.inv(layer))[:2])))


def diagonals_for_waves(target: Moduli, area: float, bracket: float) -> float:
    """The diagonals' share d of the shear for waves, of cells of that area [m²]: the bracket, 5 + 3 ν here,
    is what is too small without diagonals."""
    rigidity = target.bending[0, 0]
    stiffening = 12.0 * rigidity / (float(np.sqrt(target.shear.prod())) * area)  # 1 + t
    linear = 12.0 * stiffening + 9.0
    product = 36.0 * bracket * stiffening
    return float(linear - math.sqrt(linear**2 - product)) / 18.0


def _by_diagonals(layer: np.ndarray, ratios: np.ndarray) -> float:
    """f, the share of a layer's C66 that its diagonals have: half of what axial links leave room for."""
    room = 0.5 * np.maximum(np.diag(layer)[:2] - layer[0, 1], 0.0)
    target = layer[2, 2] * (ratios - 1.0)
    return float(min(1.0, *np.divide(room, target, out=np.ones(2), where=target > room)))


def _on_sides(form: np.ndarray) -> np.ndarray:
    """What of a form's 11 and 22 the links on a cell's sides should carry, (2,)."""
    sides: np.ndarray = (np.diag(form)[:2] - form[0, 1] ** 2 / np.diag(form)[1::-1]) / 3.0
    return sides


def vertical(target: Moduli, spacing: tuple[float, float], lz2: float) -> float:
    """kz [N/m]: 8 D/lz² per square of the shorter spacing, over the cell; D² = D11 D22."""
    lx, ly = spacing
    return 8.0 * math.sqrt(target.bending[0, 0] * target.bending[1, 1]) / lz2 * lx * ly / min(lx, ly) ** 2


def _relaxation(
    target: Moduli, gap: np.ndarray, p: float, spacing: tuple[float, float], lz2: float, upright: float
) -> np.ndarray:
    """δ lz² (3, 3): what a gap's thickness, free to change, takes off its in-plane form; upright: kz lz²."""
    lx, ly = spacing
    coupling = np.array([gap[0] / lx**2, gap[1] / ly**2, 0.0])  # the gap's S along x, y [N/m]
    cross = (gap - p * np.array([lx**2 / ly**2, ly**2 / lx**2])) / np.array([lx**4, ly**4]) * lz2
    thickness = upright / (lx * ly) + cross.sum() + p * lz2 / (lx * ly) ** 2
    relaxation: np.ndarray = np.outer(coupling, coupling) / thickness * lz2
    return relaxation
