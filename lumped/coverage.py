"""Coverage of a lattice by parts of the plan: shares of cells, areas of masses, and masses held there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lumped.grid_lines import Lines
from lumped.lattice import Lattice
from lumped.mid_surface import MidSurface
from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, Scene, Support, Symmetric, held_axes, holds_director
from sheetbench.scenes.meaning.composition import boxes_of, shares_of
from sheetbench.scenes.meaning.region import edge_parts
from sheetbench.scenes.objects.shapes import COINCIDENT, Shape
from sheetbench.scenes.objects.supports import Point, named, place

if TYPE_CHECKING:
    from shapely import Geometry

HELD_SHARE = 0.4  # of a mass's surroundings: a support that covers more holds the mass


def part_of(scene: Scene, shape: Shape | None) -> Geometry:
    """Return the part of the sheet [m] that lies in a shape, all of it for None."""
    return scene.region if shape is None else scene.region.intersection(shape.area)


def cell_shares(scene: Scene, lattice: Lattice, shape: Shape | None) -> np.ndarray:
    """Return the share of every present cell that lies on the sheet and in a shape, (cells,)."""
    if shape is None and not scene.pierced:
        return np.ones(lattice.cell_areas.size)
    share = shares_of(part_of(scene, shape), *(lines.at for lines in lattice.lines))
    return np.asarray(share.ravel()[lattice.present_cells])


def areas_of_masses(scene: Scene, lattice: Lattice, shape: Shape | None) -> np.ndarray:
    """Return the area [m²] of the sheet in a shape by masses, (n,); each cell's part is shared among masses
    like a force at its centroid."""
    import shapely

    part, places = part_of(scene, shape), [lines.at for lines in lattice.lines]
    share = shares_of(part, *places)
    pieces = shapely.intersection(part, boxes_of(*places)[share > 0.0])
    middle = shapely.get_coordinates(shapely.centroid(pieces))
    area = shapely.area(pieces)[:, None]
    return MidSurface(lattice, middle, order=1).shared(area, lattice.mass_count)[:, 0]


def held_crossings(lines: tuple[Lines, Lines], shape: Shape) -> np.ndarray:
    """Return whether a support in a shape holds each crossing of lines, (ny, nx). It holds crossings inside
    it, on its boundary within rounding, and with more than HELD_SHARE of their surroundings, half a cell each
    way, covered."""
    import shapely

    x, y = (side.at for side in lines)
    around = (np.concatenate([at[:1], 0.5 * (at[1:] + at[:-1]), at[-1:]]) for at in (x, y))
    crossings = np.stack(np.meshgrid(x, y), axis=-1)
    on_boundary = shapely.distance(shape.area, shapely.points(crossings)) < COINCIDENT * max(x[-1], y[-1])
    covered = shares_of(shape.area, *around) > HELD_SHARE + COINCIDENT
    return np.asarray(on_boundary | shape.contains(crossings) | covered)


def union_of(supports: Sequence[Support]) -> Geometry:
    """Return the area [m] that the shapes of supports cover."""
    import shapely

    return shapely.union_all([shape.area for one in supports if (shape := place(one)) is not None])


def clamped_stiffness(scene: Scene, lines: tuple[Lines, Lines]) -> np.ndarray:
    """Return the factor of stiffness of cells that the rim of a support cuts, (rows, columns).

    The held masses nearest to a support's rim are not on it. The part that bends is the free part of a cut
    cell and of the next one if all masses of the next are held: f cells long, 1/f times as stiff.
    """
    factor = np.ones((len(lines[1].widths), len(lines[0].widths)))
    for support in scene.supports:
        shape = None if isinstance(support, Point) else place(support)
        if shape is None or held_axes(support) != (0, 1, 2):
            continue
        covered = shares_of(shape.area, *(side.at for side in lines))
        held = held_crossings(lines, shape)
        whole = held[:-1, :-1] & held[:-1, 1:] & held[1:, :-1] & held[1:, 1:]
        left = np.pad(np.where(whole, 1.0 - covered, 0.0), 1)
        free = 1.0 - covered + left[:-2, 1:-1] + left[2:, 1:-1] + left[1:-1, :-2] + left[1:-1, 2:]
        factor[~whole] /= free[~whole]
    return factor


class ObliqueRims(NamedTuple):
    """Parts of cells within a cell's length of rims that are not along the axes, a part for each side of the
    rim that is near. rows, columns: (m,) numbers of the cell; part: (m,) share of the cell's sheet that is
    near, divided among the sides by their lengths; normal: (m, 2) of the side, of either sign."""

    rows: np.ndarray
    columns: np.ndarray
    part: np.ndarray
    normal: np.ndarray


def oblique_rims(scene: Scene, lines: tuple[Lines, Lines], share: np.ndarray) -> ObliqueRims | None:
    """Return the parts of cells near oblique rims, None without oblique rims; share: (rows, columns) of the
    sheet in every cell."""
    import shapely

    (x, y), size = lines, max(scene.sheet.lengths)
    rings = [np.asarray(ring.coords) for ring in (scene.region.exterior, *scene.region.interiors)]
    ends = np.concatenate([np.stack([ring[:-1], ring[1:]], axis=1) for ring in rings])
    along = ends[:, 1] - ends[:, 0]
    oblique = np.abs(along).min(axis=1) > COINCIDENT * size
    firm = union_of([s for s in scene.supports if holds_director(s)])  # the twist does not fade along them
    if not firm.is_empty:
        oblique &= shapely.distance(firm, shapely.points(ends.mean(axis=1))) > COINCIDENT * size
    if not oblique.any():
        return None
    sides, along = shapely.linestrings(ends[oblique]), along[oblique]
    width = float(np.sqrt(x.mean * y.mean))
    rim = shapely.line_merge(shapely.union_all(sides))
    band, boxes = scene.region.intersection(rim.buffer(width, cap_style="flat")), boxes_of(x.at, y.at)
    near = shares_of(band, x.at, y.at) * (share > 0.0)
    around = shapely.buffer(boxes[near > 0.0], width, cap_style="square", join_style="mitre")
    cell, side = shapely.STRtree(sides).query(around)
    length = shapely.length(shapely.intersection(sides[side], around[cell]))
    near_side = length > COINCIDENT * size
    cell, side, length = cell[near_side], side[near_side], length[near_side]
    rows, columns = (part[cell] for part in np.nonzero(near))
    length /= np.bincount(cell, length)[cell]
    part = np.minimum(near[rows, columns] / share[rows, columns], 1.0) * length
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.hypot(*along.T)[:, None]
    return ObliqueRims(rows, columns, part, normal[side])


Reach = tuple[tuple[str, tuple[tuple[float, float], ...]], ...]


def reached_parts(scene: Scene) -> Reach:
    """Return the intervals [m] along held edges in which a sheet with an outline or cutouts reaches the edge,
    by edge; planes of symmetry hold every mass and have none. Raises BadInput for a round or oblique rim that
    may turn: masses beyond it are held, which clamps it."""
    if not scene.pierced:
        return ()
    for name, one in named(scene.supports).items():
        shape = None if isinstance(one, Point) or holds_director(one) else place(one)
        if shape is not None and shape.rectangle is None and not part_of(scene, shape).area:
            why = (
                "the lattice can only clamp round and oblique rims: its masses there hold the slope too; "
                "choose plate, shell or solid"
            )
            raise BadInput(f"{name}.where: {why}")
    held = [s for s in scene.supports if place(s) is None and not isinstance(s, Symmetric)]
    return tuple((support.edge, tuple(edge_parts(scene, support.edge))) for support in held)


def held_columns(
    lattice: Lattice, support: Support, reached: Reach = (), name: str = "support"
) -> np.ndarray:
    """Return the numbers of the masses that a support holds, by columns (m, layers): masses of its edge
    within half a cell of the intervals that the sheet reaches, or masses in or nearest to its shape. Raises
    BadInput where it holds none."""
    shape = place(support)
    if shape is None:
        columns, parts = lattice.edge_columns(support.edge), dict(reached).get(support.edge)
        if parts is None:
            return columns
        at = lattice.lines[EDGES[support.edge].along_axis].at
        before, after = (np.concatenate(places) for places in ((at[:1], at[:-1]), (at[1:], at[-1:])))
        near = [(0.5 * (at + after) > a) & (0.5 * (before + at) < b) for a, b in parts]
        return np.asarray(columns[np.any(near, axis=0)])
    columns = lattice.columns()
    inside = held_crossings(lattice.lines, shape)
    grid = "x".join(map(str, lattice.grid[:2]))
    if isinstance(support, Point) and not inside.any():
        where = ", ".join(f"{at:g}" for at in support.at)
        raise BadInput(
            f"{name}.at = [{where}]: no mass of a grid of {grid} is there; take a finer one, or one with "
            "lines through it (lumped.calibrate: grading)"
        )
    inside[np.isin(columns[:, :, 0], lattice.absent_masses)] = False
    if not inside.any():
        raise BadInput(
            f"{name}.where: {shape.in_words()}: it holds no mass of a grid of {grid}; take a finer one"
        )
    return np.asarray(columns[inside])
