"""Shapes in the plan of a sheet: rectangles, circles, polygons, for patches, cutouts, supports and loads.

shape = { rectangle = { x = [0.0, 0.05], y = [0.0, 0.188] } }
shape = { circle = { centre = [0.1, 0.1], radius = 0.02 } }
shape = { polygon = [[0.0, 0.0], [0.1, 0.0], [0.0, 0.1]] }

Areas are shapely's; a circle is a polygon of CIRCLE_SIDES sides there, of the circle's area.
"""

from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from math import cos, pi, sin, sqrt
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import ConfigDict, Field

from sheetbench.scenes.objects.quantities import Frozen, Number, PlanPoint, Positive, Unit

if TYPE_CHECKING:
    from shapely import Polygon as Area

CIRCLE_SIDES = 256
COINCIDENT = 1e-9  # of the sheet, within which two places are one
Span = Annotated[tuple[Number, Number], Unit("m")]


class Rectangle(Frozen):
    """A rectangle with sides along x and y."""

    x: Span
    """Coordinates [from, to] along x."""
    y: Span
    """Coordinates [from, to] along y."""

    def _faults(self) -> Iterator[object]:
        for name, (low, high) in (("x", self.x), ("y", self.y)):
            more = f"{name} = [{low:g}, {high:g}]: the second must be greater than the first"
            yield high <= low and more


class Circle(Frozen):
    """A disc."""

    centre: Annotated[PlanPoint, Unit("m")]
    """Plan point [x, y]."""
    radius: Annotated[Positive, Unit("m")]
    """Radius of the disc."""


class Shape(Frozen):
    """One of a rectangle, a circle and a polygon, in the plan."""

    model_config = ConfigDict(json_schema_extra={"minProperties": 1, "maxProperties": 1})

    rectangle: Rectangle | None = None
    """Sides along x and y: { x = [from, to], y = [from, to] }."""
    circle: Circle | None = None
    """{ centre = [x, y], radius = … }."""
    polygon: Annotated[tuple[PlanPoint, ...], Unit("m"), Field(min_length=3)] | None = None
    """Corners [x, y] in turn, either way round; its sides do not cross."""

    beyond: Annotated[tuple[PlanPoint, ...], Unit("m"), Field(min_length=3)] | None = None
    """Corners of a polygon whose outside is the shape: for a support that holds a rim."""
    hole: Annotated[int, Field(ge=1)] | None = None
    """Number of a hole whose rim a support holds: the number of the cutout, or of a mesh's hole in the order
    of the x of their middles."""
    rim: Literal[True] | None = None
    """The whole outline, held by a support; where = "rim" is a short form."""

    def _faults(self) -> Iterator[object]:
        given = self.given(type(self).model_fields)
        yield len(given) != 1 and f"{' and '.join(given) or 'empty'}: give one of rectangle, circle, polygon"
        yield self.polygon and crossing("polygon", self.polygon)
        yield self.beyond and crossing("beyond", self.beyond)

    @cached_property
    def area(self) -> "Area":
        """Return the shape as a polygon of shapely."""
        import shapely  # takes 0.2 s, not needed for plain sheets

        if self.rectangle is not None:
            (left, right), (low, high) = self.rectangle.x, self.rectangle.y
            return shapely.box(left, low, right, high)
        if self.circle is not None:
            angle = 2.0 * pi / CIRCLE_SIDES
            radius = self.circle.radius * sqrt(angle / sin(angle))
            x, y = self.circle.centre
            turns = [angle * n for n in range(CIRCLE_SIDES)]
            return shapely.polygons(np.array([(x + radius * cos(a), y + radius * sin(a)) for a in turns]))
        if self.beyond is not None:
            inside = shapely.Polygon(self.beyond)
            return inside.envelope.buffer(max(inside.bounds), join_style="mitre").difference(inside)
        return shapely.Polygon(self.polygon)

    def contains(self, points: np.ndarray) -> np.ndarray:
        """Return whether plan points (…, 2) [m] lie inside or on the boundary of the shape."""
        x, y = np.moveaxis(np.asarray(points, dtype=float), -1, 0)
        if self.circle is not None:
            centre = self.circle.centre
            return np.hypot(x - centre[0], y - centre[1]) <= self.circle.radius
        import shapely

        return np.asarray(shapely.intersects_xy(self.area, x, y))

    def in_words(self) -> str:
        """Return kind and place in words, in millimetres."""
        if self.beyond is not None:
            return f"rim, a polygon of {len(self.beyond)} corners, and beyond"
        left, low, right, high = (f"{1e3 * value:.4g}" for value in self.area.bounds)
        if self.circle is not None:
            x, y = (f"{1e3 * value:.4g}" for value in self.circle.centre)
            return f"circle of radius {1e3 * self.circle.radius:.4g} mm about ({x}, {y}) mm"
        kind = f"polygon of {len(self.polygon)} corners in" if self.polygon else "rectangle"
        return f"{kind} {left} ≤ x ≤ {right}, {low} ≤ y ≤ {high} mm"


def crossing(key: str, corners: tuple[PlanPoint, ...]) -> str:
    """Return the reason why corners [m] in turn are no polygon, with their key; "" if they are one."""
    import shapely

    polygon = shapely.Polygon(corners)
    if polygon.is_valid and polygon.area > 0.0:
        return ""
    return f"{key}: its sides cross or it has no area ({shapely.is_valid_reason(polygon)} m)"


def straight_sides(*areas: "Area") -> tuple[set[float], set[float]]:
    """Return x and y [m] of the sides along the axes, of areas and of their holes."""
    sides: tuple[set[float], set[float]] = (set(), set())
    if not areas:
        return sides
    import shapely

    for ring in shapely.get_rings(areas):
        for first, second in pairwise(ring.coords):
            for axis in (0, 1):
                if first[axis] == second[axis]:
                    sides[axis].add(first[axis])
    return sides
