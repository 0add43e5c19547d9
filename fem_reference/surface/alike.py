"""Plans brought into one place however they are mirrored, turned or large, so that their meshes are alike.

Of the eight ways to lay a plan along the axes the last is taken, its sides in order compared number by number
after rounding. A plan that is its own mirror image across x or y is meshed on one side of that line
alone: its mesh is its own image too. Lengths are in sizes of the largest triangles.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from skfem import MeshQuad

from fem_reference.surface.mesh_points import NEAR

if TYPE_CHECKING:
    from shapely import LineString
    from shapely.geometry.base import BaseGeometry

DIGITS = 9  # of rounding, of `mesh_points.GRID`
FLIPS = [np.diag([x, y]) for x in (1.0, -1.0) for y in (1.0, -1.0)]
TURNS = [flip @ swap for swap in (np.eye(2), np.eye(2)[::-1]) for flip in FLIPS]


class CentredPlan(NamedTuple):
    """A plan about the origin, and what leads back from there: x = p turn + centre; mirrors: the axes across
    which it is its own image."""

    region: BaseGeometry
    inner: BaseGeometry
    centre: np.ndarray
    turn: np.ndarray
    mirrors: tuple[int, ...]

    @property
    def part(self) -> tuple[BaseGeometry, BaseGeometry]:
        """Region and inner borders on the far side of all mirrors."""
        import shapely

        beyond = 1.0 + np.ptp(self.region.bounds)
        low, high = np.full(2, -beyond), np.full(2, beyond)
        low[list(self.mirrors)] = 0.0
        side = shapely.box(*low, *high)
        region, inner = (shapely.intersection(part, side) for part in (self.region, self.inner))
        return _rounded(region), _rounded(inner)

    def cut(self, borders: Sequence[LineString]) -> np.ndarray:
        """Which borders of the part are none of the plan, but lie where a mirror cuts it."""
        import shapely

        own = shapely.union_all([self.region.boundary, self.inner])
        middle = shapely.line_interpolate_point(list(borders), 0.5, normalized=True)
        return np.asarray(shapely.distance(own, middle) > NEAR)

    def unfolded(
        self, mesh: MeshQuad, ends: np.ndarray, places: np.ndarray
    ) -> tuple[MeshQuad, np.ndarray, np.ndarray]:
        """The mesh of the part with its images; ends (k, 2), places (k, 2): of sides on borders and of their
        middles."""
        at, elements = mesh.p.T.copy(), mesh.t.T
        for axis in self.mirrors:
            on = np.abs(at[:, axis]) < NEAR
            at[on, axis] = 0.0
            image = np.where(on, np.arange(len(at)), len(at) + np.cumsum(~on) - 1)
            beyond = ~on[ends].all(axis=1)
            other = np.where(np.arange(2) == axis, -1.0, 1.0)
            elements = np.concatenate([elements, image[elements][:, ::-1]])
            ends = np.concatenate([ends, image[ends[beyond]]])
            places = np.concatenate([places, other * places[beyond]])
            at = np.concatenate([at, other * at[~on]])
        return _mesh(at, elements), ends, places

    def back(self, mesh: MeshQuad, places: np.ndarray) -> tuple[MeshQuad, np.ndarray]:
        """A mesh, and places (k, 2), where the plan was; what lies on its bounds to rounding, on them."""
        half = np.ptp(np.reshape(self.region.bounds, (2, 2)), axis=0) @ np.abs(self.turn) / 2.0

        def moved(points: np.ndarray) -> np.ndarray:
            found = points @ self.turn
            on = np.abs(np.abs(found) - half) < NEAR
            return self.centre + np.where(on, np.sign(found) * half, found)

        upright = np.linalg.det(self.turn) > 0.0
        return _mesh(moved(mesh.p.T), mesh.t.T if upright else mesh.t.T[:, ::-1]), moved(places)


def placed(region: BaseGeometry, inner: BaseGeometry) -> CentredPlan:
    """Return a plan in the last of its eight places."""
    import shapely

    centre = np.mean(np.reshape(region.bounds, (2, 2)), axis=0)
    rims, lines = (
        _sides(shapely.transform(part, lambda at: np.round(at - centre, DIGITS)))
        for part in (region.boundary, inner)
    )
    keys = [(*_key(rims, turn), *_key(lines, turn)) for turn in TURNS]
    turn = TURNS[max(range(len(TURNS)), key=keys.__getitem__)]
    last = max(keys)
    mirrors = tuple(
        axis
        for axis, flip in enumerate((FLIPS[2], FLIPS[1]))
        if (*_key(rims, flip @ turn), *_key(lines, flip @ turn)) == last
    )

    def there(at: np.ndarray) -> np.ndarray:
        return np.round(at - centre, DIGITS) @ turn.T + 0.0

    borders = shapely.multilinestrings(_ordered(lines, turn))
    return CentredPlan(shapely.normalize(shapely.transform(region, there)), borders, centre, turn, mirrors)


def _sides(lines: BaseGeometry) -> np.ndarray:
    """Straight parts (k, 2, 2) of lines."""
    import shapely

    parts = [shapely.get_coordinates(part) for part in shapely.get_parts(lines)]
    return np.concatenate([np.zeros((0, 2, 2)), *(np.stack([at[:-1], at[1:]], axis=1) for at in parts)])


def _ordered(sides: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Sides (k, 2, 2) turned, each from its lesser end, in rising order, none twice."""
    there = sides @ turn.T + 0.0
    begin, end = there[:, 0], there[:, 1]
    swapped = (begin[:, 0] > end[:, 0]) | ((begin[:, 0] == end[:, 0]) & (begin[:, 1] > end[:, 1]))
    there[swapped] = there[swapped, ::-1]
    return np.asarray(np.unique(there.reshape(-1, 4), axis=0).reshape(-1, 2, 2))


def _key(sides: np.ndarray, turn: np.ndarray) -> tuple[float, ...]:
    return tuple(_ordered(sides, turn).ravel().tolist())


def _rounded(part: BaseGeometry) -> BaseGeometry:
    import shapely

    return shapely.normalize(shapely.transform(part, lambda at: np.round(at, DIGITS) + 0.0))


def _mesh(at: np.ndarray, elements: np.ndarray) -> MeshQuad:
    return MeshQuad(np.ascontiguousarray(at.T), np.ascontiguousarray(elements.T))
