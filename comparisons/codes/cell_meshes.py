"""Cells of the meshes that cloth and shell codes are given, by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import sqrt
from pathlib import Path

import numpy as np
from scipy.spatial import Delaunay

from comparisons.codes.cell import Cell, Place, from_toml
from sheetbench.errors import BadInput, require_effect

SEED, SIDE, JITTER = 7, 5, 0.25  # of the unstructured mesh: points along a side, their shift over the spacing


def cell_of(
    cell: str, spacing: float | None = None, thickness: float | None = None, hinge: str | None = None
) -> Cell:
    """The cell of a mesh's name, with its nodes `spacing` [m] apart, or of a file that ends in .toml.

    thickness [m]: of bricks, of which one is in the thickness; hinge: the energy of the others' hinges, of
    `comparisons.codes.cell.HINGES`, "length" unless given. Raises BadInput for another name, for what is
    missing, and for what has no effect on this cell.
    """
    if cell.endswith(".toml"):
        require_effect(f"on {cell}, which has its own", {"spacing": spacing, "hinge": hinge})
        return from_toml(Path(cell))
    if cell not in NAMES:
        raise BadInput(f"cell = {cell!r}: one of {', '.join(NAMES)}, or a file")
    if not (isinstance(spacing, float | int) and spacing > 0.0):
        raise BadInput(f"spacing = {str(spacing)[:20]}: the distance of nodes, in metres, is needed")
    if cell == BRICKS:
        require_effect(f"on {BRICKS}, which have no hinges", {"hinge": hinge})
        if not thickness:
            raise BadInput(f"thickness = {thickness}: of bricks, in metres, is needed")
        return _bricks(spacing, thickness)
    periods, nodes, triangles = MESHES[cell]()
    nodes = np.column_stack([nodes, np.zeros(len(nodes))])
    return Cell(
        cell, spacing * np.asarray(periods, dtype=float), spacing * nodes, triangles, hinge or "length"
    )


_Parts = tuple[np.ndarray, np.ndarray, tuple[tuple[Place, ...], ...]]


def _squares(alternate: bool) -> _Parts:
    """Squares with one diagonal; alternate: the other one in every second square."""
    side = 2 if alternate else 1

    def at(i: int, j: int) -> Place:
        return (i % side) * side + j % side, i // side, j // side

    triangles: list[tuple[Place, ...]] = []
    for i in range(side):
        for j in range(side):
            a, b, c, d = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
            triangles += [(a, b, d), (b, c, d)] if (i + j) % 2 else [(a, b, c), (a, c, d)]
    nodes = np.array([[i, j] for i in range(side) for j in range(side)], dtype=float)
    return side * np.eye(2), nodes, tuple(triangles)


def _equilateral() -> _Parts:
    triangles = (((0, 0, 0), (0, 1, 0), (0, 0, 1)), ((0, 1, 0), (0, 1, 1), (0, 0, 1)))
    return np.array([[1.0, 0.0], [0.5, sqrt(0.75)]]), np.zeros((1, 2)), triangles


def _unstructured() -> _Parts:
    """Delaunay triangles of points of a grid that are moved at random, the same ones on every machine."""
    grid = np.array([[i, j] for i in range(SIDE) for j in range(SIDE)], dtype=float)
    points = (grid + JITTER * np.random.default_rng(SEED).uniform(-1.0, 1.0, grid.shape)) % SIDE
    tiles = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    tiled = np.vstack([points + SIDE * np.array(tile) for tile in tiles])
    triangles = []
    for corners in Delaunay(tiled).simplices:
        middle = tiled[corners].mean(axis=0)
        if np.all((middle >= 0.0) & (middle < SIDE)):
            triangles.append(tuple((int(c % len(grid)), *tiles[c // len(grid)]) for c in corners))
    return SIDE * np.eye(2), points, tuple(triangles)


MESHES: Mapping[str, Callable[[], _Parts]] = {
    "one-diagonal": lambda: _squares(alternate=False),
    "alternate-diagonals": lambda: _squares(alternate=True),
    "equilateral": _equilateral,
    "unstructured": _unstructured,
}
BRICKS = "bricks"
NAMES = (*MESHES, BRICKS)


def _bricks(spacing: float, thickness: float) -> Cell:
    nodes = np.array([[0.0, 0.0, -thickness / 2.0], [0.0, 0.0, thickness / 2.0]])
    corners = tuple((layer, i, j) for layer in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1)))
    return Cell(BRICKS, spacing * np.eye(2), nodes, bricks=(corners,))
