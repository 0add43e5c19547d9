"""Cutouts of a sheet, and its plan without them.

A shape includes its boundary. A plan is one piece that is connected by more than points.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from sheetbench.scenes.objects.quantities import Frozen, PlanPoint
from sheetbench.scenes.objects.shapes import COINCIDENT, Shape
from sheetbench.scenes.objects.sheet import Sheet

if TYPE_CHECKING:
    from shapely import Polygon

LEAST_CONNECTION = 1e-6  # of the shorter side, that connects a sheet: less is a point


class Cutout(Frozen):
    """A part of the rectangle or the outline where there is no sheet."""

    shape: Shape
    """The cutout: a rectangle, a circle or a polygon; it may reach over the rim."""


def region(sheet: Sheet, cutouts: tuple[Cutout, ...]) -> "Polygon":
    """Return the sheet's plan [m], a polygon with holes. Raises ValueError if it is empty or in pieces."""
    import shapely

    plan: Any = shapely.box(0.0, 0.0, *sheet.lengths)
    if sheet.outline is not None:
        plan = shapely.Polygon(sheet.outline)
    elif sheet.mesh is not None:
        if cutouts:
            raise ValueError("cutout 1: not with sheet.mesh, which has its own holes")
        plan = sheet.mesh.area
    neck = LEAST_CONNECTION * min(sheet.lengths)
    if (number := _first_idle(plan, cutouts)) is not None:
        words = f"cutout {number + 1}.shape: {cutouts[number].shape.in_words()}"
        raise ValueError(f"{words}: no part of it is on what is left of the sheet")
    if cutouts:
        plan = plan.difference(shapely.union_all([cutout.shape.area for cutout in cutouts]))
    inner = plan.buffer(-0.5 * neck)
    if (count := 0 if inner.is_empty else shapely.get_num_geometries(inner)) != 1:
        drawn = "sheet.mesh: it covers" if sheet.mesh is not None else "sheet.outline: it encloses"
        subject = "cutout: they leave" if cutouts else drawn
        parts = f"{count} parts that are connected at points at most" if count else "no part"
        raise ValueError(f"{subject} {parts}; a sheet is one piece")
    if plan.geom_type != "Polygon":  # with slivers
        plan = max(plan.geoms, key=lambda part: part.area)
    return plan


def _first_idle(plan: "Polygon", cutouts: Sequence[Cutout]) -> int | None:
    """Return the number, from 0, of the first cutout that lies outside the plan or in earlier cutouts."""
    import shapely

    areas = np.array([cutout.shape.area for cutout in cutouts])
    tree = shapely.STRtree(areas)
    for number, area in enumerate(areas):
        taken = plan.intersection(area)
        before = tree.query(area)
        before = np.sort(before[before < number])
        # from the last on: in a row of cutouts it is the nearest, and leaves few others to test
        while len(before := before[shapely.intersects(taken, areas[before])]):
            taken, before = taken.difference(areas[before[-1]]), before[:-1]
        if taken.area <= COINCIDENT * plan.area:
            return number
    return None


def nearest(plan: "Polygon", point: PlanPoint) -> PlanPoint:
    """Return the point of a plan that is nearest to a point [m]: the point itself if it lies in the plan."""
    import shapely

    x, y = (float(c) for c in shapely.shortest_line(plan, shapely.Point(point)).coords[0])
    return x, y


def common(plan: "Polygon", area: Any) -> Any:
    """Return the part of a plan in an area; the test for a whole area saves time on plans of many holes."""
    import shapely

    shapely.prepare(plan)
    return area if plan.contains(area) else plan.intersection(area)
