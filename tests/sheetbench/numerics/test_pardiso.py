"""The extra `mkl`: PARDISO's factors of a lattice's tangent are those of rslab, each in its own memory."""

import numpy as np
import pytest
import scipy.sparse as sp

import lumped
from lumped import supports
from sheetbench import scenes
from sheetbench.numerics import direct, pardiso, reduced

pytestmark = pytest.mark.skipif(pardiso.library() is None, reason="needs the extra sheetbench[mkl]")


def laplacian(n, shift):
    """Of n × n points, minus a shift: (n², n²), indices sorted; its eigenvalues are known."""
    line = sp.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(n, n))
    one = sp.eye_array(n)
    matrix = sp.csc_array(sp.kron(line, one) + sp.kron(one, line) - shift * sp.eye_array(n * n))
    matrix.sort_indices()
    return matrix


def negative(n, shift):
    of_a_line = 4.0 * np.sin(np.arange(1, n + 1) * np.pi / (2 * n + 2)) ** 2
    return int(np.sum(of_a_line[:, None] + of_a_line < shift))


def test_solutions_and_inertia_of_factors_that_live_side_by_side():
    n, b = 15, np.random.default_rng(1).standard_normal(225)
    shifts = (0.0, 0.7, 3.1)
    matrices = [laplacian(n, shift) for shift in shifts]
    analysis = pardiso.Analysis(matrices[0])
    found = [analysis.factor(matrix) for matrix in matrices]
    for matrix, factors, shift in zip(matrices, found, shifts, strict=True):
        below = negative(n, shift)
        assert factors.inertia == (n * n - below, below, 0)
        np.testing.assert_allclose(matrix @ factors.solve(b), b, atol=1e-10)


def test_a_lattice_comes_to_rest_where_it_does_without_it(monkeypatch):
    scene = scenes.load("two-edges-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 5))
    monkeypatch.setattr(reduced, "BANDED_LIMIT", 0.0)
    monkeypatch.setattr(direct, "LARGE", 0)
    _forget_systems()
    sizes: list[int] = []
    factor = pardiso.Analysis.factor

    def counted(self, matrix):
        sizes.append(matrix.shape[0])
        return factor(self, matrix)

    monkeypatch.setattr(pardiso.Analysis, "factor", counted)
    points = scene.probe_points()
    found = lumped.solve(scene, springs).displacement(points)
    assert sizes
    monkeypatch.setattr(pardiso, "library", lambda: None)
    _forget_systems()
    factored = len(sizes)
    np.testing.assert_allclose(found, lumped.solve(scene, springs).displacement(points), rtol=1e-9)
    assert len(sizes) == factored
    _forget_systems()


def _forget_systems():
    """Of small lattices, which are kept with what factorises them."""
    supports._kept.cache_clear()
    reduced._reduced.forget()
