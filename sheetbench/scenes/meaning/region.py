"""Parts of a scene's plan: their lengths, areas and resultants, and faults of parts outside the sheet."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from sheetbench.scenes.objects.cutouts import LEAST_CONNECTION, common
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.grading import Places
from sheetbench.scenes.objects.loads import AnyLoad, AreaLoad, EdgeLoad, PointLoad
from sheetbench.scenes.objects.quantities import PlanPoint
from sheetbench.scenes.objects.shapes import COINCIDENT, Shape, straight_sides
from sheetbench.scenes.objects.sheet import EDGES
from sheetbench.scenes.objects.supports import AnySupport, Point, named, place


def edge_parts(scene: SceneFields, edge: str, where: Shape | None = None) -> list[tuple[float, float]]:
    """Return the intervals [m] along an edge where the sheet reaches it, or their parts in a shape."""
    (normal, along, _), at = EDGES[edge], scene.sheet.edge_at(edge)
    spans = []
    for ring in (scene.region.exterior, *scene.region.interiors):
        corners = np.array(ring.coords)
        there = np.abs(corners[:, normal] - at) < COINCIDENT * max(scene.sheet.lengths)
        sides = np.stack([corners[:-1, along], corners[1:, along]], axis=1)[there[:-1] & there[1:]]
        spans += [(low, high) for low, high in np.sort(sides, axis=1).tolist()]
    if where is None:
        return spans
    from shapely import LineString

    lines = [LineString([(c, at) if along == 0 else (at, c) for c in ends]) for ends in spans]
    cut: list[Any] = [line.intersection(where.area) for line in lines]
    bounds = [part.bounds for each in cut for part in getattr(each, "geoms", [each]) if part.length > 0.0]
    return [(each[along], each[along + 2]) for each in bounds]


def sides_of_shapes(scene: SceneFields) -> Places:
    """Return x and y [m], rising, within the edges, of axis-parallel sides of the rim and of shapes. The
    shapes hold or load the sheet. Ends of the rim's sides on the edges, and held points, are included."""
    shapes = [place(support) for support in scene.supports if not isinstance(support, Point)]
    shapes += [getattr(acting, "where", None) for acting in (*scene.loads, *scene.masses)]
    rims = [scene.region] if scene.pierced else []
    sides = straight_sides(*rims, *(shape.area for shape in shapes if shape is not None))
    for axis, at in ((axis, s.at[axis]) for s in scene.supports if isinstance(s, Point) for axis in (0, 1)):
        sides[axis].add(at)
    for name, edge in EDGES.items() if scene.pierced else ():
        sides[edge.along_axis].update(at for part in edge_parts(scene, name) for at in part)
    x, y = (
        tuple(sorted(at for at in one if COINCIDENT * length < at < (1.0 - COINCIDENT) * length))
        for one, length in zip(sides, scene.sheet.lengths, strict=True)
    )
    return x, y


def edge_length(scene: SceneFields, edge: str, where: Shape | None = None) -> float:
    """Return the length [m] of the part of an edge that the sheet reaches, or of its part in a shape."""
    if where is None and not scene.pierced:
        return scene.sheet.lengths[EDGES[edge].along_axis]
    return sum(stop - start for start, stop in edge_parts(scene, edge, where))


def area_in(scene: SceneFields, shape: Shape | None) -> float:
    """Return the area [m²] of the sheet, or of its part in a shape."""
    if not scene.pierced and shape is None:
        return scene.sheet.length_x * scene.sheet.length_y
    return float((scene.region if shape is None else common(scene.region, shape.area)).area)


def resultant(scene: SceneFields, load: AnyLoad, length: float | None = None) -> np.ndarray:
    """Return the force (3,) [N] of a load in full, for a pressure on the flat sheet. length: of the load's
    edge [m] in a model, which may differ from the scene's."""
    if isinstance(load, PointLoad):
        return np.array(load.force)
    if isinstance(load, EdgeLoad):
        if length is None or load.where is not None:
            length = edge_length(scene, load.edge, load.where)
        return length * np.array(load.force_per_length)
    per_area = load.force_per_area if isinstance(load, AreaLoad) else (0.0, 0.0, load.value)
    return area_in(scene, load.where) * np.array(per_area)


def marked(scene: SceneFields) -> dict[str, PlanPoint]:
    """Return the plan points [m] of probes, point loads, payloads and held points, by their keys."""
    loads = {f"load {n}.at": each.at for n, each in enumerate(scene.loads, 1) if isinstance(each, PointLoad)}
    payloads = {f"mass {n}.at": each.at for n, each in enumerate(scene.masses, 1) if each.at is not None}
    pins = {f"{name}.at": s.at for name, s in named(scene.supports).items() if isinstance(s, Point)}
    return {f"probes.{name}": point for name, point in scene.probes.items()} | loads | payloads | pins


def share_of(scene: SceneFields, corners: np.ndarray) -> np.ndarray:
    """Return the share on the sheet (n,) of quadrilaterals with corners (n, 4, 2) [m]; 1 for other cells."""
    import shapely

    if corners.shape[1] != 4:
        return np.ones(len(corners))
    cells = shapely.polygons(corners)
    return np.asarray(shapely.area(shapely.intersection(cells, scene.region)) / shapely.area(cells))


def off_sheet(scene: SceneFields, point: PlanPoint) -> bool:
    """Return whether a plan point [m] lies outside the sheet."""
    from shapely import Point

    return bool(scene.region.distance(Point(point)) > COINCIDENT * max(scene.sheet.lengths))


def nearest_on_sheet(scene: SceneFields, points: np.ndarray) -> np.ndarray:
    """Return the points of the sheet (n, 2) [m] that are nearest to plan points (n, 2) [m]."""
    import shapely

    lines = shapely.shortest_line(shapely.points(points), scene.region)
    return np.asarray(shapely.get_coordinates(lines).reshape(-1, 2, 2)[:, 1])


def with_rims(scene: SceneFields) -> tuple[AnySupport, ...]:
    """Return the supports with shapes in place of rims and holes, for a whole rectangle with its edges.
    Raises ValueError for a hole that the sheet lacks, and for a rim in another object than a support."""
    others = {"patch": scene.patches, "cutout": scene.cutouts, "load": scene.loads, "mass": scene.masses}
    for kind, parts in others.items():
        for number, part in enumerate(parts, start=1):
            shape = getattr(part, "shape", None) or getattr(part, "where", None)
            if shape is not None and (shape.rim or shape.hole):
                raise ValueError(f"{kind} {number}: rim and hole are for a support's where only")
    supports: list[AnySupport] = []
    for number, support in enumerate(scene.supports, start=1):
        shape = None if isinstance(support, Point) else place(support)
        if shape is None or not (shape.rim or shape.hole):
            supports.append(support)
        elif shape.rim and not scene.sheet.drawn:
            supports += [support.replace(where=None, edge=edge) for edge in EDGES]
        elif shape.rim:
            supports.append(support.replace(where=Shape(beyond=_corners(scene.region.exterior))))
        else:
            supports.append(support.replace(where=_hole(scene, shape.hole or 0, f"support {number}.where")))
    return tuple(supports)


def _hole(scene: SceneFields, number: int, key: str) -> Shape:
    """Return the shape of a hole by its number from 1. Raises ValueError if the sheet lacks it."""
    shapes = [cutout.shape for cutout in scene.cutouts]
    if not shapes:
        rings = sorted(scene.region.interiors, key=lambda ring: float(ring.centroid.x))
        shapes = [Shape(polygon=_corners(ring)) for ring in rings]
    if number > len(shapes):
        raise ValueError(f"{key}: hole = {number}: the sheet has {len(shapes)}")
    return shapes[number - 1]


def _corners(ring: Any) -> tuple[PlanPoint, ...]:
    return tuple((x, y) for x, y in ring.coords[:-1])


def misplaced(scene: SceneFields) -> Iterator[object]:
    """Yield sentences on points and parts that are held, loaded or probed off the sheet, or false values."""
    for key, point in marked(scene).items():
        where = f"{key} = {list(point)} m: there is no sheet, by its outline or a cutout"
        yield off_sheet(scene, point) and where
    parts: dict[str, Any] = {name: s for name, s in named(scene.supports).items() if not isinstance(s, Point)}
    parts |= {f"load {n}": load for n, load in enumerate(scene.loads, start=1)}
    parts |= {f"mass {n}": payload for n, payload in enumerate(scene.masses, start=1)}
    least = LEAST_CONNECTION * min(scene.sheet.lengths)
    for name, part in parts.items():
        if (shape := getattr(part, "where", None)) is not None:
            where = f"{name}.where: {shape.in_words()}: no part of"
            overlaps = area_in(scene, shape) > least**2
            if not overlaps and name in named(scene.supports):  # the line along which it touches the sheet
                overlaps = common(scene.region, shape.area).length > least
            yield not overlaps and f"{where} it is on the sheet"
            if isinstance(part, EdgeLoad):
                loaded = edge_length(scene, part.edge, shape) > least
                yield not loaded and f"{where} edge {part.edge} is in it"
    for name, edge in ((name, getattr(part, "edge", None)) for name, part in parts.items()):
        where = f"{'support' if name == edge else name} on edge {edge}"
        touches = f"{where}: the sheet touches that edge at points at most; say where by a shape"
        yield edge and edge_length(scene, edge) <= least and touches
    for number, actuator in enumerate(scene.actuators, start=1):
        length = scene.sheet.lengths[EDGES[actuator.edge].along_axis]
        short = f"actuator {number}: the sheet does not reach all of edge {actuator.edge}, which it moves"
        yield edge_length(scene, actuator.edge) < (1.0 - COINCIDENT) * length and short
    yield _motion_conflict(scene)


def _motion_conflict(scene: SceneFields) -> str:
    """Return a sentence on two supports that move one part of the sheet differently, "" without any."""
    import shapely

    supports = named(scene.supports)
    names, motions = list(supports), [support.motion for support in supports.values()]
    if all(motion == motions[0] for motion in motions):
        return ""
    shapes = [place(support) for support in supports.values()]
    ends = [scene.sheet.edge_ends(support.edge) if support.edge else () for support in supports.values()]
    held = [shapely.LineString(e) if s is None else s.area for s, e in zip(shapes, ends, strict=True)]
    for one, other in shapely.STRtree(held).query(held, predicate="intersects").T.tolist():
        if shapes[one] and (shapes[other] is None or other > one) and motions[one] != motions[other]:
            return f"{names[one]} and {names[other]} move the same part of the sheet differently"
    return ""
