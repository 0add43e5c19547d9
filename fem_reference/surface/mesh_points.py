"""Points of meshes that follow shapes: along borders, in a row beside them, and on a quadtree in the rest.

Borders are divided by their length, finer where they turn or lie close to each other; sizes grow from there.
Lengths are in sizes of the largest triangles, two elements.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from sheetbench.scenes import PiecewiseCurve

if TYPE_CHECKING:
    from shapely import LineString
    from shapely.geometry.base import BaseGeometry

CORNER = np.pi / 9.0  # least turn of a border at a corner; with less it is a curve
TURN = np.pi / 4.0  # turn of a curve from one vertex of the triangles to the next
GROWTH = 0.5  # of sizes, with the distance
ALONG = 2.0  # largest size beside a border, over its length
SMALLEST, NARROWEST = 1.0 / 256.0, 1.0 / 32.0  # sizes by turns and by gaps
GRID, ATOL = 1e-9, 1e-7  # of rounding; distance within which points are on the sheet
CLEARANCE = 0.6  # distance between borders and inner points, over the local size
SAMPLES = 4  # of a border, per size


class Sides(NamedTuple):
    """Sides of borders: end vertices (k, 2), border of each (k,) and its interval along it (k, 2)."""

    ends: np.ndarray
    border: np.ndarray
    span: np.ndarray

    @property
    def middle(self) -> np.ndarray:
        return self.span.mean(axis=1)


def borders_between_corners(region: BaseGeometry, inner: BaseGeometry) -> list[LineString]:
    """Return the borders from corner or crossing to corner or crossing."""
    import shapely

    lines = shapely.get_parts(shapely.union_all([region.boundary, inner], grid_size=GRID))
    on_sheet = shapely.distance(region, shapely.line_interpolate_point(lines, 0.5, normalized=True)) < ATOL
    borders: list[LineString] = []
    for line in shapely.get_parts(shapely.line_merge(shapely.union_all(lines[on_sheet]))):
        points = shapely.get_coordinates(line)
        closed = bool(line.is_closed)
        steps = np.diff(points, axis=0)
        steps = np.vstack([steps[-1:], steps]) if closed else steps
        turns = np.diff(np.unwrap(np.arctan2(steps[:, 1], steps[:, 0])))
        corners = np.flatnonzero(np.abs(turns) > CORNER) + (not closed)
        if closed and len(corners):
            points = np.roll(points[:-1], -corners[0], axis=0)
            points, corners = np.vstack([points, points[:1]]), corners - corners[0]
        cuts = np.unique([0, *corners, len(points) - 1])
        borders += [shapely.LineString(points[a : b + 1]) for a, b in pairwise(cuts)]
    return borders


class SizeField(NamedTuple):
    """Sizes of triangles: sizes (k,) below 1 at places (k, 2), from which they grow."""

    places: np.ndarray
    sizes: np.ndarray

    @classmethod
    def of(cls, region: BaseGeometry, borders: Sequence[LineString], coarse: float) -> SizeField:
        """Return the sizes by the turns and lengths of borders, and by the gaps across the sheet between
        borders that do not touch. Finer meshes divide turns and gaps more finely; coarse: the usual size of
        elements over the actual one, at most 1."""
        import shapely

        places, sizes = [], []
        for border in borders:
            spaced = np.linspace(0.0, border.length, 2 + int(SAMPLES * border.length))
            turning, radii = _radii(border)
            along = np.concatenate([spaced, turning])
            points = shapely.line_interpolate_point(border, along)
            by_turns = coarse * TURN * np.append(np.full(len(spaced), np.inf), radii)
            near_sizes = np.minimum(min(1.0, ALONG * border.length), by_turns)
            for other in borders:
                if not border.touches(other) and other is not border:
                    across = shapely.shortest_line(points, other)
                    middle = shapely.line_interpolate_point(across, 0.5, normalized=True)
                    gap = np.maximum(coarse * shapely.length(across), NARROWEST)
                    near = gap < near_sizes
                    near[near] = shapely.contains(region, middle[near])
                    near_sizes[near] = gap[near]
            places.append(shapely.get_coordinates(points))
            sizes.append(np.maximum(near_sizes, SMALLEST))
        small = np.concatenate(sizes) < 1.0
        field = cls(np.concatenate(places)[small], np.concatenate(sizes)[small])
        return cls(*(part[field._first] for part in field))

    @property
    def _first(self) -> np.ndarray:
        """Indices of one entry from each group closer than a quarter of their size, and of all others."""
        cells = np.floor(4.0 * self.places / self.sizes[:, None])
        scale = np.rint(np.log2(self.sizes))
        return np.unique(np.column_stack([cells, scale]), axis=0, return_index=True)[1]

    def at(self, points: np.ndarray) -> np.ndarray:
        """Return the sizes (n,) at points (n, 2)."""
        if not len(self.sizes):
            return np.ones(len(points))
        distance = np.linalg.norm(points[:, None] - self.places, axis=-1)
        return np.minimum(1.0, np.min(self.sizes + GROWTH * distance, axis=1))


def _radii(border: LineString) -> tuple[np.ndarray, np.ndarray]:
    """Return the places along a border where it turns, and the radii of the curve there."""
    import shapely

    steps = np.diff(shapely.get_coordinates(border), axis=0)
    steps = np.vstack([steps, steps[:1]]) if border.is_closed else steps
    lengths, angles = np.linalg.norm(steps, axis=1), np.arctan2(steps[:, 1], steps[:, 0])
    turns = np.abs((np.diff(angles) + np.pi) % (2.0 * np.pi) - np.pi)
    with np.errstate(divide="ignore"):
        return np.cumsum(lengths)[:-1], 0.5 * (lengths[1:] + lengths[:-1]) / turns


def divided_borders(
    borders: Sequence[LineString], size: SizeField, diagonal: np.ndarray
) -> tuple[np.ndarray, Sides]:
    """Return points (n, 2) along the borders, common where several meet, and the sides between them.
    diagonal: mask of borders that are diagonals of squares."""
    import shapely

    places, ends, on, spans = [], [], [], []
    for number, border in enumerate(borders):
        fine = np.linspace(0.0, border.length, 2 + int(8 * SAMPLES * border.length))
        sizes = size.at(shapely.get_coordinates(shapely.line_interpolate_point(border, fine)))
        if diagonal[number]:
            sizes[sizes == 1.0] *= np.sqrt(2.0)
        steps = np.concatenate([[0.0], np.cumsum(np.diff(fine) * 2.0 / (sizes[1:] + sizes[:-1]))])
        least = 3 if border.is_closed else min(2, len(border.coords) - 1)
        count = max(least, int(np.ceil(steps[-1] - 1e-6)))
        if diagonal[number]:  # as many as in `_quadtree`
            count = max(least, int(np.rint(steps[-1])))
        along = PiecewiseCurve(steps.tolist(), fine.tolist()).at(np.linspace(0.0, steps[-1], count + 1))
        places.append(shapely.get_coordinates(shapely.line_interpolate_point(border, along)))
        first = sum(len(at) for at in places[:-1])
        ends.append(first + np.arange(count)[:, None] + [0, 1])
        on.append(np.full(count, number))
        spans.append(np.column_stack([along[:-1], along[1:]]))
    points, indices = np.unique(np.round(np.concatenate(places), 9), axis=0, return_inverse=True)
    return points, Sides(indices.ravel()[np.concatenate(ends)], np.concatenate(on), np.concatenate(spans))


def on_borders(borders: Sequence[LineString], number: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Return points (k, 2) along borders, by the border's number and the length along it."""
    import shapely

    return shapely.get_coordinates(shapely.line_interpolate_point(np.array(borders)[number], along))


def filling(
    region: BaseGeometry,
    borders: Sequence[LineString],
    sides: Sides,
    size: SizeField,
    diagonal: np.ndarray,
    orbits: Callable[[np.ndarray], np.ndarray],
) -> np.ndarray:
    """Return inner points (n, 2): a row along borders, the squares' points across diagonals, then a
    quadtree's corners. orbits: a function from points (k, 2) to images (m, n, 2), points that are kept or
    dropped together."""
    import shapely

    closed = np.array([border.is_closed for border in borders])
    across = diagonal[sides.border] & (size.at(on_borders(borders, sides.border, sides.middle)) == 1.0)
    inner = np.flatnonzero((sides.span[:, 0] > 0.0) | closed[sides.border] | across)
    on, across = sides.border[inner], across[inner]
    along = np.where(across, sides.middle[inner], sides.span[inner, 0])
    step = 1e-3 * np.ptp(sides.span[inner], axis=1)
    points_on, ahead, behind = (on_borders(borders, on, along + by) for by in (0.0, step, -step))
    tangent = ahead - behind
    depth = np.where(across, 500.0 * step, size.at(points_on))
    normal = depth[:, None] * (tangent / np.linalg.norm(tangent, axis=1, keepdims=True))[:, ::-1] * [-1, 1]
    points = np.concatenate([points_on + normal, points_on - normal, _quadtree(region.bounds, size)])
    shapely.prepare(region)
    points = points[shapely.contains_xy(region, points)]
    distances = shapely.distance(shapely.points(points), shapely.multilinestrings(borders))
    images = orbits(points[distances > CLEARANCE * size.at(points)])
    points, turns = images.reshape(-1, 2), images.shape[1]
    gaps, keeps = CLEARANCE * size.at(points), np.ones(len(images), bool)
    from scipy.spatial import KDTree  # not loaded for rectangles

    for first, second in sorted(KDTree(points).query_pairs(gaps.max(initial=0.0))):
        if keeps[first // turns] and ATOL < np.linalg.norm(points[first] - points[second]) < gaps[second]:
            keeps[second // turns] = False
    return np.unique(np.round(images[keeps].reshape(-1, 2), 9), axis=0)


def _quadtree(bounds: tuple[float, float, float, float], size: SizeField) -> np.ndarray:
    """Return the corners (n, 2) of cells of the requested sizes."""
    low, lengths = np.array(bounds[:2]), np.array(bounds[2:]) - bounds[:2]
    counts = np.maximum(np.rint(lengths), 1.0).astype(int)
    side, corners = lengths / counts, []
    cells = low + side * (np.stack(np.meshgrid(*map(np.arange, counts)), axis=-1).reshape(-1, 2) + 0.5)
    quarters = 0.25 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    while len(cells):
        split = size.at(cells) < np.sqrt(0.5) * side.max()
        corners.append((cells[~split, None] + 2.0 * quarters * side).reshape(-1, 2))
        cells = (cells[split, None] + quarters * side).reshape(-1, 2)
        side = 0.5 * side
    return np.unique(np.round(np.concatenate(corners), 9), axis=0)
