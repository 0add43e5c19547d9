"""Factors of every kind solve, tell the inertia, and say where there are none."""

import tracemalloc
from functools import partial

import numpy as np
import pytest
from scipy.sparse import bsr_array, csr_matrix

import lumped
from lumped.statics.energy_descent import _perturbed
from lumped.statics.solver import solve_path
from sheetbench import scenes
from sheetbench.numerics import banded, direct
from sheetbench.numerics.direct import CHOLESKY, DirectSolver, SingularMatrixError
from sheetbench.numerics.fronts import CoupledCells, fronts_of
from sheetbench.numerics.multifrontal import signed_factors
from sheetbench.numerics.reduced_system import reduction
from sheetbench.numerics.saddle_point import ROUNDED
from sheetbench.numerics.sparsity import Pattern
from sheetbench.scenes import load
from sheetbench.scenes.objects.supports import Hinged


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


def by_fronts(matrix, cells):
    found = signed_factors(matrix.data, fronts_of(matrix.indices, matrix.indptr, cells))
    if found is None:
        raise SingularMatrixError
    return found


def by_band(matrix, cells):
    """In blocks' entries, in an order of its own; of what is not definite there are none."""
    n, entries = matrix.shape[0], matrix.tocoo()
    order, width = banded.ordered(entries.row, entries.col, n)
    ones = np.ones(entries.nnz)
    band = banded.band_of(np.arange(entries.nnz), entries.row, entries.col, ones, order, width)
    factors = banded.stored(entries.data, band)
    if not banded.factor(factors, n, band.width):
        raise SingularMatrixError
    return partial(banded.solve_unrefined, factors, band.width, band.order), 0


def by_library(matrix, cells):
    """rslab; the second time on the analysis of the first."""
    solver = DirectSolver()
    solver.factor(2.0 * matrix)
    factors = solver.factor(matrix)
    return factors.solve, factors.negative


KINDS = {"fronts": by_fronts, "band": by_band, "rslab": by_library}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("shape", [(1, 1, 3), (2, 1, 1), (5, 4, 2), (1, 13, 5), (12, 12, 5), (7, 7, 31)])
def test_factors_solve_and_tell_the_inertia(kind, shape):
    """Shifted to the middle of its spectrum a matrix is as indefinite as can be: fronts may refuse it."""
    matrix, cells = system(*shape)
    values = np.linalg.eigvalsh(matrix.toarray())
    n, taken = len(values), []
    b = np.random.default_rng(1).normal(size=n)
    diagonal = matrix.indices == np.repeat(np.arange(n), np.diff(matrix.indptr))
    for below in sorted({0, 1, 2, n // 4, n // 2}) if n > 4 else [0]:
        shift = 0.5 * (values[below - 1] + values[below]) if below else 0.0
        shifted = csr_matrix((matrix.data - shift * diagonal, matrix.indices, matrix.indptr))
        try:
            solve, negative = KINDS[kind](shifted, cells)
        except SingularMatrixError:
            assert below and kind in ("fronts", "band")
            continue
        taken.append(below)
        assert negative == below
        x = solve(b)
        # rounding times the growth that is allowed, and its square
        assert np.abs(shifted @ x - b).max() < 1e-9 * (np.abs(shifted.data).max() * np.abs(x).max() + 1.0)
    assert len(taken) > (n > 20 and kind != "band")


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("entry", [1.0, np.nan, np.inf], ids=["singular", "not a number", "infinite"])
def test_singular_and_non_finite_matrices_are_refused(kind, entry):
    spring = np.array([[1.0, -1.0], [-1.0, 1.0]]) / 3.0
    cells = CoupledCells(np.array([[0, 1], [1, 2], [2, 3]]), np.array([[0.0, 0], [1, 0], [2, 0]]))
    matrix = Pattern(cells.unknowns, size=4).matrix(np.array([spring, 7.0 * spring, spring]))
    matrix.data *= np.where(np.arange(matrix.nnz) == 3, entry, 1.0)
    if kind == "band":  # which may take rounding for a pivot
        matrix.data[-1] -= 0.1
    with pytest.raises(SingularMatrixError):
        solve, _ = KINDS[kind](matrix, cells)
        solve(np.arange(4.0))


def test_parts_are_cut_where_they_share_few_unknowns_and_not_cell_by_cell():
    """Two squares of cells and a neck between them, an unknown a corner; most of one square is held."""
    x, y = (a.ravel() for a in np.meshgrid(np.arange(27), np.arange(8), indexing="ij"))
    there = (x < 8) | (x > 10) | (y == 4)
    corners = np.stack([9 * (x + i) + y + j for i in (0, 1) for j in (0, 1)], axis=1)[there]
    number = np.unique(np.where(corners < 9 * 20, corners, -1), return_inverse=True)[1].reshape(-1, 4) - 1
    fronts = Pattern(number, size=number.max() + 1, places=np.column_stack([x, y])[there]).fronts
    assert 2 in fronts.pivots  # the neck's; halves of equally many cells have a column of nine between them
    assert len(fronts.pivots) < len(number) / 8


def test_factors_that_grow_are_refused():
    """A first pivot of 1e-8 without a row exchange: the rest would be lost in its own rounding."""
    cells = CoupledCells(np.array([[0, 1]]), np.array([[0.0, 0.0]]))
    pattern = Pattern(cells.unknowns, size=2)
    for small in (1e-8, -1e-8):
        matrix = pattern.matrix(np.array([[[small, 1.0], [1.0, -1.0]]]))
        assert signed_factors(matrix.data, fronts_of(matrix.indices, matrix.indptr, cells)) is None
        fronts = partial(fronts_of, matrix.indices, matrix.indptr, cells)
        factor = DirectSolver(fronts=fronts).factor(matrix)
        assert (factor.negative, factor.zero) == (1, 0)


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
    for found, allowed in ((x, CHOLESKY), (factor.solve(b), ROUNDED)):
        size = matrix.data.max() * np.abs(found).max() + np.abs(b).max()
        assert np.abs(b - matrix @ found).max() < allowed * size


@pytest.mark.parametrize("name", ["two-edges-clamped", "curved-edge"])
@pytest.mark.parametrize("edge", ["", "hinged"])
def test_reduction_is_the_triple_product(name, edge):
    scene = scenes.load(name)
    if edge:  # the mean of the layers held: rows of the transform with entries of their own
        hinged = tuple(Hinged(edge=e) for e in ("x0", "y1"))
        scene = scene.model_copy(update={"supports": hinged})
    problem = lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(4, 5)))
    pattern, transform = problem.assembly.pattern, problem.constraints.transform
    blocks = np.random.default_rng(0).standard_normal((pattern.blocks, 3, 3))  # not symmetric
    whole = bsr_array((blocks, pattern.indices, pattern.indptr))
    expected = (transform.T @ whole @ transform).toarray()
    found = reduction(pattern, transform).matrix(blocks)
    assert found.has_sorted_indices
    assert found.toarray() == pytest.approx(expected, rel=1e-13, abs=1e-13)


@pytest.fixture(scope="module")
def fine():
    """A lattice whose tangent has no narrow band and is not kept."""
    scene = load("two-edges-clamped")
    return lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(41, 41)))


def test_factors_of_a_large_lattice_take_no_library(fine, monkeypatch):
    monkeypatch.setattr(direct, "rslab", None)
    monkeypatch.setattr(direct, "splu", None)
    blocks = fine.tangent(np.zeros_like(fine.loads.dead), 0.0)
    assert fine.system.band is None
    fine.system.factor(blocks)  # compiled, the fronts found
    tracemalloc.start()
    try:
        factors = fine.system.factor(blocks)
        held, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    matrix = factors.matrix
    # the factors and the matrix; in the making what fronts leave waits beside them, and the widest front
    assert held < 8 * fine.system._fronts.columns[-1] + 1.1 * matrix.data.nbytes
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
    monkeypatch.setattr("sheetbench.numerics.reduced_system.BANDED_LIMIT", 0.0)
    monkeypatch.setattr(direct, "rslab", None)
    monkeypatch.setattr(direct, "splu", None)
    problem = lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(10, 8)))
    path = solve_path(problem)
    assert path.status == "unstable" and path.factor.negative == 1
    beside = _perturbed(problem, path.state, path.factor, share=0.1)
    assert problem.potential(beside, 1.0) < problem.potential(path.state.u, 1.0)
