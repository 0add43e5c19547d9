"""The factors of large lattices: by fronts, without any library, in little more memory than they take."""

import tracemalloc

import numpy as np
import pytest

import lumped
from lumped.statics.energy_descent import _disturbed
from lumped.statics.solver import solve_path
from sheetbench.numerics import direct, pardiso
from sheetbench.scenes import load

pytestmark = pytest.mark.skipif(pardiso.library() is not None, reason="PARDISO factorises large lattices")


@pytest.fixture(scope="module")
def problem():
    """A lattice whose tangent has no narrow band and is not kept."""
    scene = load("two-edges-clamped")
    return lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(41, 41)))


def test_factors_of_a_large_lattice_take_no_library(problem, monkeypatch):
    monkeypatch.setattr(direct, "rslab", None)
    monkeypatch.setattr(direct, "splu", None)
    blocks = problem.tangent(np.zeros_like(problem.loads.dead), 0.0)
    assert problem.system.band is None
    problem.system.factor(blocks)  # compiled, the fronts found
    tracemalloc.start()
    try:
        factors = problem.system.factor(blocks)
        held, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    matrix = factors.matrix
    # the factors and the matrix; in the making what fronts leave waits beside them, and the widest front
    assert held < 8 * problem.system._fronts.kept[-1] + 1.1 * matrix.data.nbytes
    assert peak < 2.5 * held
    b = np.random.default_rng(3).standard_normal(matrix.shape[0])
    assert np.abs(matrix @ factors.solve(b) - b).max() < 1e-9
    assert factors.negative == 0


def test_factors_of_an_unstable_lattice_tell_its_negative_eigenvalues_and_lead_off_it(monkeypatch):
    """A compressed strip stays straight, and beside it the energy falls along the one direction reported."""
    scene = load("two-edges-clamped").replace(
        gravity=None, supports=({"edge": "x0", "kind": "clamped"},),
        loads=({"kind": "edge", "edge": "x1", "force_per_length": (-30.0, 0.0, 0.0)},),
    )  # fmt: skip
    monkeypatch.setattr("sheetbench.numerics.reduced.BANDED_LIMIT", 0.0)
    monkeypatch.setattr(direct, "rslab", None)
    monkeypatch.setattr(direct, "splu", None)
    problem = lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(10, 8)))
    outcome = solve_path(scene, problem)
    assert outcome.status == "unstable" and outcome.path.factor.negative == 1
    state, factor = outcome.path.state, outcome.path.factor
    beside = _disturbed(outcome.path, problem, state, factor, share=0.1)
    assert problem.potential(beside, 1.0) < problem.potential(outcome.state.u, 1.0)
