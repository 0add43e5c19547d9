"""The spring lattice: masses on a grid of layers, links to the 3×3×2 neighbourhood, area cells.

A grid (nx, ny, layers) has nx masses along x, ny along y, on lines evenly spaced or graded to the edges
(`lumped.grid_lines`), and `layers` through the thickness at the distance lz, symmetric about the mid-surface
z = 0. Mass (i, j, k) has the number (j nx + i) layers + k. Every mass is linked to every neighbour in its
layer (8) and in each adjacent layer (9): 17 links inside a two-layer lattice, 11 on an edge, 7 in a corner.
Five families (Habibi et al.'s symbols): axial ka, diagonal kd, vertical kz, cross kdT, cross_diagonal kddT;
axial and cross links belong to the direction, x or y, in which they run. Area springs act on every cell of
each layer and, with the layers averaged, on every cell of the mid-surface.

Source: the lattice of Habibi et al., with the tributary weights and area springs of
docs/theory.md: a link between two cells has half of each one's stiffness, so that links lying in a boundary
line of the sheet carry half; vertical links have a quarter of each of four cells; masses take the sheet
around them (of equal cells ½ on edges, ¼ at corners). Cells beyond the outline of a sheet, or in its holes,
are absent: they have no springs and no mass, and masses between them alone are numbered but do not move.
"""

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal, NamedTuple, Self

import numpy as np

from lumped.grid_lines import Lines, grid_lines
from lumped.pattern import SHARED_UP_TO, cells_of
from sheetbench.errors import BadInput
from sheetbench.numerics.cache import cached, frozen
from sheetbench.scenes import Sheet
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import Grid

# what of a lattice does not depend on the distance of its layers
PLANAR = ("present_cells", "absent_masses", "layer_cells", "middle_cells", "cell_areas")

Weights = Literal["tributary", "full"]


class GridLinks(NamedTuple):
    """The links of a lattice by STEPS. nodes: (m, 2) masses; offset: (m, 3) [m] rest vectors from the first
    to the second; rest_length: (m,) [m]; step: (m,) rows of STEPS; cells: (4, m) plan cells that each link
    lies in or between, repeated by weight; shares: (4, m) of their stiffness."""

    nodes: np.ndarray
    offset: np.ndarray
    rest_length: np.ndarray
    step: np.ndarray
    cells: np.ndarray
    shares: np.ndarray


class Cells(NamedTuple):
    """Cells at rest. nodes: (c, 4, p) masses whose mean each corner is, in turn; sides: (c, 2, 3) [m] means
    of opposite sides; area: (c,) [m²]."""

    nodes: np.ndarray
    sides: np.ndarray
    area: np.ndarray


class Faces(NamedTuple):
    """Upright faces between layers. at_rest: the faces as cells; cells, shares: (4, m) plan cells next to
    each face and their shares; axis: (m,) 0 along x, 1 along y, 2 over diagonals along x and y, 3 over the
    other diagonals."""

    at_rest: Cells
    cells: np.ndarray
    shares: np.ndarray
    axis: np.ndarray


@dataclass(frozen=True, eq=False)
class Lattice:
    """Topology and rest geometry. lines: across x and across y; layer_distance: lz [m]; positions: (n, 3)
    [m]; mid_cells: (c, 4, layers) columns of masses at the corners in turn of the mid-surface's cells; share:
    (n,) plan area of each mass, in mean cells; twisting: edges along which nothing holds the director;
    present: (ny − 1, nx − 1) bool, cells that the sheet covers, and per_area [kg/m²] their mass per area,
    None where all are present."""

    grid: Grid
    lines: tuple[Lines, Lines]
    layer_distance: float
    positions: np.ndarray
    links: GridLinks
    mid_cells: np.ndarray
    share: np.ndarray
    twisting: frozenset[str] = frozenset()
    present: np.ndarray | None = None
    per_area: np.ndarray | None = None

    @cached_property
    def present_cells(self) -> np.ndarray | slice:
        """Index of the present cells among all."""
        return slice(None) if self.present is None else np.flatnonzero(self.present)

    @cached_property
    def absent_masses(self) -> np.ndarray:
        """Numbers of the masses that belong to no cell, (k,)."""
        present = np.zeros(self.mass_count, dtype=bool)
        present[self.mid_cells] = True
        return np.flatnonzero(~present)

    @cached_property
    def faces(self) -> Faces:
        """The faces between layers above links along x, along y, and over the cells' diagonals."""
        links, layers = self.links, self.grid[2]
        low = (links.step < 4) & (links.nodes[:, 0] % layers < layers - 1)
        a, b = links.nodes[low].T
        nodes = np.stack([a, b, b + 1, a + 1], axis=1)[:, :, None]
        return Faces(self._at_rest(nodes), links.cells[:, low], links.shares[:, low], links.step[low])

    @cached_property
    def layer_cells(self) -> Cells:
        """The cells of the layers, one layer after the other."""
        return self._at_rest(np.moveaxis(self.mid_cells, 2, 0).reshape(-1, 4, 1))

    @cached_property
    def middle_cells(self) -> Cells:
        """The cells of the mid-surface."""
        return self._at_rest(self.mid_cells)

    def _at_rest(self, nodes: np.ndarray) -> Cells:
        corners = self.positions[nodes].mean(axis=2)
        across, along = corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]
        sides = 0.5 * np.stack([across - along, across + along], axis=1)
        return Cells(nodes, sides, np.sqrt((np.cross(sides[:, 0], sides[:, 1]) ** 2).sum(axis=1)))

    @property
    def mass_count(self) -> int:
        return len(self.positions)

    @property
    def spacing(self) -> tuple[float, float, float]:
        """Mean distances of neighbouring masses along x and y, and of the layers [m]."""
        x, y = self.lines
        return x.mean, y.mean, self.layer_distance

    @cached_property
    def cell_areas(self) -> np.ndarray:
        """Plan areas of the cells, (ny − 1, nx − 1) [m²], 0 of absent ones."""
        x, y = self.lines
        areas = np.outer(y.widths, x.widths)
        return frozen(areas if self.present is None else areas * self.present)

    @cached_property
    def plan(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Masses by plan position, positions at rest, and areas of the cells."""
        return self.columns(), self.positions, self.cell_areas

    def at_distance(self, layer_distance: float, per_area: np.ndarray | None) -> Self:
        """Return the lattice with another distance of its layers [m], and mass per area of its cells."""
        if layer_distance == self.layer_distance and per_area is self.per_area:
            return self
        by = [1.0, 1.0, layer_distance / self.layer_distance]
        offset = self.links.offset * by
        links = self.links._replace(offset=offset, rest_length=np.linalg.norm(offset, axis=1))
        positions = frozen(self.positions * by)
        own = {"layer_distance": layer_distance, "per_area": per_area}
        moved = replace(self, positions=positions, links=links, **own)  # type: ignore[arg-type]
        vars(moved).update((name, of) for name, of in vars(self).items() if name in PLANAR)
        return moved

    def columns(self) -> np.ndarray:
        """Return the numbers of the masses by plan position, (ny, nx, layers)."""
        nx, ny, layers = self.grid
        return np.arange(nx * ny * layers).reshape(ny, nx, layers)

    def links_of(self, nodes: np.ndarray) -> np.ndarray | slice:
        """Return the index, among the lattice's links, of links with the nodes (m, 2), given in the lattice's
        order."""
        if len(nodes) == len(self.links.nodes):
            return slice(None)
        all_keys, keys = (ends @ [self.mass_count, 1] for ends in (self.links.nodes, nodes))
        return np.isin(all_keys, keys)

    def edge_columns(self, edge: str) -> np.ndarray:
        """Return the numbers of the masses along an edge in the direction of its axis, (m, layers)."""
        columns = self.columns()
        return {"x0": columns[:, 0], "x1": columns[:, -1], "y0": columns[0], "y1": columns[-1]}[edge]


class LinkKind(NamedTuple):
    """A kind of link by the step from its first mass to its second, along x, along y and in layers."""

    family: str
    direction: str
    step: tuple[int, int, int]


STEPS = (  # one of each pair of opposite steps
    LinkKind("axial", "x", (1, 0, 0)),
    LinkKind("axial", "y", (0, 1, 0)),
    LinkKind("diagonal", "", (1, 1, 0)),
    LinkKind("diagonal", "", (-1, 1, 0)),
    LinkKind("vertical", "", (0, 0, 1)),
    LinkKind("cross", "x", (1, 0, 1)),
    LinkKind("cross", "x", (-1, 0, 1)),
    LinkKind("cross", "y", (0, 1, 1)),
    LinkKind("cross", "y", (0, -1, 1)),
    LinkKind("cross_diagonal", "", (1, 1, 1)),
    LinkKind("cross_diagonal", "", (-1, 1, 1)),
    LinkKind("cross_diagonal", "", (1, -1, 1)),
    LinkKind("cross_diagonal", "", (-1, -1, 1)),
)
DIRECTIONS = np.array([kind.step for kind in STEPS])


@cached(last=16, most=SHARED_UP_TO, size=lambda sheet, grid, *_, **__: math.prod(grid))
def build(
    sheet: Sheet,
    grid: Grid,
    layer_distance: float,
    weights: Weights = "tributary",
    twisting: frozenset[str] = frozenset(),
    grading: Graded = 0.0,
    per_area: np.ndarray | None = None,
) -> Lattice:
    """Return the lattice of a sheet. `weights="full"` gives every link its family's full stiffness and every
    mass an equal share (Habibi et al.). grading: of the grid's lines (`lumped.grid_lines`). per_area: of the
    cells (ny − 1, nx − 1) [kg/m²], 0 of absent cells, None where all are present.

    Raises BadInput for fewer than two masses a side or two layers, a grading outside 0 to 1, and full weights
    on a graded grid. A small lattice is cached: its arrays must not be written to, and are read-only where no
    kernel takes them (read-only arrays are another type for numba).
    """
    nx, ny, layers = grid
    if min(grid) < 2:
        raise BadInput(f"grid = {nx}x{ny}x{layers}: a lattice has at least 2 masses a side and 2 layers")
    if weights == "full" and grading:
        raise BadInput(f"weights = 'full': equal masses are for equal cells, not for grading = {grading:g}")
    present = None if per_area is None else per_area > 0.0
    lines = across_x, across_y = grid_lines(sheet, grid, grading)
    j, i, k = np.indices((ny, nx, layers)).reshape(3, -1)
    heights = (k - (layers - 1) / 2) * layer_distance
    positions = np.stack([across_x.at[i], across_y.at[j], heights], axis=1)

    nodes, step, cells, shares = _links(grid)
    if present is not None:
        shares = shares * present.ravel()[cells]
    on_sheet = shares.any(axis=0)
    nodes, step, cells, shares = nodes[on_sheet], step[on_sheet], cells[:, on_sheet], shares[:, on_sheet]
    if weights == "full":
        shares = shares / shares.sum(axis=0)
    row, column = (np.minimum(*of[nodes.T]).clip(max=cells - 2) for of, cells in ((j, ny), (i, nx)))
    widths = across_x.widths[column], across_y.widths[row], np.full(len(nodes), layer_distance)
    offset = DIRECTIONS[step] * np.stack(widths, axis=1)
    frozen((cells, shares))

    corners = cells_of(np.arange(nx * ny * layers).reshape(ny, nx, layers))
    if present is not None:
        corners = corners[present.ravel()]
    x_share, y_share = (side.tributary / side.mean for side in lines)
    share = np.repeat(np.outer(y_share, x_share).ravel(), layers)
    if weights == "full":
        share = np.full(len(positions), (nx - 1) * (ny - 1) / (nx * ny))
    frozen((positions, share))
    return Lattice(
        grid=grid,
        lines=lines,
        layer_distance=layer_distance,
        positions=positions,
        links=GridLinks(nodes, offset, np.linalg.norm(offset, axis=1), step, cells, shares),
        mid_cells=corners,
        share=share,
        twisting=twisting,
        present=present,
        per_area=per_area,
    )


@cached(last=16, most=SHARED_UP_TO, size=math.prod)
def _links(grid: Grid) -> tuple[np.ndarray, ...]:
    """Return nodes, step, cells and shares (see `GridLinks`) of the links on a grid without holes; a cell
    beyond the sheet has no share."""
    nx, ny, layers = grid
    j, i, k = np.indices((ny, nx, layers)).reshape(3, -1)
    parts = []
    for number, (di, dj, dk) in enumerate(DIRECTIONS.tolist()):
        inside = (i + di >= 0) & (i + di < nx) & (j + dj >= 0) & (j + dj < ny) & (k + dk < layers)
        first = np.flatnonzero(inside)
        nodes = np.stack([first, first + (dj * nx + di) * layers + dk], axis=1)
        # along x and along y the crossed cell twice, or the two cells next to the link's line
        column, row = i[first] + min(di, 0), j[first] + min(dj, 0)
        columns = np.stack(2 * [column - (di == 0), column])
        rows = np.repeat([row - (dj == 0), row], 2, axis=0)
        on_sheet = (columns >= 0) & (columns < nx - 1) & (rows >= 0) & (rows < ny - 1)
        cells = np.where(on_sheet, rows * (nx - 1) + columns, 0)
        parts.append((nodes.T, np.full(len(first), number), cells, 0.25 * on_sheet))
    nodes, *others = (np.concatenate(arrays, axis=-1) for arrays in zip(*parts, strict=True))
    return nodes.T, *others
