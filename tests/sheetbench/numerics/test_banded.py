"""The banded Cholesky factors against dense algebra."""

import numpy as np
import pytest
import scipy.sparse as sp

import lumped
from sheetbench.numerics import banded
from sheetbench.numerics.reduction import reduction
from sheetbench.scenes import load
from sheetbench.scenes.objects.supports import Hinged


def positive_definite(n, width, rng):
    """A dense matrix of this bandwidth, of moderate condition."""
    factor = np.tril(rng.standard_normal((n, n)), 0)
    factor[np.subtract.outer(np.arange(n), np.arange(n)) > width] = 0.0
    np.fill_diagonal(factor, 2.0 + width)
    return factor @ factor.T


def band_of(matrix):
    """Its entries as blocks' entries, in an order of its own."""
    rows, columns = np.nonzero(matrix)
    order, width = banded.ordered(rows, columns, len(matrix))
    band = banded.band_of(np.arange(len(rows)), rows, columns, np.ones(len(rows)), order, width)
    return band, matrix[rows, columns]


@pytest.mark.parametrize("n, width", [(1, 0), (5, 2), (6, 5), (37, 11), (120, 64)])
def test_banded_factors_solve_as_dense_ones_do(n, width):
    rng = np.random.default_rng(n)
    matrix, b = positive_definite(n, width, rng), rng.standard_normal(n)
    shuffled = rng.permutation(n)
    for a in (matrix, matrix[np.ix_(shuffled, shuffled)]):
        band, entries = band_of(a)
        stored = banded.stored(entries, band)
        assert np.array_equal(banded.sparse(stored, band).toarray(), a)
        factors = stored.copy()
        assert banded.factor(factors, n, band.width)
        x, miss = banded.solve(stored, factors, band.width, band.order, b)
        assert x == pytest.approx(np.linalg.solve(a, b), rel=1e-12, abs=1e-14)
        assert miss < 1e-14  # a backward error is of the order of rounding, whatever the condition
        x = banded.solve_unrefined(factors, band.width, band.order, b)
        assert np.abs(a @ x - b).max() < 1e-14 * (np.abs(a).max() * np.abs(x).max() + np.abs(b).max())


def test_a_shuffled_band_is_found_again():
    matrix = positive_definite(60, 4, np.random.default_rng(0))
    shuffled = np.random.default_rng(1).permutation(60)
    rows, columns = np.nonzero(matrix[np.ix_(shuffled, shuffled)])
    assert banded.ordered(rows, columns, 60)[1] == 4


@pytest.mark.parametrize("spoilt", [-1.0, np.nan, np.inf])
def test_what_is_not_positive_definite_has_no_factors(spoilt):
    matrix = positive_definite(20, 3, np.random.default_rng(0))
    matrix[13, 13] = spoilt
    band, entries = band_of(matrix)
    assert not banded.factor(banded.stored(entries, band), 20, band.width)


@pytest.mark.parametrize("name", ["two-edges-clamped", "curved-edge"])
@pytest.mark.parametrize("edge", ["", "hinged"])
def test_reduction_is_the_triple_product(name, edge):
    scene = load(name)
    if edge:  # the mean of the layers held: rows of the transform with entries of their own
        supports = tuple(Hinged(edge=e) for e in ("x0", "y1"))
        scene = scene.model_copy(update={"supports": supports})
    problem = lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(4, 5)))
    pattern, transform = problem.assembly.pattern, problem.constraints.transform
    blocks = np.random.default_rng(0).standard_normal((pattern.blocks, 3, 3))  # not symmetric
    whole = sp.bsr_array((blocks, pattern.indices, pattern.indptr))
    expected = (transform.T @ whole @ transform).toarray()
    found = reduction(pattern, transform).matrix(blocks)
    assert found.has_sorted_indices
    assert found.toarray() == pytest.approx(expected, rel=1e-13, abs=1e-13)
