"""Sheets of springs of one stiffness, as codes have them that know no more: along the sides of triangles, or
of tetrahedra in one layer, whose height is then free to be chosen.

Squares are cut into five tetrahedra each, neighbours mirrored, so that they share their faces' diagonals.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from itertools import combinations

import numpy as np
from scipy.optimize import brentq

from comparisons.codes.cell import Cell, Place, cell_of
from comparisons.codes.coefficients import TURNED, Moduli, least_error, moduli_of
from fem_reference.surface.materials import section_of
from sheetbench.scenes import Scene

FIVE = (
    ((0, 0, 0), (1, 1, 0), (1, 0, 1), (0, 1, 1)),
    ((1, 0, 0), (0, 0, 0), (1, 1, 0), (1, 0, 1)),
    ((0, 1, 0), (0, 0, 0), (1, 1, 0), (0, 1, 1)),
    ((0, 0, 1), (0, 0, 0), (1, 0, 1), (0, 1, 1)),
    ((1, 1, 1), (1, 1, 0), (1, 0, 1), (0, 1, 1)),
)  # corners of a cube (x, y, layer)
HEIGHTS = (0.2, 5.0)  # of the layers, over the thickness


def five(i: int, j: int) -> list[list[tuple[int, int, int]]]:
    """The tetrahedra of square (i, j): corners as places along x, along y, and layers."""
    flip = (i + j) % 2
    return [[(i + (x ^ flip), j + y, layer) for x, y, layer in cell] for cell in FIVE]


def tetrahedral_cell(spacing: float, height: float) -> Cell:
    """Two layers of nodes, with springs "k" along every side of the tetrahedra between."""
    cells = (corners for i in range(2) for j in range(2) for corners in five(i, j))
    places = [[(i % 2 * 4 + j % 2 * 2 + layer, i // 2, j // 2) for i, j, layer in cell] for cell in cells]
    nodes = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (-0.5, 0.5)])
    periods = 2.0 * spacing * np.eye(2)
    return Cell("tetrahedra", periods, nodes * [spacing, spacing, height], springs=_along_sides(places))


def triangular_cell(name: str, spacing: float) -> Cell:
    """A mesh of triangles without a membrane of its own: springs "k" along its sides, hinges by angle."""
    cell = cell_of(name, spacing, hinge="angle")
    return replace(cell, springs=_along_sides(cell.triangles))


def _along_sides(elements: Iterable[Sequence[Place]]) -> tuple[tuple[Place, Place, str], ...]:
    """Springs "k" between every two corners of elements, each once."""
    sides: dict[tuple[Place, Place], None] = {}
    for element in elements:
        for a, b in combinations(element, 2):
            (first, i, j), (second, *to) = sorted((a, b))
            sides[(first, 0, 0), (second, to[0] - i, to[1] - j)] = None
    return tuple((a, b, "k") for a, b in sides)


def layered_springs(scene: Scene, spacing: float, best: bool = False) -> dict[str, float]:
    """k [N/m] and the layers' distance [m] of tetrahedra.

    k has the membrane nearest to the sheet's, the distance then the bending stiffnesses, or what is best in
    the scene. Raises NoEquilibrium where the scene's sheet has no stable one.
    """
    own = section_of(scene.material, scene.sheet.thickness)

    def at(height: float) -> tuple[float, Moduli]:
        unit = moduli_of(tetrahedral_cell(spacing, height), {"k": 1.0})
        k = _share(unit.membrane, own.membrane)
        assert unit.shear is not None
        return k, Moduli(k * unit.membrane, k * unit.coupling, k * unit.bending, k * unit.shear)

    low, high = (share * scene.sheet.thickness for share in HEIGHTS)
    if best:
        height, _ = least_error(scene, lambda height: at(height)[1], low, high)
    else:

        def miss(height: float) -> float:
            return _share(at(height)[1].bending, own.bending) - 1.0

        height = float(brentq(miss, low, high))
    return {"k": at(height)[0], "layers": height}


def _share(form: np.ndarray, target: np.ndarray) -> float:
    """The factor that brings a form nearest to one that is requested, in Mandel's norm."""
    weighted = TURNED**2 * form
    return float(np.sum(weighted * target) / np.sum(weighted * form))
