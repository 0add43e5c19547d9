"""Meshes that follow shapes: elements upright, sides on the borders, few triangulations."""

import numpy as np
import pytest
import shapely
from cases import sheet
from scipy.spatial import Delaunay, KDTree
from skfem import Basis, ElementQuad2

from fem_reference.surface.biquadratic import AT_GAUSS, GAUSS_WEIGHTS, jacobians, shape
from fem_reference.surface.location import locate
from fem_reference.surface.mesh import _through, mesh_of, plan_of
from fem_reference.surface.mesh_points import SizeField, _quadtree
from fem_reference.surface.outlined import quadrilaterals
from sheetbench.errors import NoMesh
from sheetbench.scenes import load

SEGMENTS = 64  # of a quarter of a circle
AT_NODES = shape(*(2.0 * ElementQuad2.doflocs.T - 1.0))
NONE = shapely.MultiLineString()
PLATE, FIN = shapely.box(0.0, 0.0, 0.2, 0.2), shapely.Polygon([(0, 0), (0.2, 0.06), (0.2, 0.14), (0, 0.2)])


def disc(x, y, radius):
    return shapely.Point(x, y).buffer(radius, quad_segs=SEGMENTS)


HOLES = shapely.union_all([disc(x, y, 0.02) for x in (0.05, 0.15) for y in (0.05, 0.14)])
PLANS = {
    "square": (PLATE, NONE),
    "annulus": (disc(0.1, 0.1, 0.1).difference(disc(0.1, 0.1, 0.04)), NONE),
    "fin with a stiff root": (FIN, shapely.LineString([(0.05, 0.0), (0.05, 0.2)])),
    "four holes": (PLATE.difference(HOLES), NONE),
    "round patch": (PLATE, disc(0.1, 0.08, 0.05).boundary),
    "two holes": (
        PLATE.difference(disc(0.2 / 3.0, 0.08, 0.08 / 3.0)).difference(
            disc(0.44 / 3.0, 0.4 / 3.0, 0.1 / 3.0)
        ),
        NONE,
    ),
    "hole near a rim": (PLATE.difference(disc(0.1, 0.052, 0.05)), NONE),
    "oblique slit": (PLATE.difference(shapely.LineString([(0.05, 0.06), (0.15, 0.14)]).buffer(0.001)), NONE),
}


@pytest.mark.parametrize(("elements", "even"), [(4, 4), (5, 6)])
def test_lines_through_a_middle_are_of_an_even_number_of_elements(elements, even):
    found = _through(np.linspace(0.0, 1.0, elements + 1), np.array([0.5]))
    assert found == pytest.approx(np.linspace(0.0, 1.0, even + 1))


def test_a_quadtree_has_each_corner_once():
    found = _quadtree((0.0, 0.0, 3.0, 1.0), SizeField(np.zeros((1, 2)), np.ones(1)))
    assert found.tolist() == [[x, y] for x in range(4) for y in range(2)]


def test_a_small_hole_is_divided_in_proportion_to_the_elements():
    """Meshes of 8, 12 and 16 had the same 16 sides on it, erred alike and agreed: their bars held 93 %."""
    counts = [
        len(
            quadrilaterals(
                PLATE.difference(disc(0.11, 0.093, 0.02)), NONE, (0.2 / n, 0.2 / n)
            ).boundary_facets()
        )
        for n in (8, 12, 16)
    ]
    on_hole = [count - 4 * n for count, n in zip(counts, (8, 12, 16), strict=True)]
    assert on_hole == [16, 24, 32]


@pytest.mark.sweep
@pytest.mark.parametrize("graded", [False, True])
@pytest.mark.parametrize("count", [6, 16])
@pytest.mark.parametrize("plan", PLANS)
def test_elements_fill_the_plan_and_stand_upright(plan, count, graded, monkeypatch):
    region, inner = PLANS[plan]
    sizes = []  # of the triangulations
    monkeypatch.setattr(
        "scipy.spatial.Delaunay", lambda points: sizes.append(len(points)) or Delaunay(points)
    )
    mesh = quadrilaterals(region, inner, (0.2 / count, 0.2 / count), graded)
    assert len(sizes) <= 2 and sum(sizes) <= mesh.nelements  # a point of a triangle has about two elements
    nodes, corners = plan_of(mesh).nodes, plan_of(mesh).corners
    area = np.linalg.det(jacobians(corners, AT_GAUSS[1]))
    assert area.min() > 0.0
    at_nodes = np.linalg.det(jacobians(corners, AT_NODES[1]))
    assert np.all(at_nodes.min(axis=1) > 0.05 * at_nodes.max(axis=1))  # squeezed ones had 1e-4
    # sides through three corners of a circle's polygon are the circle, which has 1e-4 more area
    polygon = (2.0 * np.pi / (4 * SEGMENTS)) ** 2 / 6.0
    assert Basis(mesh, ElementQuad2()).dx.sum() == pytest.approx(region.area, rel=1e-3 / count + polygon)
    rim = np.unique(mesh.facets[:, mesh.boundary_facets()])
    assert shapely.distance(region.boundary, shapely.points(nodes[rim])).max() < 1e-9
    on_inner = shapely.distance(inner, shapely.points(nodes)) < 1e-9  # as much of it as lies in the region
    sides = nodes[mesh.facets.T]
    along = on_inner[mesh.facets].all(axis=0)
    assert np.linalg.norm(np.diff(sides[along], axis=1)[:, 0], axis=1).sum() == pytest.approx(
        shapely.intersection(inner, region).length, rel=1e-2
    )


@pytest.mark.parametrize("count", [6, 16])
@pytest.mark.parametrize(("corners", "within"), [(6, 1e-6), (24, 1e-3), (96, 1e-3), (250, 1e-3)])
def test_a_polygon_with_its_corners_on_a_circle(corners, within, count):
    """Where their borders are nearly the same they are one; elsewhere what is between them is meshed."""
    turns = 2.0 * np.pi * np.arange(corners) / corners
    polygon = {"polygon": np.round(0.1 + 0.05 * np.stack([np.cos(turns), np.sin(turns)], 1), 8).tolist()}
    pressure = {"kind": "pressure", "value": 1.0, "where": polygon}
    patch = {"shape": {"circle": {"centre": (0.1, 0.1), "radius": 0.05}}, "young": 2e6}
    scene = sheet(0.2, 0.2, 0.002, loads=[pressure], patches=[patch])
    plan = plan_of(mesh_of(scene, count))
    area = np.linalg.det(jacobians(plan.corners, AT_GAUSS[1]))
    assert area.min() > 0.0
    weights = GAUSS_WEIGHTS * area[plan.within(scene.loads[0].where)]
    assert weights.sum() == pytest.approx(scene.loads[0].where.area.area, rel=within)


def test_a_sheet_without_elements_between_two_borders_is_refused():
    """A circle that reaches 0.6 mm beyond an edge: an index was out of bounds, or the part was missing."""
    circle = {"centre": (0.05751113918296833, 0.03877145273250193), "radius": 0.015973917074423933}
    clamp = {"kind": "clamped", "where": {"circle": circle}}
    scene = sheet(0.072887463402407, 0.1636361240755881, 1.38e-3, supports=[clamp])
    for graded in (True, False):
        with pytest.raises(NoMesh, match="lie too close to each other"):
            mesh_of(scene, 2, graded)
    assert mesh_of(scene, 4, True).nelements > 100


@pytest.mark.parametrize("count", [3, 12])
@pytest.mark.parametrize(
    "circles",  # of a hole and a patch [m]; sides of 0.05 to 0.1 mm were left beside crossings
    [
        [(0.0589, 0.0502, 0.0198), (0.0416, 0.0521, 0.0138)],
        [(0.0426, 0.0500, 0.0160), (0.0406, 0.0430, 0.0193)],
        [(0.0591, 0.0442, 0.0183), (0.0430, 0.0503, 0.0114)],
    ],
)
def test_a_hole_crosses_a_patch(circles, count):
    """A tenth of such scenes had an inverted element: where borders cross, corners of one were put on the
    other, and kinks remained, a corner each."""
    hole, stiff = [{"circle": {"centre": (x, y), "radius": radius}} for x, y, radius in circles]
    scene = sheet(0.1, 0.1, 0.001, cutouts=[{"shape": hole}], patches=[{"shape": stiff, "young": 2e6}])
    assert np.linalg.det(jacobians(plan_of(mesh_of(scene, count)).corners, AT_GAUSS[1])).min() > 0.0


def test_a_mirrored_hole_crosses_a_mirrored_patch():
    """Corners were put on borders by the side they came from: meshes of 1148 and 894 vertices."""
    vertices = []
    for mirror in (lambda x: x, lambda x: 0.1 - x):
        hole = {"circle": {"centre": (mirror(0.0473), 0.0519), "radius": 0.0139}}
        stiff = {"circle": {"centre": (mirror(0.0525), 0.0531), "radius": 0.0101}}
        scene = sheet(0.1, 0.09, 0.001, cutouts=[{"shape": hole}], patches=[{"shape": stiff, "young": 2e6}])
        x, y = mesh_of(scene, 4).p
        vertices.append(np.column_stack([mirror(x), y]))
    assert KDTree(vertices[0]).query(vertices[1])[0].max() < 1e-9


def test_away_from_borders_elements_are_squares():
    mesh = quadrilaterals(*PLANS["square"], (0.025, 0.025))
    assert mesh.nelements == 64
    assert np.allclose(np.unique(np.round(mesh.p[0, : mesh.nvertices], 12)), np.linspace(0.0, 0.2, 9))


@pytest.mark.parametrize("plan", ["annulus", "fin with a stiff root", "four holes"])
def test_a_point_is_found_where_its_element_has_it(plan):
    region, inner = PLANS[plan]
    mesh = quadrilaterals(region, inner, (0.0125, 0.0125), False)
    points = np.random.default_rng(0).uniform(0.0, 0.2, (2000, 2))
    points = points[shapely.contains_xy(region.buffer(-1e-4), *points.T)]
    element, place = locate(mesh, points)
    back = mesh.mapping().F(0.5 * (place + 1.0)[:, :, None], tind=element)[:, :, 0].T
    curved = mesh.doflocs[:, mesh.dofs.element_dofs].shape[1] > 4
    assert np.allclose(back, points, rtol=0.0, atol=0.0125 * (0.05 if curved else 1e-8))


def test_an_element_that_is_folded_beyond_its_sides_is_searched_too():
    """The finger's coarse mesh has an element whose map has no inverse at a point outside it."""
    coarse, fine = (mesh_of(load("gripper-finger"), count, graded=True) for count in (5, 10))
    points = plan_of(fine).nodes
    element, place = locate(coarse, points)
    back = coarse.mapping().F(0.5 * (place + 1.0)[:, :, None], tind=element)[:, :, 0].T
    assert np.abs(back - points).max() < 0.01 * coarse.param()
