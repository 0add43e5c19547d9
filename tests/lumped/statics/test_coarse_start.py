"""Large lattices from smaller ones: the same answers as along the whole path."""

import numpy as np
import pytest
from cases import relative

import lumped
import sheetbench as sb
from lumped.statics import problem, solver
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import load
from sheetbench.scenes.meaning.parameters import put


@pytest.fixture
def counts_as_large(monkeypatch):
    """Lattices of a few hundred unknowns count as large."""
    monkeypatch.setattr(solver, "FROM", 500)
    monkeypatch.setattr(problem, "ITERATED", 500)
    monkeypatch.setattr("sheetbench.numerics.reduced_system.BANDED_LIMIT", 0.0)


def answers(scene, grid, monkeypatch, **options):
    """With a coarse start, and along the whole path."""
    springs = lumped.calibrate(scene.sheet, scene.material, grid=grid, **options)
    started = lumped.solve(scene, springs)
    monkeypatch.setattr(solver, "coarser_springs", lambda *_: None)
    return started, lumped.solve(scene, springs)


@pytest.mark.parametrize("name, options", [
    ("two-edges-clamped", {}), ("curved-edge", {}), ("curved-edge", {"grading": 0.5}),
])  # fmt: skip
def test_the_answer_is_that_of_the_whole_path(name, options, counts_as_large, monkeypatch):
    scene = load(name)
    started, whole = answers(scene, (13, 15), monkeypatch, **options)
    assert started.status == whole.status == Status.CONVERGED
    points = np.random.default_rng(0).uniform(0.0, scene.sheet.lengths, (40, 2))
    # both are polished to a residual of 1e-11: what is left of either is its multiple by the condition number
    assert relative(started.displacement(points), whole.displacement(points)) < 1e-7
    assert started.balance.holds and started.history[0].load_factor > 0.0
    largest = [line for line in started.history if line.load_factor == 1.0]
    assert largest[-1].residual < 1e-10


def test_two_factorisations_are_left_for_the_large_lattice(counts_as_large, monkeypatch):
    scene = load("two-edges-clamped")
    small = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=(8, 8)))
    large = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=(15, 15)))
    assert large.iterations == small.iterations + 2


@pytest.mark.parametrize("times", [10.0, 300.0])
def test_where_the_smaller_lattice_snaps_or_fails_the_whole_path_is_gone(times, counts_as_large, monkeypatch):
    scene = load("two-edges-clamped")
    scene = scene.replace(young=scene.material.young / times)
    started, whole = answers(scene, (12, 12), monkeypatch)
    assert (started.status, started.snaps) == (whole.status, whole.snaps)
    assert relative(*(found.displacement([scene.probes["P4"]]) for found in (started, whole))) < 1e-6


def moved(solution):
    return solution.mesh.point_data["displacement"]


@pytest.fixture(scope="module")
def case():
    """A scene, its springs, its answer from flat, and that of a scene with another rod."""
    scene = sb.load("curved-edge")
    springs = sb.calibrate(scene, grid=5)
    other = lumped.solve(put(scene, "curvature_x0", 3.7), springs)
    return scene, springs, lumped.solve(scene, springs), moved(other)


@pytest.mark.parametrize("lost", [False, True])
def test_the_answer_is_that_from_flat_in_fewer_factorisations_and_of_a_start_that_leads_nowhere(case, lost):
    scene, springs, flat, near = case
    start = 0.3 * np.random.default_rng(1).standard_normal(near.shape) if lost else near
    found = lumped.solve(scene, springs, near=start)
    assert found.status == flat.status == "converged"
    # both are corrected to rounding: residuals of 1e-11 of the forces
    np.testing.assert_allclose(moved(found), moved(flat), rtol=0, atol=1e-10 * np.abs(moved(flat)).max())
    assert lost or found.iterations < flat.iterations


def test_a_start_of_another_grid_is_refused(case):
    scene, springs, _, near = case
    with pytest.raises(BadInput, match="near"):
        lumped.solve(scene, springs, near=near[1:])
