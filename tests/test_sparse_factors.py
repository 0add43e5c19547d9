"""The factors of large lattices: what stands in memory beside them in the making, and what they solve."""

import tracemalloc
from types import SimpleNamespace

import numpy as np
import pytest

import lumped
from lumped.linear import pardiso, solver
from sheetbench.scenes import load

pytestmark = pytest.mark.skipif(
    solver.rslab is None or pardiso.library() is not None, reason="lattices are not factorised by rslab"
)


@pytest.fixture(scope="module")
def problem():
    """A lattice whose tangent has no narrow band and is not kept."""
    scene = load("two-edges-clamped")
    return lumped.pose(scene, lumped.calibrate(scene.sheet, scene.material, grid=(41, 41)))


def test_no_matrix_stands_beside_factors_in_the_making(problem, monkeypatch):
    # but one triangle's entries, which are what rslab needs; the matrix takes three times that
    blocks = problem.tangent(np.zeros_like(problem.loads.dead), 0.0)
    assert problem.system.band is None
    matrix = problem.system.matrix(blocks)
    triangle = 4 * (matrix.nnz + matrix.shape[0])
    analysis, held = solver._analysis(matrix, symmetric=True), []

    def factor(given):
        held.append(tracemalloc.get_traced_memory()[0])
        return analysis.factor(given)

    monkeypatch.setattr(problem.system, "_analysis", SimpleNamespace(factor=factor))
    tracemalloc.start()
    try:
        factors = problem.factor(blocks)
    finally:
        tracemalloc.stop()
    assert held[0] < 1.05 * triangle
    b = np.random.default_rng(3).standard_normal(matrix.shape[0])
    assert np.abs(matrix @ factors.solve(b) - b).max() < 1e-9
    assert factors.negative == 0
