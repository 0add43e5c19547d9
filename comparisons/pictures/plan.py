"""The plan of a scene for figures: a mesh and lines on the sheet, its rims, supported lines, arrows of loads.

The largest point load has the longest arrow. Arrows of an edge load are spread along its edge, arrows of a
pressure over the sheet and along its normal.
"""

from collections.abc import Callable, Sequence

import numpy as np

from sheetbench.answers.solution import FieldMesh
from sheetbench.scenes import AreaLoad, EdgeLoad, PointLoad, Pressure, Scene, Support
from sheetbench.scenes.meaning.composition import shares_of
from sheetbench.scenes.meaning.region import edge_parts
from sheetbench.scenes.objects.cutouts import nearest
from sheetbench.scenes.objects.grid import near_square
from sheetbench.scenes.objects.shapes import Shape
from sheetbench.scenes.objects.sheet import EDGES
from sheetbench.scenes.objects.supports import place

PLAN_CELLS = 64
EYE_OFFSET = np.radians(24.0)  # angle from the free side's direction to the eye
LEAST_SHARE = 0.05  # of a cell's area on the sheet: cells below are not drawn


def plan_mesh(scene: Scene, cells: int = PLAN_CELLS) -> FieldMesh:
    """Return quadrilaterals on the flat sheet, `cells` along the shorter side, without fields. x runs
    fastest; points of cells at rims other than the rectangle's are moved to the rim."""
    sheet = scene.sheet
    nx, ny = near_square(sheet, cells)
    y, x = np.meshgrid(
        np.linspace(0, sheet.length_y, ny + 1), np.linspace(0, sheet.length_x, nx + 1), indexing="ij"
    )
    points = np.column_stack([x.ravel(), y.ravel(), np.zeros(x.size)])
    corner = (np.arange(ny)[:, None] * (nx + 1) + np.arange(nx)).ravel()
    quads = np.column_stack([corner, corner + 1, corner + nx + 2, corner + nx + 1])
    if scene.pierced:
        lines = (np.linspace(0.0, length, n + 1) for length, n in zip(sheet.lengths, (nx, ny), strict=True))
        quads = quads[shares_of(scene.region, *lines).ravel() > LEAST_SHARE]
        used, quads = np.unique(quads, return_inverse=True)
        points, quads = points[used], quads.reshape(-1, 4)
        points[:, :2] = on_sheet(scene, points[:, :2])
    return FieldMesh(points, [("quad", quads)], {})


def inside(scene: Scene, points: np.ndarray) -> np.ndarray:
    """Return whether plan points (n, 2) [m] of the rectangle lie on the sheet, (n,)."""
    if not scene.pierced:
        return np.ones(len(points), dtype=bool)
    import shapely

    return np.asarray(shapely.contains_xy(scene.region, *points.T))


def on_sheet(scene: Scene, points: np.ndarray) -> np.ndarray:
    """Return the points of the sheet nearest to plan points (n, 2) [m]."""
    if not scene.pierced:
        return np.clip(points, 0.0, scene.sheet.lengths)
    import shapely

    out = points.copy()
    for n in np.flatnonzero(~shapely.contains_xy(scene.region, *points.T)):
        out[n] = nearest(scene.region, (points[n, 0], points[n, 1]))
    return out


def plan_lines(scene: Scene, cells: int) -> list[np.ndarray]:
    """Return plan lines (n, 2) [m] that divide the sheet into `cells` along the shorter side."""
    if cells == 0:
        return []
    (nx, ny), (lx, ly) = near_square(scene.sheet, cells), scene.sheet.lengths
    ends = [((x, 0.0), (x, ly)) for x in np.linspace(0, lx, nx + 1)]
    ends += [((0.0, y), (lx, y)) for y in np.linspace(0, ly, ny + 1)]
    if scene.pierced:
        from shapely import LineString

        pieces = [scene.region.intersection(LineString(pair)) for pair in ends]
        parts = [part for piece in pieces for part in getattr(piece, "geoms", [piece])]
        ends = [(part.coords[0], part.coords[-1]) for part in parts if part.length > 0.0]
    return [_divided(pair, 2 * PLAN_CELLS + 1) for pair in ends]


def rims(scene: Scene) -> list[np.ndarray]:
    """Return the rims of the flat sheet, each as its corners in order with the first repeated, (n, 2) [m]."""
    if scene.pierced:
        return [np.array(ring.coords) for ring in (scene.region.exterior, *scene.region.interiors)]
    lx, ly = scene.sheet.lengths
    return [np.array([[0, 0], [lx, 0], [lx, ly], [0, ly], [0, 0]], dtype=float)]


def held_lines(scene: Scene, support: Support) -> list[np.ndarray]:
    """Return plan lines (n, 2) [m] of a support: its edge, or the rim of its part of the sheet."""
    shape = place(support)
    if shape is not None:
        part = scene.region.intersection(shape.area)
        rims = (getattr(piece, "exterior", piece) for piece in getattr(part, "geoms", [part]) if piece.length)
        return [np.array(rim.segmentize(0.02 * max(scene.sheet.lengths)).coords) for rim in rims]
    return [_divided(ends, 60) for ends in edge_ends(scene, support.edge)]


def eye_heading(scene: Scene) -> float:
    """Return the direction on the plan towards the eye [rad]: away from supported edges, turned a little."""
    held = [support.edge for support in scene.supports if place(support) is None]
    free = -sum((np.array(EDGES[edge].outward[:2]) for edge in held), np.zeros(2))
    return float(np.arctan2(free[1], free[0]) if np.any(free) else np.radians(-40.0)) - EYE_OFFSET


def edge_ends(
    scene: Scene, edge: str, where: Shape | None = None
) -> list[tuple[Sequence[float], Sequence[float]]]:
    """Return both ends [m] of every part of an edge on the sheet; where: the part inside a shape."""
    if not scene.pierced and where is None:
        return [scene.sheet.edge_ends(edge)]
    across, turn = scene.sheet.edge_at(edge), -1 if EDGES[edge].along_axis else 1  # x, y of along, across
    parts = edge_parts(scene, edge, where)
    return [((start, across)[::turn], (stop, across)[::turn]) for start, stop in parts]


def _divided(ends: tuple[Sequence[float], Sequence[float]], count: int) -> np.ndarray:
    start, end = np.array(ends)
    return np.asarray(start + np.linspace(0.0, 1.0, count)[:, None] * (end - start))


POINT, EDGE, PRESSURE = 0.16, 0.1, 0.08  # lengths of arrows, of the sheet's longer side; POINT: the largest
SHORTEST = 0.4  # length of the shortest point arrow, of the largest
ALONG = 5  # arrows along an edge
ACROSS = np.linspace(0.2, 0.8, 4)  # positions of a pressure's arrows, as fractions of both sides


def load_arrows(scene: Scene, normals: Callable[[np.ndarray], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return the start points of arrows on the plan (n, 2) [m] and the arrows (n, 3) in units of the sheet's
    longer side; normals: unit normals (n, 3) of the deformed sheet at plan points."""
    points = [load for load in scene.loads if isinstance(load, PointLoad)]
    plan = [np.array([load.at for load in points]).reshape(-1, 2)]
    arrows = [point_arrows(np.array([load.force for load in points]).reshape(-1, 3))]
    for load in scene.loads:
        if isinstance(load, EdgeLoad) and any(load.force_per_length):
            plan.append(edge_plan(scene, load.edge, np.linspace(0.0, 1.0, ALONG), load.where))
            arrows.append(np.tile(EDGE * _direction(load.force_per_length), (len(plan[-1]), 1)))
        elif isinstance(load, AreaLoad) and any(load.force_per_area):
            plan.append(_spread_points(scene, load.where))
            arrows.append(np.tile(PRESSURE * _direction(load.force_per_area), (len(plan[-1]), 1)))
        elif isinstance(load, Pressure) and load.value:
            plan.append(_spread_points(scene, load.where))
            arrows.append(PRESSURE * np.sign(load.value) * normals(plan[-1]))
    return np.vstack(plan), np.vstack(arrows)


def edge_plan(scene: Scene, edge: str, shares: np.ndarray, where: Shape | None = None) -> np.ndarray:
    """Return plan points (n, 2) [m] at fractions of every part of an edge; where: the part inside a shape."""
    ends = np.array(edge_ends(scene, edge, where))
    return np.vstack([start + shares[:, None] * (end - start) for start, end in ends])


def _spread_points(scene: Scene, where: Shape | None) -> np.ndarray:
    """Return evenly spread plan points (n, 2) [m] of the sheet, or of its part inside a shape."""
    box = np.array([(x, y) for x in ACROSS for y in ACROSS])
    if where is None and not scene.pierced:
        return box * scene.sheet.lengths
    part = scene.region if where is None else scene.region.intersection(where.area)
    from shapely import Point

    low, high = np.array(part.bounds).reshape(2, 2)
    points = low + box * (high - low)
    inside = points[[part.contains(Point(*point)) for point in points]]
    return inside if len(inside) else np.array(part.representative_point().coords)


def _direction(force: tuple[float, float, float]) -> np.ndarray:
    return np.array(force) / np.linalg.norm(force)


def point_arrows(forces: np.ndarray) -> np.ndarray:
    """Return arrows (n, 3) of forces (n, 3) in units of the sheet's longer side: proportional to the forces,
    but at least SHORTEST of the largest."""
    sizes = np.linalg.norm(forces, axis=1, keepdims=True)
    largest = float(sizes.max(initial=0.0))
    if not largest:
        return np.zeros_like(forces)
    lengths = POINT * np.maximum(sizes / largest, SHORTEST)
    return np.asarray(lengths * forces / np.where(sizes > 0.0, sizes, 1.0))
