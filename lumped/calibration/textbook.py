"""Constructions from the literature and from habit: axial, van-gelder, lloyd, cauchy, uniform.

They fix the springs of a layer; none knows of a bending sheet of two layers, so this module says how each is
made into one. E is shared out by thickness: a layer stands for h/L of the sheet.

axial       every link is a bar, k = E A/L, of the section it replaces: (h/L) times the spacing across it in
            the layer and between layers, lx ly for a vertical link. Layer distance h/(L − 1): on the faces.
van-gelder  Van Gelder (1998): k = E2 Σ area/|edge|², E2 = E h/L, over the triangles at an edge, averaged over
            the two triangulations of the grid: E2 lx ly/l² on axial links, a quarter E2 · 2 lx ly/|d|² on
            diagonals.
lloyd       Lloyd, Székely and Harders (2007): k = −n·K_ij n with the stiffness K of a bilinear element at
            ν = 1/3 (where the match is possible): 5/16 and 7/16 E2 per cell on squares.
cauchy      the central-force lattice that is isotropic: ka = 2 kd, no area springs, so ν = 1/3 whatever the
            sheet's; D11 and A11 matched but for the thickness relaxation δ. Square cells only.

Where a construction says nothing of it (van-gelder, lloyd), the layers lie at ± h/√12, which gives the
bending stiffness of their in-plane stiffness, and the cross-layer links have the shear stiffness S* of
`lumped.moduli`.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration, plan_spacing
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.closed_form import NoClosedForm, springs_of_cells
from lumped.calibration.report import report
from lumped.lattice import Grid
from lumped.spring_constants import Springs, by_direction
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Sheet

CAUCHY_POISSON = 1.0 / 3.0


def axial(sheet: Sheet, material: Material, grid: Grid, layer_distance: float | None = None) -> Calibration:
    """k = E A/L per link."""
    lx, ly = plan_spacing(sheet, grid)
    distance = layer_distance or sheet.thickness / (grid[2] - 1)
    strip = material.young * sheet.thickness / grid[2]  # E times the thickness of a layer [N/m]
    diagonal = math.hypot(lx, ly)
    springs = Springs.made(
        axial=by_direction(strip * ly / lx, strip * lx / ly),
        diagonal=strip * (lx * ly / diagonal) / diagonal,
        vertical=material.young * lx * ly / distance,
        cross=by_direction(strip * ly / math.hypot(lx, distance), strip * lx / math.hypot(ly, distance)),
        cross_diagonal=strip * (lx * ly / diagonal) / math.hypot(diagonal, distance),
        layer_distance=distance,
    )
    return report("axial", each_cell(sheet, material, grid), springs)


def van_gelder(
    sheet: Sheet, material: Material, grid: Grid, layer_distance: float | None = None
) -> Calibration:
    """Van Gelder's areas over squared lengths in each layer."""
    lx, ly = plan_spacing(sheet, grid)
    strip = material.young * sheet.thickness / grid[2]
    in_layer = (strip * ly / lx, strip * lx / ly, strip * lx * ly / (2.0 * (lx * lx + ly * ly)))
    return _layered("van-gelder", sheet, material, grid, layer_distance, in_layer)


def lloyd(sheet: Sheet, material: Material, grid: Grid, layer_distance: float | None = None) -> Calibration:
    """−n·K_ij n of the bilinear element at ν = 1/3 in each layer.

    Raises BadInput for cells so long that a spring would be negative."""
    lx, ly = plan_spacing(sheet, grid)
    strip = material.young * sheet.thickness / grid[2]
    c = strip / (1.0 - CAUCHY_POISSON**2)
    c12, c66 = CAUCHY_POISSON * c, (1.0 - CAUCHY_POISSON) / 2.0 * c
    # blocks of the bilinear rectangle: an edge along x belongs to two cells
    along_x = 2.0 * (c * ly / (3.0 * lx) - c66 * lx / (6.0 * ly))
    along_y = 2.0 * (c * lx / (3.0 * ly) - c66 * ly / (6.0 * lx))
    k_xx = (c * ly / lx + c66 * lx / ly) / 6.0
    k_yy = (c * lx / ly + c66 * ly / lx) / 6.0
    k_xy = (c12 + c66) / 4.0
    diagonal = (lx * lx * k_xx + ly * ly * k_yy + 2.0 * lx * ly * k_xy) / (lx * lx + ly * ly)
    if min(along_x, along_y) < 0.0:
        raise BadInput("calibration 'lloyd': cells this much longer than wide ask for negative springs")
    return _layered("lloyd", sheet, material, grid, layer_distance, (along_x, along_y, diagonal))


def cauchy(sheet: Sheet, material: Material, grid: Grid) -> Calibration:
    """The isotropic central-force lattice. Raises BadInput on cells that are not square, and where a link
    would be negative."""
    lx, ly = plan_spacing(sheet, grid)
    if abs(lx - ly) > 1e-9 * lx:
        raise BadInput("calibration 'cauchy' is for square cells only")
    each = each_cell(sheet, material, grid)
    third = np.array([[1.0, CAUCHY_POISSON, 0.0], [CAUCHY_POISSON, 1.0, 0.0], [0.0, 0.0, CAUCHY_POISSON]])
    membrane, bending = (form[..., :1, :1] * third for form in (each.section.membrane, each.section.bending))
    isotropic = replace(each.section, membrane=membrane, bending=bending)
    try:
        springs = springs_of_cells(each._replace(section=isotropic))
    except NoClosedForm:
        raise BadInput(
            f"calibration 'cauchy': {grid[2]} layers need cells as small as the sheet is thick"
        ) from None
    links = {name: k for name, k in springs.of.items() if name not in ("area", "mid_area")}
    return report("cauchy", each, replace(springs, of=links))


def uniform(
    sheet: Sheet, material: Material, grid: Grid, k: float | None = None, layer_distance: float | None = None
) -> Calibration:
    """k [N/m] as given or from D11; layer_distance [m] as given or the sheet's thickness over the gaps."""
    distance = layer_distance if layer_distance is not None else sheet.thickness / (grid[2] - 1)
    lx, ly = plan_spacing(sheet, grid)
    if k is None:
        unit = moduli.of_springs(_all(1.0, distance), (lx, ly, distance), grid[2])
        k = float(moduli.of_sheet(sheet, material, (lx, ly)).bending[0, 0] / unit.bending[0, 0])
    return report("uniform", each_cell(sheet, material, grid), _all(k, distance))


def _all(k: float, layer_distance: float) -> Springs:
    return Springs.made(
        axial=k, diagonal=k, vertical=k, cross=k, cross_diagonal=k, layer_distance=layer_distance
    )


def _layered(
    method: str,
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None,
    in_layer: tuple[float, float, float],
) -> Calibration:
    """Given in-plane springs, layers that bend as they stretch and cross-layer links that shear as S*."""
    lx, ly = plan_spacing(sheet, grid)
    layers = grid[2]
    distance = layer_distance or sheet.thickness * math.sqrt(layers / (12.0 * moduli.second_moment(layers)))
    target = moduli.of_sheet(sheet, material, (lx, ly))
    area = lx * ly
    (cross_x, cross_y), diagonals = moduli.gap_shear_per_stiffness(np.array([lx, ly]), distance)
    gap = target.shear / moduli.shear_gaps(layers)
    # one third of the shear by the furthest diagonals, two thirds by the cross links, as in the closed form
    cross_diagonal = float(np.min(gap / 3.0 / diagonals))
    rest = gap - cross_diagonal * diagonals
    springs = Springs.made(
        axial=by_direction(in_layer[0], in_layer[1]),
        diagonal=in_layer[2],
        vertical=8.0 * float(target.bending[0, 0]) / distance**2 * area / min(lx, ly) ** 2,
        cross=by_direction(float(rest[0]) / cross_x, float(rest[1]) / cross_y),
        cross_diagonal=cross_diagonal,
        layer_distance=distance,
    )
    return report(method, each_cell(sheet, material, grid), springs)
