"""Lines in a sheet's plan that element sides follow: its rim and the borders of shapes within it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from sheetbench.scenes import EdgeLoad, Scene
from sheetbench.scenes.meaning.composition import own_patches
from sheetbench.scenes.objects.shapes import COINCIDENT, Shape
from sheetbench.scenes.objects.supports import Point, place

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


CORNER = 0.35  # rad, least turn; sides of a round shape turn less
SLIVER = 5e-4  # width of parts between borders that are not meshed, over the shorter side


class Borders(NamedTuple):
    """Borders of a plan [m]. region: area of the sheet; inner: borders of shapes, within it or beyond."""

    region: BaseGeometry
    inner: BaseGeometry

    @property
    def _sides(self) -> np.ndarray:
        """Beginning and end of all straight parts, (2, k, 2)."""
        import shapely

        return straight_parts(shapely.union_all([self.region.boundary, self.inner])).swapaxes(0, 1)

    @property
    def along_axes(self) -> bool:
        """Return whether all borders lie along x or y."""
        begin, end = self._sides
        return bool(np.all((begin == end).any(axis=1)))

    def lines(self, lengths: tuple[float, float]) -> tuple[np.ndarray, np.ndarray]:
        """Return x of borders along y and y of borders along x [m], rising, within the sheet's edges."""
        positions, (begin, end) = [], self._sides
        for axis, length in enumerate(lengths):
            at = np.unique(begin[begin[:, axis] == end[:, axis], axis])
            at = at[(at > COINCIDENT * length) & (at < (1.0 - COINCIDENT) * length)]
            positions.append(at[np.diff(at, prepend=-length) > COINCIDENT * length])
        return positions[0], positions[1]


def straight_parts(lines: BaseGeometry) -> np.ndarray:
    """Return the straight parts (k, 2, 2) of lines."""
    import shapely

    parts = [shapely.get_coordinates(part) for part in shapely.get_parts(lines)]
    return np.concatenate([np.zeros((0, 2, 2)), *(np.stack([at[:-1], at[1:]], axis=1) for at in parts)])


def borders_of(scene: Scene) -> Borders | None:
    """Return the borders in a scene's plan, None for a whole rectangle without any. Patches of the sheet's
    own constants have none."""
    shapes, points = shapes_of(scene), [s.at for s in scene.supports if isinstance(s, Point)]
    if not (shapes or points or scene.pierced):
        return None
    import shapely

    lx, ly = scene.sheet.lengths
    through = [shapely.LineString(ends) for x, y in points for ends in (((x, 0), (x, ly)), ((0, y), (lx, y)))]
    parts = [scene.region, *(shape.area.boundary for shape in shapes)]
    region, *inner = without_slivers(parts, SLIVER * min(lx, ly))
    return Borders(region, shapely.union_all([*inner, *through]))


def without_slivers(parts: Sequence[BaseGeometry], width: float) -> list[BaseGeometry]:
    """Return a region and lines with common points where borders cross or are within a width [m] of each
    other. Between a circle and a polygon with its corners on the circle, for example, no element is upright.
    """
    import shapely

    def points(of: Sequence[BaseGeometry]) -> BaseGeometry:
        return shapely.multipoints(shapely.get_coordinates(of))

    lines = [part.boundary if part.area else part for part in parts]
    crossings = [shapely.intersection(*pair) for pair in combinations(lines, 2)]
    snapped = [shapely.snap(part, points(crossings), width) for part in parts]
    for number in range(1, len(snapped)):
        snapped[number] = shapely.snap(snapped[number], points(snapped[:number]), width)
    return [shapely.snap(part, points(snapped), width) for part in snapped]


def has_lines(scene: Scene) -> bool:
    """Return whether a scene's meshes consist of lines along x and y."""
    borders = borders_of(scene)
    return borders is None or borders.along_axes


def has_corners(scene: Scene, shapes: Sequence[Shape]) -> bool:
    """Return whether the sheet has a re-entrant corner, or the rest of it around one of the shapes."""
    if not (shapes or scene.pierced):
        return False
    import shapely

    around = [shapely.difference(scene.region, shape.area) for shape in shapes]
    for part in shapely.get_parts([scene.region, *around]):
        oriented = shapely.geometry.polygon.orient(part)
        for ring in (oriented.exterior, *oriented.interiors):
            x, y = np.diff(shapely.get_coordinates(ring), axis=0).T
            turn = np.arctan2(
                x * np.roll(y, -1) - y * np.roll(x, -1), x * np.roll(x, -1) + y * np.roll(y, -1)
            )
            if turn.min() < -CORNER:
                return True
    return False


def shapes_of(scene: Scene, lines: bool = True) -> list[Shape]:
    """Return the shapes whose borders count; lines: also the shapes that bound the loaded part of an edge."""
    places = [place(support) for support in scene.supports if not isinstance(support, Point)]
    loads = [load for load in scene.loads if lines or not isinstance(load, EdgeLoad)]
    places += [getattr(load, "where", None) for load in loads]
    places += [payload.where for payload in scene.masses]
    places += [patch.shape for patch in scene.patches if patch.natural is not None]
    places += [patch.shape for patch in own_patches(scene)]
    return [shape for shape in places if shape is not None]
