"""Constructions from the literature and from practice: axial, van-gelder, lloyd, uniform.

They fix the springs of a layer in its plane; this module extends each to a bending sheet of several layers. E
is shared out by thickness: a layer represents h/L of the sheet.

axial       every link is a bar, k = E A/L, of the section it replaces: (h/L) times the spacing across it in
            the layer and between layers, lx ly for a vertical link. Layer distance h/(L − 1): on the faces.
van-gelder  Van Gelder (1998): k = E2 Σ area/|edge|², E2 = E h/L, over the triangles at an edge, averaged over
            the two triangulations of the grid: E2 lx ly/l² on axial links, a quarter E2 · 2 lx ly/|d|² on
            diagonals.
lloyd       Lloyd, Székely and Harders (2007): k = −n·K_ij n with the stiffness K of a bilinear element at
            ν = 1/3 (where the match is possible): 5/16 and 7/16 E2 per cell on squares.

Constructions without a layer distance (van-gelder, lloyd) have layers at ± h/√12, which gives the bending
stiffness of their in-plane stiffness, and cross-layer links with the shear stiffness S* of `lumped.moduli`.
"""

import math

import numpy as np

from lumped import moduli
from lumped.calibration.cell_by_cell import GridCells
from lumped.spring_constants import Springs, by_direction
from sheetbench.errors import BadInput

LLOYDS_POISSON = 1.0 / 3.0


def axial(grid_cells: GridCells, layer_distance: float | None = None) -> Springs:
    """Return springs with k = E A/L per link."""
    sides, strip = grid_cells.sides[0, 0], _layer_modulus(grid_cells)
    across, area, diagonal = sides[::-1], sides.prod(), np.hypot(*sides)
    distance = layer_distance or grid_cells.sheet.thickness / (grid_cells.grid[2] - 1)
    return Springs.made(
        axial=by_direction(*strip * across / sides),
        diagonal=strip * area / diagonal**2,
        vertical=grid_cells.material.young * area / distance,
        cross=by_direction(*strip * across / np.hypot(sides, distance)),
        cross_diagonal=strip * (area / diagonal) / np.hypot(diagonal, distance),
        layer_distance=distance,
    )


def van_gelder(grid_cells: GridCells, layer_distance: float | None = None) -> Springs:
    """Return springs with Van Gelder's areas over squared lengths in each layer."""
    sides, strip = grid_cells.sides[0, 0], _layer_modulus(grid_cells)
    diagonal = 0.5 * strip * sides.prod() / np.sum(sides**2)
    return _with_layers(grid_cells, layer_distance, strip * sides[::-1] / sides, diagonal)


def lloyd(grid_cells: GridCells, layer_distance: float | None = None) -> Springs:
    """Return springs with −n·K_ij n of the bilinear element at ν = 1/3 in each layer.

    Raises BadInput for cells so long that a spring would be negative."""
    sides = grid_cells.sides[0, 0]
    ratios, nu = sides[::-1] / sides, LLOYDS_POISSON
    c = _layer_modulus(grid_cells) / (1.0 - nu**2)
    c12, c66 = nu * c, (1.0 - nu) / 2.0 * c
    # blocks of the bilinear rectangle: an edge along x belongs to two cells
    along = 2.0 * (c * ratios / 3.0 - c66 / (6.0 * ratios))
    normal, mixed = (c * ratios + c66 / ratios) / 6.0, (c12 + c66) / 4.0
    diagonal = (np.sum(sides**2 * normal) + 2.0 * sides.prod() * mixed) / np.sum(sides**2)
    if along.min() < 0.0:
        raise BadInput("calibration 'lloyd': cells this much longer than wide would need negative springs")
    return _with_layers(grid_cells, layer_distance, along, diagonal)


def uniform(grid_cells: GridCells, k: float | None = None, layer_distance: float | None = None) -> Springs:
    """Return springs of one constant k [N/m], given or from D11; layer_distance [m]: given or the sheet's
    thickness over the gaps."""
    layers = grid_cells.grid[2]
    distance = layer_distance if layer_distance is not None else grid_cells.sheet.thickness / (layers - 1)
    families = ("axial", "diagonal", "vertical", "cross", "cross_diagonal")
    unit = Springs.made(distance, **dict.fromkeys(families, 1.0))
    if k is None:
        by_unit = moduli.of_cells(unit, grid_cells.sides, layers).bending[0, 0, 0, 0]
        k = grid_cells.target.bending[0, 0, 0] / by_unit
    return Springs.made(distance, **dict.fromkeys(families, k))


def _layer_modulus(grid_cells: GridCells) -> float:
    """Return E times the thickness of a layer [N/m]."""
    return grid_cells.material.young * grid_cells.sheet.thickness / grid_cells.grid[2]


def _with_layers(
    grid_cells: GridCells, layer_distance: float | None, along: np.ndarray, diagonal: np.floating
) -> Springs:
    """Return springs from constants along x and y (2,) and over diagonals of a layer, with the layer distance
    that gives the bending stiffness of their stretching, and cross-layer links of the shear stiffness S*."""
    sides, layers, target = grid_cells.sides[0, 0], grid_cells.grid[2], grid_cells.target
    half_width = math.sqrt(layers / (12.0 * moduli.second_moment(layers)))
    distance = layer_distance or grid_cells.sheet.thickness * half_width
    cross, diagonals = moduli.gap_shear_per_stiffness(sides, distance)
    gap = target.shear[0] / moduli.shear_gaps(layers)
    # one third of the shear by the furthest diagonals, two thirds by the cross links, as in the closed form
    cross_diagonal = np.min(gap / 3.0 / diagonals)
    return Springs.made(
        axial=by_direction(*along),
        diagonal=diagonal,
        vertical=8.0 * target.bending[0, 0, 0] / distance**2 * sides.prod() / sides.min() ** 2,
        cross=by_direction(*(gap - cross_diagonal * diagonals) / cross),
        cross_diagonal=cross_diagonal,
        layer_distance=distance,
    )
