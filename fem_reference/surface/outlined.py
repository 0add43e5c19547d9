"""Quadrilateral meshes of plans with outlines, holes and inner borders of any shape.

The Delaunay triangles of the points (`mesh_points`) are joined in pairs to quadrilaterals, the best pairs
first; then every quadrilateral is cut into four and every remaining triangle into three, and inner vertices
are moved to the mean of their neighbours where elements get better. Away from borders the elements are
squares. Sides on borders are biquadratic: their middle nodes lie on the border too.

A side of a border is an edge of the Delaunay triangulation if no point lies in the circle over it (Gabriel);
one that is no edge is halved. Lengths are in sizes of the largest triangles, two elements.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np
from skfem import MeshQuad, MeshQuad2

from fem_reference.surface.biquadratic import AT_GAUSS, jacobians
from fem_reference.surface.mesh_points import (
    ATOL,
    Sides,
    SizeField,
    borders_between_corners,
    divided_borders,
    filling,
    on_borders,
)
from fem_reference.surface.placement import DIGITS, CentredPlan, PlanCells, centred, mesh_of_cells, reflection
from sheetbench.errors import NoMesh
from sheetbench.numerics.cache import cached
from sheetbench.scenes.objects.plan_mesh import divided

if TYPE_CHECKING:
    from shapely import LineString
    from shapely.geometry.base import BaseGeometry

PROPORTIONAL_ABOVE = 4.0  # sizes across a sheet, above which borders are divided in proportion
SKEW = np.pi / 4.0  # largest difference from right angles in a quadrilateral of two triangles
SKEWEST = np.pi / 3.0  # largest difference from right angles beside rows along the rim
FLAT = 1e-6  # area of a triangle between points of a straight border, over its longest side squared
SHIFT = 1e-7 * np.array([[1.0, np.sqrt(2.0)], [-np.sqrt(2.0), 1.0]])  # so that no four points lie on a circle
LAYERS = (0.12, 0.4)  # cuts of the row along the rim, as shares of its depth
HALVINGS = 2  # of the cuts, where elements beside the row would be too skew
TIP = 0.5  # least 2 (1 − cos of the angle) at a rim's vertex
LEAST_AREA = 0.02  # least ratio of det J between an element's points; below, its sides stay straight
ROUNDS, SWEEPS = 12, 6  # of halving sides, of moving vertices
TOO_CLOSE = (
    "borders of shapes lie too close to each other for elements between them: more elements, or move one"
)


@cached(last=8, most=1 << 16)
def quadrilaterals(
    region: BaseGeometry, inner: BaseGeometry, spacing: tuple[float, float], graded: bool = False
) -> MeshQuad2:
    """Return a mesh of a plan region with elements of about the spacing along x and y [m]. inner: lines
    within the region for sides of elements; graded: the row along the rim is cut into thinner ones. Raises
    NoMesh where borders lie too close to each other to be meshed."""
    from shapely import affinity

    unit = 2.0 * np.array(spacing)
    plan = centred(*(affinity.scale(part, *(1.0 / unit), origin=(0.0, 0.0)) for part in (region, inner)))
    region, inner = plan.part
    borders = plan.turned(borders_between_corners(region, inner))
    across = np.min(np.ptp(np.reshape(plan.region.bounds, (2, 2)), axis=0))
    size = SizeField.of(region, borders, min(1.0, PROPORTIONAL_ABOVE / across))
    size = SizeField(plan.images(size.places).reshape(-1, 2), np.repeat(size.sizes, len(plan.turns)))
    cut, mirror = plan.cut(borders)
    points, sides = divided_borders(borders, size, mirror >= 0)
    inside = filling(region, borders, sides, size, mirror >= 0, plan.orbits)
    points, triangles, sides = _triangles(region, borders, sides, points, inside)
    on_border = ~cut[sides.border]
    border, span = sides.border[on_border], sides.span[on_border]
    quarters = [on_borders(borders, border, span @ [1.0 - at, at]) for at in (0.25, 0.5, 0.75)]
    joined = _merge_triangles(points, triangles, sides, mirror[sides.border], plan)
    cells, ends, places = plan.unfolded(joined, sides.ends[on_border], np.stack(quarters, axis=1))
    mesh, middles = _subdivide(cells, ends, places[:, 1])
    ends = np.concatenate([np.column_stack([ends[:, end], middles]) for end in (0, 1)])
    places = np.concatenate([places[:, 0], places[:, 2]])
    mesh = _smooth(mesh, np.unique(ends))
    rim = _keys(mesh.facets[:, mesh.boundary_facets()].T, mesh.nvertices)
    if not np.isin(rim, _keys(ends, mesh.nvertices)).all():  # a part of the sheet has no triangles
        raise NoMesh(TOO_CLOSE)
    if graded:
        mesh, ends, places = _graded(mesh, ends, places)
    mesh, places = plan.back(mesh, places)
    return _biquadratic(mesh, ends, places, unit)


def _triangles(
    region: BaseGeometry, borders: Sequence[LineString], sides: Sides, points: np.ndarray, inside: np.ndarray
) -> tuple[np.ndarray, np.ndarray, Sides]:
    """Return all points, the triangles (m, 3) of the region counter-clockwise, and the sides, some halved."""
    import shapely
    from scipy.spatial import Delaunay

    for _ in range(ROUNDS):
        vertices = np.concatenate([points, inside])
        shift = np.sum(vertices**2, axis=1, keepdims=True) * (vertices @ SHIFT)
        triangles = Delaunay(vertices + shift).simplices
        edges = _keys(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), len(vertices))
        missing = ~np.isin(_keys(sides.ends, len(vertices)), edges)
        if not missing.any():
            break
        middle, new = sides.middle[missing], len(points) + np.arange(missing.sum())
        points = np.concatenate([points, on_borders(borders, sides.border[missing], middle)])
        first, last = sides.ends[missing].T
        halves = [np.column_stack([first, new]), np.column_stack([new, last])]
        begin, end = sides.span[missing].T
        spans = [sides.span[~missing], np.column_stack([begin, middle]), np.column_stack([middle, end])]
        border = np.concatenate([sides.border[~missing], *[sides.border[missing]] * 2])
        sides = Sides(np.concatenate([sides.ends[~missing], *halves]), border, np.concatenate(spans))
    else:
        raise NoMesh(TOO_CLOSE)
    a, b, c = np.moveaxis(vertices[triangles], 1, 0)
    twice = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0]
    longest = np.max([np.sum((p - q) ** 2, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    chords = shapely.get_parts(shapely.polygonize(shapely.linestrings(vertices[sides.ends])))
    if not len(chords):
        raise NoMesh(TOO_CLOSE)
    areas = shapely.area(shapely.intersection(chords, region))
    present = shapely.union_all(chords[areas > 0.5 * shapely.area(chords)])
    shapely.prepare(present)
    valid = (np.abs(twice) > FLAT * longest) & shapely.contains_xy(present, (a + b + c) / 3.0)
    turned = np.where(twice[:, None] > 0.0, triangles, triangles[:, ::-1])
    return vertices, turned[valid], sides


def _keys(ends: np.ndarray, count: int) -> np.ndarray:
    """Return a number for each pair (k, 2) of points, which does not depend on their order."""
    low, high = np.sort(ends, axis=1).T
    return np.asarray(low * np.int64(count) + high)


def _merge_triangles(
    points: np.ndarray, triangles: np.ndarray, sides: Sides, mirror: np.ndarray, plan: CentredPlan
) -> PlanCells:
    """Return the quadrilaterals of two triangles each, the best first, and the remaining triangles. mirror:
    (k,) the number of the diagonal under a side, across which a triangle is joined with its image; −1 else.
    """
    edges = triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    keys, borders = _keys(edges, len(points)), _keys(sides.ends, len(points))
    order = np.argsort(keys, kind="stable")
    twin = np.flatnonzero(keys[order][1:] == keys[order][:-1])
    first_edge, second_edge = order[twin], order[twin + 1]
    inner = ~np.isin(keys[first_edge], borders)
    folded = np.flatnonzero(np.isin(keys, borders[mirror >= 0]))
    first_edge, second_edge = (np.append(edge[inner], folded) for edge in (first_edge, second_edge))
    apex = triangles[:, [2, 0, 1]].ravel()
    quads = np.column_stack([edges[first_edge, 0], apex[second_edge], edges[first_edge, 1], apex[first_edge]])
    corners, across = points[quads], np.full(len(first_edge), -1)
    across[len(first_edge) - len(folded) :] = mirror[mirror >= 0][_places(keys[folded], borders[mirror >= 0])]
    for number, normal in enumerate(plan.mirrors):
        kites = across == number
        corners[kites, 1] = corners[kites, 1] @ reflection(normal)
    skew = np.abs(_angles(corners) - 0.5 * np.pi).max(axis=1)
    place = plan.along(points[quads].mean(axis=1)).max(axis=1)
    unused, pairs = np.ones(len(triangles), bool), []
    for pair in np.lexsort([np.round(place, DIGITS), np.round(skew, DIGITS)]):
        a, b = first_edge[pair] // 3, second_edge[pair] // 3
        if skew[pair] < SKEW and unused[a] and unused[b]:
            unused[[a, b]] = False
            pairs.append(pair)
    unmirrored = across[pairs] < 0
    kites, single = quads[pairs][~unmirrored][:, [0, 2, 3]], triangles[unused]
    diagonals = np.concatenate([np.full(len(single), -1), across[pairs][~unmirrored]])
    return PlanCells(points, quads[pairs][unmirrored], np.concatenate([single, kites]), diagonals)


def _places(keys: np.ndarray, of: np.ndarray) -> np.ndarray:
    """Return the indices of keys among other keys, which contain them all."""
    order = np.argsort(of)
    return np.asarray(order[np.searchsorted(of, keys, sorter=order)])


def _angles(corners: np.ndarray) -> np.ndarray:
    """Return the inner angles (m, k) of polygons (m, k, 2), counter-clockwise."""
    onwards, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
    turn = onwards[..., 0] * back[..., 1] - onwards[..., 1] * back[..., 0]
    return np.asarray(np.arctan2(turn, np.sum(onwards * back, axis=-1)) % (2.0 * np.pi))


def _subdivide(part: PlanCells, ends: np.ndarray, places: np.ndarray) -> tuple[MeshQuad, np.ndarray]:
    """Return the mesh of every cell's corners with its centre, and the mid-side vertices (k,) of sides on
    borders. ends (k, 2): the sides' vertices; places (k, 2): of their middles."""
    count, cells = len(part.points), [part.quads, part.triangles]
    vertices, elements = divided(part.points, cells)
    edges = [np.stack([cell, np.roll(cell, -1, axis=1)], axis=-1).reshape(-1, 2) for cell in cells]
    middles = count + np.searchsorted(np.unique(_keys(np.concatenate(edges), count)), _keys(ends, count))
    vertices[middles] = places
    return mesh_of_cells(vertices, elements), middles


def _smooth(mesh: MeshQuad, fixed: np.ndarray) -> MeshQuad:
    """Return the mesh with its free vertices moved, where none of their elements gets worse."""
    places, elements, ends = mesh.p.T.copy(), mesh.t.T, mesh.facets
    free = np.ones(len(places), bool)
    free[fixed] = False
    degree = np.bincount(ends.ravel(), minlength=len(places))[:, None]

    for _ in range(SWEEPS):
        total = np.zeros_like(places)
        np.add.at(total, ends[0], places[ends[1]])
        np.add.at(total, ends[1], places[ends[0]])
        moved = np.where(free[:, None], total / degree, places)
        before = _largest_skew(places, elements)
        for _ in range(ROUNDS):
            back = _largest_skew(moved, elements) > before + 1e-9
            if not back.any():
                break
            moved[back] = places[back]
        else:
            break
        places = moved
    return mesh_of_cells(places, mesh.t.T)


def _largest_skew(at: np.ndarray, elements: np.ndarray) -> np.ndarray:
    """Return the largest difference (n,) from a right angle in the elements (m, 4) at each vertex."""
    skew = np.abs(_angles(at[elements]) - 0.5 * np.pi).max(axis=1)
    out = np.zeros(len(at))
    np.maximum.at(out, elements, skew[:, None])
    return out


def _graded(mesh: MeshQuad, ends: np.ndarray, places: np.ndarray) -> tuple[MeshQuad, np.ndarray, np.ndarray]:
    """Return the mesh with further rows along its rim, for which its vertices move inwards; also ends and
    places. ends (k, 2), places (k, 2): of sides on borders and of their middles."""
    keys, rim = _keys(ends, mesh.nvertices), mesh.boundary_facets()
    on_rim = _places(_keys(mesh.facets[:, rim].T, mesh.nvertices), keys)
    inner = np.setdiff1d(np.arange(len(ends)), on_rim)
    points, element = mesh.p.T, mesh.f2t[0, rim]
    inwards = points[mesh.t[:, element]].mean(axis=0) - places[on_rim]
    along = np.diff(points[ends[on_rim]], axis=1)[:, 0]
    normal = along[:, ::-1] * [-1.0, 1.0] / np.linalg.norm(along, axis=1, keepdims=True)
    deep = np.sum(normal * inwards, axis=1)
    normal, deep = normal * np.sign(deep)[:, None], 2.0 * np.abs(deep)
    move, depth, count = np.zeros_like(points), np.full(len(points), np.inf), np.zeros(len(points))
    for end in ends[on_rim].T:
        np.add.at(move, end, normal)
        np.add.at(count, end, 1.0)
        np.minimum.at(depth, end, deep)
    vertices = np.flatnonzero(count)
    square = np.sum(move[vertices] ** 2, axis=1)  # 2 (1 + n₁ · n₂)
    move[vertices] *= (2.0 * depth[vertices] / np.maximum(square, TIP))[:, None]
    # borders that end there stay where they are
    for start_vertex, end_vertex in (ends[inner].T, ends[inner, ::-1].T):
        meets = count[start_vertex] > 0.0
        step, away = points[end_vertex[meets]] - points[start_vertex[meets]], move[start_vertex[meets]]
        move[start_vertex[meets]] = step * (np.sum(away**2, axis=1) / np.sum(away * step, axis=1))[:, None]
    allowed, share = np.maximum(_largest_skew(points, mesh.t.T), SKEWEST), np.ones(len(points))
    for _ in range(HALVINGS):
        share[_largest_skew(points + LAYERS[-1] * share[:, None] * move, mesh.t.T) > allowed + 1e-9] *= 0.5
    move *= share[:, None]
    in_middle, bulge = move[ends].mean(axis=1), places - points[ends].mean(axis=1)
    in_middle[on_rim] -= share[ends[on_rim]].mean(axis=1)[:, None] * bulge[on_rim]  # rows straighten inwards
    rim_number = np.full(len(points), -1)
    rim_number[vertices] = np.arange(len(vertices))
    new = [len(points) + rim_number[ends[on_rim]] + len(vertices) * row for row in range(len(LAYERS))]
    rows, shares = [*new, ends[on_rim]], [0.0, *LAYERS]
    moved = points + LAYERS[-1] * move
    new_points = [points[vertices] + share * move[vertices] for share in shares[:-1]]
    turned = along[:, 0] * normal[:, 1] < along[:, 1] * normal[:, 0]
    row_quads = [np.column_stack([low, high[:, ::-1]]) for low, high in pairwise(rows)]
    row_quads = [np.where(turned[:, None], quads[:, ::-1], quads) for quads in row_quads]
    in_rows = [places[on_rim] + share * in_middle[on_rim] for share in shares]
    return (
        mesh_of_cells(np.concatenate([moved, *new_points]), np.concatenate([mesh.t.T, *row_quads])),
        np.concatenate([ends[inner], *rows]),
        np.concatenate([places[inner] + LAYERS[-1] * in_middle[inner], *in_rows]),
    )


def _biquadratic(mesh: MeshQuad, ends: np.ndarray, places: np.ndarray, unit: np.ndarray) -> MeshQuad2:
    """Return the mesh [m] with the middle nodes of sides between ends (k, 2) at places (k, 2)."""
    curved = MeshQuad2.from_mesh(mesh)
    keys, nodes = _keys(mesh.facets.T, mesh.nvertices), curved.dofs.element_dofs.T
    straight, at = curved.doflocs.T, curved.doflocs.T.copy()
    facets = _places(_keys(ends, mesh.nvertices), keys)
    middles = curved.dofs.facet_dofs[0, facets]
    bent = np.abs(places - straight[middles]).max(axis=1) > ATOL  # by more than rounding of the vertices
    at[middles[bent]] = places[bent]
    for _ in range(2):
        at[nodes[:, 8]] = 0.5 * at[nodes[:, 4:8]].sum(axis=1) - 0.25 * at[nodes[:, :4]].sum(axis=1)
        area = np.linalg.det(jacobians(at[nodes], AT_GAUSS[1]))
        folded = nodes[area.min(axis=1) < LEAST_AREA * area.max(axis=1), 4:8]
        at[folded] = straight[folded]
    area = np.linalg.det(jacobians(at[nodes], AT_GAUSS[1]))
    if np.any(area.min(axis=1) * area.max(axis=1) <= 0.0):
        raise NoMesh(TOO_CLOSE)
    return dataclasses.replace(curved, doflocs=np.ascontiguousarray(at.T * unit[:, None]))
