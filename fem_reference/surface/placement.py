"""Canonical placement of plans, so that mirrored, turned or scaled plans have equal meshes.

There are eight ways to lay a plan along the axes; the last is taken, by comparing its ordered sides number by
number after rounding. A plan that is its own mirror image across x, y or a diagonal is meshed on one side of
that line alone: its mesh is its own image too. If a plan is its own image only when turned, the borders and
points of one sector are turned into the others. Lengths are in sizes of the largest triangles.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from skfem import MeshQuad

from fem_reference.surface.borders import straight_parts
from fem_reference.surface.mesh_points import ATOL

if TYPE_CHECKING:
    from shapely import LineString
    from shapely.geometry.base import BaseGeometry

DIGITS = 9  # of rounding, as in `mesh_points.GRID`
REFLECTIONS = [np.diag([x, y]) for x in (1.0, -1.0) for y in (1.0, -1.0)]
SYMMETRIES = [flip @ swap for swap in (np.eye(2), np.eye(2)[::-1]) for flip in REFLECTIONS]
FIRST = np.array([np.cos(1.0), np.sin(1.0)])  # an arbitrary angle
DIAGONALS = np.sqrt(0.5) * np.array([[1.0, -1.0], [1.0, 1.0]])  # normals of mirrors, towards the meshed part


class PlanCells(NamedTuple):
    """Quadrilaterals (q, 4) and triangles (t, 3) of points (n, 2), counter-clockwise. across: (t,) the number
    of the mirror under a triangle's first side, where it is to be joined with its image; else −1."""

    points: np.ndarray
    quads: np.ndarray
    triangles: np.ndarray
    across: np.ndarray


class CentredPlan(NamedTuple):
    """Plan about the origin, with the map back: x = p turn + centre. mirrors: normals of lines through the
    origin across which it is its own image, in the order of unfolding; turns (n, 2, 2): where there are no
    mirrors, the rotations that map it to itself, the identity first."""

    region: BaseGeometry
    inner: BaseGeometry
    centre: np.ndarray
    turn: np.ndarray
    mirrors: tuple[np.ndarray, ...]
    turns: np.ndarray

    @property
    def part(self) -> tuple[BaseGeometry, BaseGeometry]:
        """Region and inner borders on the far side of all mirrors."""
        import shapely

        beyond, (region, inner) = 4.0 * (1.0 + np.ptp(self.region.bounds)), (self.region, self.inner)
        for normal in self.mirrors:
            along = np.array([-normal[1], normal[0]])
            side = shapely.Polygon(beyond * np.array([along, normal, -along]))
            region, inner = (shapely.intersection(part, side) for part in (region, inner))
        return _rounded(region), _rounded(inner)

    def images(self, at: np.ndarray) -> np.ndarray:
        """Return the images (k, n, 2) of points (k, 2) by all turns."""
        return np.asarray((self.turns @ at[:, None, :, None])[..., 0])

    def along(self, at: np.ndarray) -> np.ndarray:
        """Return coordinates along FIRST (k, n) of the images of points (k, 2)."""
        return np.asarray(self.images(at) @ FIRST)

    def first(self, at: np.ndarray) -> np.ndarray:
        """Return a mask (k,) of points (k, 2) in the first sector."""
        return np.asarray(self.along(at).argmax(axis=1) == 0)

    def orbits(self, at: np.ndarray) -> np.ndarray:
        """Return the images (m, n, 2) by all turns of the points (k, 2) in the first sector."""
        return self.images(at[self.first(at)])

    def turned(self, borders: Sequence[LineString]) -> list[LineString]:
        """Return the images by all turns of borders in the first sector, and of parts around the centre."""
        import shapely
        from shapely.ops import substring

        middle = shapely.get_coordinates(shapely.centroid(borders))
        shares = np.where(np.hypot(*middle.T) < ATOL, 1.0 / len(self.turns), self.first(middle))
        pairs = zip(borders, shares.tolist(), strict=True)
        in_sector = [substring(line, 0.0, share, normalized=True) for line, share in pairs if share]
        copies = [self.images(shapely.get_coordinates(line)).swapaxes(0, 1) for line in in_sector]
        return [shapely.LineString(image) for images in copies for image in images]

    def cut(self, borders: Sequence[LineString]) -> tuple[np.ndarray, np.ndarray]:
        """Return a mask of the part's borders that lie on a mirror and are no borders of the plan, and the
        mirrors' numbers. The number is −1 unless the mirror is a diagonal."""
        import shapely

        plan_borders = shapely.union_all([self.region.boundary, self.inner])
        middle = shapely.line_interpolate_point(list(borders), 0.5, normalized=True)
        cut, diagonal = np.asarray(shapely.distance(plan_borders, middle) > ATOL), np.full(len(borders), -1)
        for number, normal in enumerate(self.mirrors):
            if np.all(normal):
                diagonal[cut & (np.abs(shapely.get_coordinates(middle) @ normal) < ATOL)] = number
        return cut, diagonal

    def unfolded(
        self, part: PlanCells, ends: np.ndarray, places: np.ndarray
    ) -> tuple[PlanCells, np.ndarray, np.ndarray]:
        """Return the cells of the part with their images, ends and places; a triangle on a diagonal becomes a
        quadrilateral. ends (k, 2): vertices of sides on borders; places (k, 3, 2): of the sides' quarter
        points."""
        at, quads, triangles, across = part
        for number, normal in enumerate(self.mirrors):
            away = at @ normal
            on = np.abs(away) < ATOL
            at = np.where(on[:, None], at - away[:, None] * normal, at)
            image = np.where(on, np.arange(len(at)), len(at) + np.cumsum(~on) - 1)
            beyond = ~on[ends].all(axis=1)
            kites, others = triangles[across == number], triangles[across != number]
            whole = np.column_stack([kites[:, 0], image[kites[:, 2]], kites[:, 1], kites[:, 2]])
            quads = np.concatenate([quads, image[quads][:, ::-1], whole])
            triangles = np.concatenate([others, image[others][:, [1, 0, 2]]])
            across = np.tile(across[across != number], 2)
            ends = np.concatenate([ends, image[ends[beyond]]])
            places = np.concatenate([places, places[beyond] @ reflection(normal)])
            at = np.concatenate([at, at[~on] @ reflection(normal)])
        return PlanCells(at, quads, triangles, across), ends, places

    def back(self, mesh: MeshQuad, places: np.ndarray) -> tuple[MeshQuad, np.ndarray]:
        """Return a mesh and places (k, 2) in the plan's original position. Points on its bounds up to
        rounding are moved onto the bounds."""
        half = np.ptp(np.reshape(self.region.bounds, (2, 2)), axis=0) @ np.abs(self.turn) / 2.0

        def moved(points: np.ndarray) -> np.ndarray:
            turned = points @ self.turn
            on = np.abs(np.abs(turned) - half) < ATOL
            return self.centre + np.where(on, np.sign(turned) * half, turned)

        upright = np.linalg.det(self.turn) > 0.0
        return mesh_of_cells(moved(mesh.p.T), mesh.t.T if upright else mesh.t.T[:, ::-1]), moved(places)


def centred(region: BaseGeometry, inner: BaseGeometry) -> CentredPlan:
    """Return a plan in the last of its eight placements."""
    import shapely

    centre = np.mean(np.reshape(region.bounds, (2, 2)), axis=0)
    parts = shapely.transform([region.boundary, inner], lambda at: np.round(at - centre, DIGITS))
    rims, lines = map(straight_parts, parts)
    keys = [[_ordered(part, turn).ravel().tolist() for part in (rims, lines)] for turn in SYMMETRIES]
    turn = SYMMETRIES[keys.index(max(keys))]
    images = [other @ turn.T for other, key in zip(SYMMETRIES, keys, strict=True) if key == max(keys)]
    axes, diagonals = (
        [normal for normal in normals if any(np.array_equal(reflection(normal), image) for image in images)]
        for normals in (np.eye(2), DIAGONALS)
    )
    cuts = (*diagonals[: 1 if axes else 2], *axes)  # with both axes and diagonals an eighth remains

    def to_place(at: np.ndarray) -> np.ndarray:
        return np.round(at - centre, DIGITS) @ turn.T + 0.0

    borders = shapely.multilinestrings(_ordered(lines, turn))
    region = shapely.normalize(shapely.transform(region, to_place))
    return CentredPlan(region, borders, centre, turn, cuts, np.array(images[:1] if cuts else images))


def reflection(normal: np.ndarray) -> np.ndarray:
    """Return the map to the mirror image across x, y or a diagonal, exact to the last digit."""
    return np.asarray(np.round(np.eye(2) - 2.0 * np.outer(normal, normal)) + 0.0)


def _ordered(sides: np.ndarray, turn: np.ndarray) -> np.ndarray:
    """Return sides (k, 2, 2) turned, each from its lesser end, in rising order, without duplicates."""
    turned = np.sort((sides @ turn.T + 0.0).view(complex), axis=1).view(float)
    return np.asarray(np.unique(turned.reshape(-1, 4), axis=0).reshape(-1, 2, 2))


def _rounded(part: BaseGeometry) -> BaseGeometry:
    import shapely

    return shapely.normalize(shapely.transform(part, lambda at: np.round(at, DIGITS) + 0.0))


def mesh_of_cells(at: np.ndarray, elements: np.ndarray) -> MeshQuad:
    """Return the mesh of vertices (n, 2) and elements (m, 4)."""
    return MeshQuad(np.ascontiguousarray(at.T), np.ascontiguousarray(elements.T))
