"""What of a lattice lies in a part of the plan: shares of cells, areas of masses, and masses held there."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from lumped.lattice import Lattice
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, Support
from sheetbench.scenes.patches import boxes_of, shares_of
from sheetbench.scenes.shapes import Shape
from sheetbench.scenes.supports import place

if TYPE_CHECKING:
    from shapely import Geometry

HALF = 0.5 - 1e-9  # of what a mass stands for, from which on a support holds it


def part_of(scene: Scene, shape: Shape | None) -> Geometry:
    """The part of the sheet [m] that lies in a shape, all of it for None."""
    if shape is None:
        return scene.region
    return scene.region.intersection(shape.area)


def cell_shares(scene: Scene, lattice: Lattice, shape: Shape | None) -> np.ndarray:
    """What share of every cell present is on the sheet and in a shape, (cells,)."""
    if shape is None and not scene.pierced:
        return np.ones(lattice.cell_areas.size)
    share = shares_of(part_of(scene, shape), *(lines.at for lines in lattice.lines))
    return np.asarray(share.ravel()[lattice.kept])


def areas_of_masses(scene: Scene, lattice: Lattice, shape: Shape | None) -> np.ndarray:
    """The area [m²] of the sheet in a shape, (ny, nx): each cell's part of it shared bilinearly among the
    columns of masses around its middle."""
    import shapely

    part, (x, y) = part_of(scene, shape), lattice.lines
    shapely.prepare(part)
    boxes = boxes_of(x.at, y.at)
    rows, columns = np.nonzero(shapely.intersects(part, boxes))
    pieces = shapely.intersection(part, boxes[rows, columns])
    middle, area = shapely.centroid(pieces), shapely.area(pieces)
    rows, columns, middle, area = (each[area > 0.0] for each in (rows, columns, middle, area))
    over = (shapely.get_x(middle) - x.at[columns]) / x.widths[columns]
    up = (shapely.get_y(middle) - y.at[rows]) / y.widths[rows]
    out = np.zeros((len(y.at), len(x.at)))
    for j, by_row in ((0, 1.0 - up), (1, up)):
        for i, by_column in ((0, 1.0 - over), (1, over)):
            np.add.at(out, (rows + j, columns + i), area * by_row * by_column)
    return out


def held_columns(lattice: Lattice, support: Support, name: str = "support") -> np.ndarray:
    """Mass numbers that a support holds, by columns (m, layers): those of its edge, or those in its shape and
    those for half of whose surroundings it stands. Raises BadInput for a shape that holds none."""
    shape = place(support)
    if shape is None:
        return lattice.edge_columns(support.edge)
    around = (
        np.concatenate([side.at[:1], 0.5 * (side.at[1:] + side.at[:-1]), side.at[-1:]])
        for side in lattice.lines
    )
    columns = lattice.columns()
    inside = shape.contains(lattice.positions[columns[:, :, 0], :2]) | (
        shares_of(shape.area, *around) >= HALF
    )
    inside[np.isin(columns[:, :, 0], lattice.absent_masses)] = False
    if not inside.any():
        grid = "x".join(map(str, lattice.grid[:2]))
        raise BadInput(
            f"{name}.where: {shape.in_words()}: it holds no mass of a grid of {grid}; take a finer one"
        )
    return np.asarray(columns[inside])
