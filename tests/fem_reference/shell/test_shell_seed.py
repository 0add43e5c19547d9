"""Shell (and solid) on Habibi et al.'s sheet: converged values, convergence, symmetry, balance, statuses,
sampling."""

from functools import partial

import numpy as np
import pytest
from cases import CONVERGED

import fem_reference
from fem_reference import statics
from fem_reference.discrete.answer import trace_sheet
from fem_reference.shell import coarse_start
from fem_reference.surface.mesh import rectangle
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.scenes import Gravity, Pressure, Sheet


def solve(scene, elements=16, **options):
    return fem_reference.solve(scene, model="shell", elements=elements, **options)


def probes(scene, elements=16, **options):
    return solve(scene, elements, **options).displacement(scene.probe_points())


@pytest.fixture(scope="module")
def converged():
    """Probes of the one-edge scene on a fine graded mesh: 0.001 % from the limit."""
    return probes(scenes.load("one-edge-clamped"), 40)


@pytest.mark.parametrize(
    ("name", "model", "elements"),
    [
        *((name, "shell", 16) for name in CONVERGED),
        ("two-edges-clamped", "solid", 8),
        pytest.param("one-edge-clamped", "solid", 8, marks=pytest.mark.nightly),
    ],
)
def test_seed_scenes(name, model, elements):
    scene = scenes.load(name)
    solution = fem_reference.solve(scene, model, elements=elements)
    assert solution.status is Status.CONVERGED and solution.load_factor == 1.0 and solution.iterations < 12
    at = dict(zip(scene.probes, solution.displacement(scene.probe_points()) * 1e3, strict=True))
    for (probe, axis), value in CONVERGED[name].items():
        assert at[probe][axis] == pytest.approx(value, rel=3e-3), (probe, axis)


@pytest.mark.parametrize(
    "graded, caps, slope",
    [(False, {4: 7e-3, 8: 1.5e-3, 16: 5e-4}, 1.8), (True, {4: 2e-3, 8: 4e-4, 16: 5e-5}, 3.2)],
    ids=["uniform", "graded"],
)
def test_convergence_on_the_one_edge_scene(converged, graded, caps, slope):
    """The corners of the clamp limit the order on uniform meshes; grading restores most of it."""
    scene = scenes.load("one-edge-clamped")
    errors = [
        np.abs(probes(scene, n, graded=graded) - converged).max() / np.abs(converged).max() for n in caps
    ]
    assert all(error < cap for error, cap in zip(errors, caps.values(), strict=True)), errors
    assert np.log2(errors[0] / errors[-1]) / 2 == pytest.approx(slope, abs=0.15)


@pytest.mark.parametrize("name", ["curved-edge", "curved-edge-down"])
def test_curved_edge_lies_on_its_arc_and_mirrors(name):
    scene = scenes.load(name)
    solution = solve(scene, 8)
    assert solution.status is Status.CONVERGED
    kappa = scene.supports[0].curvature
    on = np.isclose(solution.mesh.points[:, 0], 0.0)
    s = solution.mesh.points[on, 1] - 0.094
    arc = np.column_stack([0 * s, np.sin(kappa * s) / kappa - s, (1 - np.cos(kappa * s)) / kappa])
    np.testing.assert_allclose(solution.mesh.point_data["displacement"][on], arc, atol=1e-14)
    directors, normal = solution.mesh.point_data["director"], [0 * s, -np.sin(kappa * s), np.cos(kappa * s)]
    np.testing.assert_allclose(directors[on], np.column_stack(normal), atol=1e-12)
    np.testing.assert_allclose(np.linalg.norm(directors, axis=1), 1.0, atol=1e-12)
    points = np.random.default_rng(1).uniform(0, 0.188, (50, 2))
    mirrored = solution.displacement(points * [1, -1] + [0, 0.188])
    np.testing.assert_allclose(solution.displacement(points), mirrored * [1, -1, 1], atol=1e-10)


def test_sampling_is_exact_everywhere_on_the_sheet():
    solution = solve(scenes.load("one-edge-clamped"), 3)
    nodes, field = solution.mesh.points[:, :2], solution.mesh.point_data["displacement"]
    np.testing.assert_allclose(solution.displacement(nodes), field, atol=1e-15)
    assert solution.displacement([[0.188, 0.188], [0, 0]]).shape == (2, 3)
    for point in ([0.189, 0.1], [-1e-6, 0.1], [np.nan, 0.1]):
        with pytest.raises(ValueError, match="off the sheet"):
            solution.displacement([point])


def test_a_standing_sheet_that_is_too_soft_is_unstable():
    """Weight along a sheet that stands on its clamp: upright is an equilibrium, if a stable one."""
    standing = scenes.load("one-edge-clamped").replace(gravity=Gravity(acceleration=(-9.81, 0, 0)))
    for young, status in ((5e5, Status.UNSTABLE), (5e8, Status.CONVERGED)):
        assert solve(standing.replace(young=young), 4).status is status


def test_an_absurd_load_ends_with_a_status():
    scene = scenes.load("one-edge-clamped").replace(gravity=None, loads=(Pressure(value=1e12),))
    solution = solve(scene, 3)
    assert solution.status is not Status.CONVERGED and solution.load_factor < 1.0 and solution.message
    assert np.all(np.isfinite(solution.mesh.point_data["displacement"]))


def test_meshes_are_near_square_and_graded_ones_are_finer_at_the_edges():
    sheet = Sheet(length_x=0.4, length_y=0.1, thickness=0.001)
    for graded in (False, True):
        mesh = rectangle(sheet, 4, graded)
        assert mesh.nelements == 64
        counts = {name: len(facets) for name, facets in mesh.boundaries.items()}
        assert counts == {"x0": 4, "x1": 4, "y0": 16, "y1": 16}
    x = np.unique(mesh.p[0])
    assert x[1] < 0.5 * (x[9] - x[8]) and x[-1] - x[-2] == pytest.approx(x[1])


def test_a_path_whose_steps_were_halved_takes_longer_ones_again():
    """75 factorisations; 286 were easy steps followed by no longer ones."""
    heavy = Gravity(acceleration=(0.0, 0.0, -30.0 * 9.81))
    found = solve(scenes.load("one-edge-clamped").replace(gravity=heavy), 2)
    assert found.status is Status.CONVERGED and found.iterations < 150


def moved(scene, solution):
    return solution.displacement(scene.probe_points())


def from_flat(scene, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(coarse_start, "COARSE_START_FROM", 9)
        return fem_reference.solve(scene, elements=8)


@pytest.mark.parametrize("name", ["two-edges-clamped", "one-edge-clamped", "curved-edge"])
def test_the_answer_is_that_from_flat_in_fewer_factorisations(name, monkeypatch):
    scene = scenes.load(name)
    flat, coarse = from_flat(scene, monkeypatch), fem_reference.solve(scene, elements=2)
    found = fem_reference.solve(scene, elements=8)
    assert found.status is Status.CONVERGED and found.unknowns == flat.unknowns
    np.testing.assert_allclose(moved(scene, found), moved(scene, flat), atol=1e-9 * scene.sheet.length_x)
    assert found.iterations - coarse.iterations < flat.iterations
    assert len(found.history) > len(coarse.history)


def test_three_factorisations_lead_from_the_coarse_equilibrium_with_its_membrane_stresses(monkeypatch):
    scene = scenes.load("two-edges-clamped")
    coarse = fem_reference.solve(scene, elements=2)
    assert from_flat(scene, monkeypatch).iterations == 5  # the last correction's factors tell the stability
    assert fem_reference.solve(scene, elements=8).iterations == coarse.iterations + 3
    monkeypatch.setattr(coarse_start, "sampled", lambda nodes, strain: np.zeros((len(nodes), 21)))
    assert fem_reference.solve(scene, elements=8).iterations == coarse.iterations + 4


def test_a_sheet_with_a_hole_begins_at_a_coarse_mesh_without_rows_along_the_rim():
    hole = {"shape": {"circle": {"centre": (0.11, 0.1), "radius": 0.03}}}
    scene = scenes.load("two-edges-clamped").replace(cutouts=[hole])
    coarse = fem_reference.solve(scene, elements=2, graded=False)
    assert fem_reference.solve(scene, elements=8).iterations == coarse.iterations + 3


@pytest.mark.parametrize(
    "where, name, value",
    [
        (coarse_start, "is_direct", lambda path: False),  # it does not go straight
        (coarse_start, "LIMITS", Limits(factorisations=2)),  # it takes long
        (
            statics,
            "trace_sheet",
            partial(trace_sheet, limits=Limits(same_branch=1e-3)),
        ),  # far from it
    ],
)
def test_where_the_coarse_one_is_no_good_the_path_begins_at_rest(where, name, value, monkeypatch):
    scene = scenes.load("two-edges-clamped")
    flat = from_flat(scene, monkeypatch)
    monkeypatch.setattr(where, name, value)
    found = fem_reference.solve(scene, elements=8)
    assert found.iterations > flat.iterations
    assert np.array_equal(moved(scene, found), moved(scene, flat))


def test_rods_and_few_elements_have_no_coarse_start():
    assert coarse_start.coarse((8, 33), scenes.load("two-edges-clamped")) == (2, 8)
    assert coarse_start.coarse((7, 33), scenes.load("two-edges-clamped")) is None
    assert coarse_start.coarse((16, 16), scenes.load("actuated-edge")) is None
