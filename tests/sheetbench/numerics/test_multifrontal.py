"""Factors by fronts: they solve, whatever the cells, tell the inertia, and say where there are none."""

from functools import partial

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from sheetbench.numerics import multifrontal
from sheetbench.numerics.direct import CHOLESKY, DirectSolver
from sheetbench.numerics.fronts import CoupledCells, fronts_of
from sheetbench.numerics.sparsity import Pattern


def system(nx, ny, unknowns, seed=0):
    """A positive definite matrix of cells in a grid whose corners have so many unknowns, some held."""
    rng = np.random.default_rng(seed)
    x, y = (a.ravel() for a in np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"))
    corners = np.stack([(x + i) * (ny + 1) + y + j for i in (0, 1) for j in (0, 1)], axis=1)
    free = rng.uniform(size=((nx + 1) * (ny + 1), unknowns)) > 0.1
    number = np.where(free.ravel(), np.cumsum(free) - 1, -1).reshape(free.shape)
    of_cells = number[corners].reshape(len(corners), -1)
    root = rng.normal(size=(len(corners), of_cells.shape[1], of_cells.shape[1]))
    pattern = Pattern(of_cells, size=int(free.sum()))
    matrix = pattern.matrix(root @ root.swapaxes(1, 2), diagonal=np.full(int(free.sum()), 0.1))
    return matrix, CoupledCells(pattern.cells, np.stack([x, y], axis=1) * rng.uniform(1.0, 3.0, 2))


@pytest.mark.parametrize("shape", [(1, 1, 3), (2, 1, 1), (5, 4, 2), (1, 13, 5), (12, 12, 5), (7, 7, 31)])
def test_factors_by_fronts_solve(shape):
    matrix, cells = system(*shape)
    b = np.random.default_rng(1).normal(size=matrix.shape[0])
    found = multifrontal.SignedFactors(matrix.data, fronts_of(matrix.indices, matrix.indptr, cells)).solve(b)
    np.testing.assert_allclose(found, np.linalg.solve(matrix.toarray(), b), rtol=1e-8, atol=1e-9)


def test_parts_are_cut_where_they_share_few_unknowns_and_not_cell_by_cell():
    """Two squares of cells and a neck between them, an unknown a corner; most of one square is held."""
    x, y = (a.ravel() for a in np.meshgrid(np.arange(27), np.arange(8), indexing="ij"))
    there = (x < 8) | (x > 10) | (y == 4)
    corners = np.stack([9 * (x + i) + y + j for i in (0, 1) for j in (0, 1)], axis=1)[there]
    number = np.unique(np.where(corners < 9 * 20, corners, -1), return_inverse=True)[1].reshape(-1, 4) - 1
    fronts = Pattern(number, size=number.max() + 1, places=np.column_stack([x, y])[there]).fronts
    assert 2 in fronts.own  # the neck's; halves of equally many cells have a column of nine between them
    assert len(fronts.own) < len(number) / 8


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_a_pivot_that_is_not_finite_is_told(value):
    matrix, cells = system(5, 4, 2)
    data = matrix.data.copy()
    data[matrix.indptr[17] + np.flatnonzero(matrix.indices[matrix.indptr[17] : matrix.indptr[18]] == 17)] = (
        value
    )
    with pytest.raises(multifrontal.NoFactorsError):
        multifrontal.SignedFactors(data, fronts_of(matrix.indices, matrix.indptr, cells))


def test_a_singular_matrix_has_no_factors():
    spring = np.array([[1.0, -1.0], [-1.0, 1.0]]) / 3.0
    cells = CoupledCells(np.array([[0, 1], [1, 2], [2, 3]]), np.array([[0.0, 0], [1, 0], [2, 0]]))
    matrix = Pattern(cells.unknowns, size=4).matrix(np.array([spring, 7.0 * spring, spring]))
    with pytest.raises(multifrontal.NoFactorsError):
        multifrontal.SignedFactors(matrix.data, fronts_of(matrix.indices, matrix.indptr, cells))


@pytest.mark.parametrize("shape", [(5, 4, 2), (12, 12, 5), (7, 7, 31)])
def test_factors_with_signs_are_those_of_the_eigenvalues_or_refused(shape):
    """Shifted to the middle of its spectrum a matrix is as indefinite as can be."""
    matrix, cells = system(*shape)
    fronts = fronts_of(matrix.indices, matrix.indptr, cells)
    values = np.linalg.eigvalsh(matrix.toarray())
    b, taken = np.ones(len(values)), 0
    diagonal = matrix.indices == np.repeat(np.arange(len(values)), np.diff(matrix.indptr))
    for below in (1, 2, len(values) // 4, len(values) // 2):
        data = matrix.data - 0.5 * (values[below - 1] + values[below]) * diagonal
        try:
            factors = multifrontal.SignedFactors(data, fronts)
        except multifrontal.NoFactorsError:
            continue
        taken += 1
        assert factors.negative == below
        shifted = csr_matrix((data, matrix.indices, matrix.indptr))
        left = shifted @ factors.solve(b) - b
        scale = np.abs(data).max() * np.abs(factors.solve(b)).max()
        assert np.abs(left).max() < 1e-9 * scale  # rounding times the growth that is allowed, and its square
    assert taken


def test_factors_that_grow_are_refused():
    """A first pivot of 1e-8 without a row exchange: the rest would be lost in its own rounding."""
    cells = CoupledCells(np.array([[0, 1]]), np.array([[0.0, 0.0]]))
    pattern = Pattern(cells.unknowns, size=2)
    for small in (1e-8, -1e-8):
        matrix = pattern.matrix(np.array([[[small, 1.0], [1.0, -1.0]]]))
        with pytest.raises(multifrontal.NoFactorsError):
            multifrontal.SignedFactors(matrix.data, fronts_of(matrix.indices, matrix.indptr, cells))
        assert DirectSolver(fronts=partial(fronts_of, matrix.indices, matrix.indptr, cells)).factor(
            matrix
        ).inertia == (1, 1, 0)


def test_a_pattern_without_its_whole_diagonal_is_refused():
    matrix = csr_matrix(np.array([[0.0, 1.0], [1.0, 2.0]]))
    with pytest.raises(ValueError, match="diagonal"):
        fronts_of(matrix.indices, matrix.indptr, CoupledCells(np.array([[0, 1]]), np.zeros((1, 2))))


def test_factors_of_a_definite_matrix_need_no_refinement():
    """As Cholesky's: the residual of an unrefined solution is rounding, though the condition is 1e9."""
    matrix, cells = system(12, 12, 5)
    scale = np.logspace(0.0, 4.0, matrix.shape[0])
    data = matrix.data * scale[matrix.indices] * np.repeat(scale, np.diff(matrix.indptr))
    matrix = csr_matrix((data, matrix.indices, matrix.indptr))
    factor = DirectSolver(fronts=partial(fronts_of, matrix.indices, matrix.indptr, cells)).factor(matrix)
    b = np.random.default_rng(1).normal(size=matrix.shape[0])
    x = factor.solve(b, CHOLESKY)
    np.testing.assert_array_equal(x, factor.solve_unrefined(b))
    assert np.abs(b - matrix @ x).max() < CHOLESKY * (matrix.data.max() * np.abs(x).max() + np.abs(b).max())
    assert np.linalg.norm(b - matrix @ factor.solve(b)) <= np.linalg.norm(b - matrix @ x)
