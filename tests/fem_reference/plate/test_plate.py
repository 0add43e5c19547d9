"""The linear plate: patch tests, zero modes, convergence, published and closed-form answers, no locking."""

import re

import numpy as np
import pytest
from cases import WEIGHT, distorted, sheet
from skfem import MeshQuad

import fem_reference
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.surface.location import locate
from fem_reference.surface.materials import section_of
from sheetbench import scenes
from sheetbench.scenes import EDGES, BadInput, Material, Scene


def plate(scene, elements, **options):
    return fem_reference.solve(scene, "plate", elements=elements, **options)


MATERIAL = Material(young=1.0e7, poisson=0.3, density=1000.0)


def square(thickness, **more):
    return sheet(1.0, 1.0, thickness, material=MATERIAL, **more)


def plate_on(mesh, scene):
    """The discrete plate of a scene's free sheet."""
    return DiscretePlate(mesh, scene.model_copy(update={"supports": ()}))


def test_constant_shear_strain():
    """Constant shear (in equilibrium only under couples) is read exactly in distorted elements."""
    model = plate_on(distorted(square(1.0).sheet), square(0.01))
    x, y = model.plan.nodes.T
    moved, turned = (np.column_stack([0 * x, 0 * x, w]) for w in (2.0 * x - y, 0 * x))
    turned[:, :2] = 0.5, 0.3
    strain = model.shape(model.of_vectors(moved, turned), 1.0).strain
    np.testing.assert_allclose(strain[:, 6:] - [2.5, -0.7], 0.0, atol=1e-12)


@pytest.mark.parametrize(
    "mesh", [MeshQuad.init_tensor([0, 1.0], [0, 1.0]), distorted(square(1.0).sheet)], ids=["one", "nine"]
)
@pytest.mark.parametrize("thickness", [0.2, 1e-3])
def test_zero_modes_of_the_free_plate(mesh, thickness):
    """Three rigid motions of (w, tilt), three in the plane, and no others."""
    model = plate_on(mesh, square(thickness))
    rest = np.zeros(model.size)
    stiffness = model.tangent(model.shape(rest, 0.0), rest, 0.0, 0.0).toarray()
    section = section_of(MATERIAL, thickness)
    for part, fields in (("bending", slice(2, 5)), ("membrane", slice(0, 2))):
        on = np.column_stack([model.moves, model.turns])[:, fields].ravel()
        values = np.linalg.eigvalsh(stiffness[np.ix_(on, on)]) / getattr(section, part)[0, 0]
        assert np.sum(np.abs(values) < 1e-6) == 3
        assert values[3] > 1e-3


def test_strip_with_edge_moment_and_forces():
    length, width, thickness, young = 2.0, 0.5, 0.05, 1.0e6
    moment, (fx, fy, fz) = 0.02, (3.0, 0.0, 0.01)
    load = {"kind": "edge", "edge": "x1", "force_per_length": (fx, fy, fz), "moment_per_length": moment}
    scene = sheet(length, width, thickness, young, 0.0, loads=[load])
    answer = plate(scene, 2)
    bending, shear = young * thickness**3 / 12, 5 / 6 * young / 2 * thickness
    tip = moment * length**2 / (2 * bending) + fz * (length**3 / (3 * bending) + length / shear)
    exact = [fx * length / (young * thickness), 0.0, tip]
    np.testing.assert_allclose(answer.displacement([[length, 0.2]])[0], exact, rtol=1e-4, atol=1e-12)
    np.testing.assert_allclose(answer.reactions["x0"], -width * np.array([fx, fy, fz]), rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize("name", ["two-edges-clamped", "one-edge-clamped"])
def test_the_energy_is_half_the_work_of_the_weight(name):
    answer = plate(scenes.load(name), 8)
    x = np.polynomial.legendre.leggauss(24)
    points, shares = 0.094 * (x[0] + 1.0), x[1] / 2.0
    grid = np.array([(a, b) for a in points for b in points])
    work = -WEIGHT * np.outer(shares, shares).ravel() @ answer.displacement(grid)[:, 2]
    assert sum(answer.energies.values()) == pytest.approx(work / 2, rel=1e-4)


def test_in_plane_loads_and_a_corner_shared_by_two_supports():
    """Uniaxial stretch between rollers, ν = 0.3: exact; a corner obeys both of its supports."""
    rollers = (scenes.Held(edge="x0", components=("x", "z")), scenes.Held(edge="y0", components=("y", "z")))
    pull = [{"kind": "edge", "edge": "x1", "force_per_length": (50.0, 0.0, 0.0)}]
    answer = plate(square(0.01, loads=pull, supports=rollers), 2)
    strain = 50.0 / (MATERIAL.young * 0.01)
    np.testing.assert_allclose(
        answer.displacement([[1.0, 1.0], [0.3, 0.7]]),
        [[strain, -0.3 * strain, 0.0], [0.3 * strain, -0.21 * strain, 0.0]],
        atol=1e-9 * strain,
    )
    np.testing.assert_allclose(answer.reactions["x0"], [-50.0, 0.0, 0.0], atol=1e-6)


def test_curved_edge_follows_the_linearised_rod():
    scene = scenes.load("curved-edge")
    answer = plate(scene, 8)
    y = np.linspace(0, 0.188, 17)
    edge = answer.displacement(np.column_stack([np.zeros(17), y]))
    expected = np.column_stack([np.zeros((17, 2)), 4.0 * (y - 0.094) ** 2 / 2])
    np.testing.assert_allclose(edge, expected, atol=1e-12)


def sheet_on(kinds):
    """Habibi et al.'s sheet under a thousandth of its weight, each edge held as its kind says."""
    scene = scenes.load("two-edges-clamped")
    light = scenes.Gravity(acceleration=(0.0, 0.0, -9.81e-3))
    supports = [{"edge": edge, "kind": kind} for edge, kind in kinds.items()]
    return Scene.model_validate({**scene.model_dump(), "supports": supports, "gravity": light})


@pytest.mark.sweep
@pytest.mark.parametrize("kinds", [{"x0": "clamped", "y0": "clamped"}, dict.fromkeys(EDGES, "hinged")])
def test_graded_where_edges_let_twist_go(kinds):
    """On 16 × 16 within 0.05 % of 40 × 40 graded ones; on equal elements 0.3 to 0.5 % off."""
    scene = sheet_on(kinds)
    points = scene.probe_points()
    truth = plate(scene, 28, graded=True).displacement(points)
    largest = np.abs(truth).max()
    graded, equal = plate(scene, 16), plate(scene, 16, graded=False)
    assert graded.settings["graded"] and not equal.settings["graded"]
    assert np.abs(graded.displacement(points) - truth).max() < 5e-4 * largest
    assert np.abs(equal.displacement(points) - truth).max() > 2e-3 * largest


def test_the_seed_s_linear_sheet_has_its_converged_corner():
    scene = scenes.load("two-edges-clamped")
    corner = plate(scene, 16).displacement([scene.probes["P4"]])[0, 2]
    assert corner == pytest.approx(-19.835e-3, rel=5e-4)


def test_what_is_written_for_pictures_is_what_probes_tell():
    """At the nodes; directors are e_z and their linear change."""
    found = plate(sheet_on({"x0": "clamped"}), 2)
    plan, moved = found.mesh.points[:, :2], found.mesh.point_data["displacement"]
    np.testing.assert_allclose(moved, found.displacement(plan), atol=1e-12 * np.abs(moved).max())
    directors = found.mesh.point_data["director"]
    np.testing.assert_array_equal(directors[plan[:, 0] == 0.0], [[0.0, 0.0, 1.0]] * 5)
    np.testing.assert_array_equal(directors[:, 2], 1.0)


def test_divided_evenly_where_all_edges_hold_the_director():
    assert not plate(sheet_on(dict.fromkeys(EDGES, "clamped")), 2).settings["graded"]
    hinged = sheet_on(dict.fromkeys(EDGES, "hinged"))
    hard = hinged.replace(supports=[one.replace(twist="held") for one in hinged.supports])
    assert plate(hinged, 2).settings["graded"] and not plate(hard, 2).settings["graded"]


def test_of_many_points_the_first_one_off_the_sheet_is_named():
    mesh, points = MeshQuad.init_tensor(*2 * [np.linspace(0.0, 1.0, 4)]), np.array([[0.1, 0.1], [0.9, 0.9]])
    with pytest.raises(BadInput, match=re.escape("plan point (0.9, 1.25) is off the sheet")):
        locate(mesh, np.vstack([points, [[0.9, 1.25], [2.0, 0.5]]]))
