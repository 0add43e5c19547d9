"""The spring lattice: masses on a regular grid of layers, links to the 3×3×2 neighbourhood, area cells.

A grid (nx, ny, layers) has nx masses along x, ny along y, `layers` through the thickness, spaced
(lx, ly, lz) [m]; the layers lie symmetrically about the mid-surface z = 0. Mass (i, j, k) has number
(j nx + i) layers + k. Every mass is linked to every neighbour in its layer (8) and in each adjacent
layer (9): 17 links inside a two-layer lattice, 11 on an edge, 7 in a corner. Five families (the seed's
symbols): axial ka, diagonal kd, vertical kz, cross kdT, cross_diagonal kddT; axial and cross links
belong to the direction, x or y, in which they run. Area springs act on every cell of each layer and,
with the layers averaged, on every cell of the mid-surface.

Source: the seed's lattice (Habibi et al.), with the tributary weights and area springs of
docs/theory.md: links lying in a boundary line of the sheet carry half, vertical links and masses their
tributary share (½ on edges, ¼ at corners).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from sheetbench.scenes import Sheet
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grid import Grid

Weights = Literal["tributary", "full"]


@dataclass(frozen=True)
class LinkFamily:
    """The links of one family and direction.

    nodes: (m, 2) mass numbers; offset: (m, 3) [m] rest vector from the first to the second;
    weight: (m,) share of the family's stiffness that each link carries.
    """

    name: str
    direction: str
    nodes: np.ndarray
    offset: np.ndarray
    weight: np.ndarray

    @property
    def rest_length(self) -> np.ndarray:
        """Rest lengths, (m,) [m]."""
        return np.linalg.norm(self.offset, axis=1)


@dataclass(frozen=True)
class CellFamily:
    """The area cells of the layers ("area") or of the mid-surface ("mid_area").

    nodes: (c, 4, p) mass numbers: four corners in turn, the p masses whose mean is that corner.
    """

    name: str
    nodes: np.ndarray


@dataclass(frozen=True)
class Lattice:
    """Topology and rest geometry. positions: (n, 3) [m]; share: (n,) tributary share of each mass;
    twisting: the edges along which nothing holds the director."""

    grid: Grid
    spacing: tuple[float, float, float]
    positions: np.ndarray
    links: tuple[LinkFamily, ...]
    cells: tuple[CellFamily, ...]
    share: np.ndarray
    twisting: frozenset[str] = frozenset()

    @property
    def mass_count(self) -> int:
        return len(self.positions)

    def number(self, i: np.ndarray, j: np.ndarray, k: np.ndarray) -> np.ndarray:
        """Mass numbers of grid indices (broadcast)."""
        nx, _, layers = self.grid
        return (np.asarray(j) * nx + np.asarray(i)) * layers + np.asarray(k)

    def columns(self) -> np.ndarray:
        """Mass numbers by plan position, (ny, nx, layers)."""
        nx, ny, layers = self.grid
        return np.arange(nx * ny * layers).reshape(ny, nx, layers)

    def edge_columns(self, edge: str) -> np.ndarray:
        """Mass numbers along an edge in the direction of its axis, (m, layers)."""
        columns = self.columns()
        return {"x0": columns[:, 0], "x1": columns[:, -1], "y0": columns[0], "y1": columns[-1]}[edge]


# family, direction, step in the grid; of each pair of opposite steps one is listed.
STEPS: tuple[tuple[str, str, tuple[int, int, int]], ...] = (
    ("axial", "x", (1, 0, 0)),
    ("axial", "y", (0, 1, 0)),
    ("diagonal", "", (1, 1, 0)),
    ("diagonal", "", (-1, 1, 0)),
    ("vertical", "", (0, 0, 1)),
    ("cross", "x", (1, 0, 1)),
    ("cross", "x", (-1, 0, 1)),
    ("cross", "y", (0, 1, 1)),
    ("cross", "y", (0, -1, 1)),
    ("cross_diagonal", "", (1, 1, 1)),
    ("cross_diagonal", "", (-1, 1, 1)),
    ("cross_diagonal", "", (1, -1, 1)),
    ("cross_diagonal", "", (-1, -1, 1)),
)


def build(
    sheet: Sheet,
    grid: Grid,
    layer_distance: float,
    weights: Weights = "tributary",
    twisting: frozenset[str] = frozenset(),
) -> Lattice:
    """The lattice of a sheet. `weights="full"` gives every link its family's full stiffness and every
    mass the same share, as the seed has them.

    Raises BadInput for fewer than two masses a side or two layers.
    """
    nx, ny, layers = grid
    if min(grid) < 2:
        raise BadInput(f"grid = {nx}x{ny}x{layers}: a lattice has at least 2 masses a side and 2 layers")
    lx, ly, lz = sheet.length_x / (nx - 1), sheet.length_y / (ny - 1), layer_distance
    j, i, k = (a.ravel() for a in np.meshgrid(np.arange(ny), np.arange(nx), np.arange(layers), indexing="ij"))
    positions = np.stack([i * lx, j * ly, (k - (layers - 1) / 2) * lz], axis=1)
    on_x_line = (j == 0) | (j == ny - 1)  # boundary lines running along x
    on_y_line = (i == 0) | (i == nx - 1)
    share = np.where(on_x_line, 0.5, 1.0) * np.where(on_y_line, 0.5, 1.0)

    families = []
    for name, direction, (di, dj, dk) in STEPS:
        inside = (i + di >= 0) & (i + di < nx) & (j + dj >= 0) & (j + dj < ny) & (k + dk < layers)
        first = np.flatnonzero(inside)
        second = first + (dj * nx + di) * layers + dk
        weight = np.ones(len(first))
        if weights == "tributary":
            if direction == "x":
                weight = np.where(on_x_line[first], 0.5, 1.0)
            elif direction == "y":
                weight = np.where(on_y_line[first], 0.5, 1.0)
            elif name == "vertical":
                weight = share[first]
        offset = np.tile(np.array([di * lx, dj * ly, dk * lz]), (len(first), 1))
        families.append(LinkFamily(name, direction, np.stack([first, second], axis=1), offset, weight))

    columns = np.arange(nx * ny * layers).reshape(ny, nx, layers)
    corners = np.stack([columns[:-1, :-1], columns[:-1, 1:], columns[1:, 1:], columns[1:, :-1]], axis=2)
    corners = corners.reshape(-1, 4, layers)
    layer_cells = np.moveaxis(corners, 2, 0).reshape(-1, 4, 1)
    if weights == "full":
        share = np.full(len(positions), (nx - 1) * (ny - 1) / (nx * ny))
    return Lattice(
        grid=grid,
        spacing=(lx, ly, lz),
        positions=positions,
        links=tuple(families),
        cells=(CellFamily("area", layer_cells), CellFamily("mid_area", corners)),
        share=share,
        twisting=twisting,
    )
