"""Nothing counts as stable, definite or admissible that is not: inertia, descent, quasi-Newton, supports."""

import numpy as np
import pytest
import scipy.sparse as sp
from dynamic_cases import make_scene
from scipy.sparse.linalg import splu

import lumped
from lumped.statics import energy_descent
from sheetbench.numerics.continuation.path import LoadStepFailed, Path
from sheetbench.numerics.direct import DirectSolver, Factor, SymmetricPartFactor
from sheetbench.numerics.fronts import CoupledCells, fronts_of
from sheetbench.numerics.stability import nearest_to_zero, negative_real, odd_below_zero


@pytest.fixture
def indefinite():
    """An unsymmetric matrix with one eigenvalue of −1; without pivoting its symmetric part has no factors."""
    matrix = np.diag(np.arange(1.0, 61.0))
    matrix[:2, :2] = [[0.0, 1.0], [1.0, 0.0]]
    matrix[5, 9], matrix[9, 5] = 0.3, -0.3
    rows, columns = np.nonzero((matrix != 0.0) | np.eye(60, dtype=bool))  # the diagonal with its zeros
    return sp.csc_array(sp.coo_array((matrix[rows, columns], (rows, columns))))


@pytest.mark.parametrize("known", [True, False], ids=["by fronts", "without"])
def test_a_symmetric_part_that_has_no_factors_is_not_taken_for_stability(indefinite, known):
    """Neither where it has none, nor where nothing is known of it."""
    for matrix, expected in ((indefinite, 1), (sp.csc_array(indefinite + 2.0 * sp.eye_array(60)), 0)):
        matrix.sort_indices()
        fronts = fronts_of(
            matrix.indices, matrix.indptr, CoupledCells(np.arange(60)[None, :], np.zeros((1, 2)))
        )
        solver = DirectSolver(symmetric=False, fronts=(lambda of=fronts: of) if known else None)
        assert solver.factor(matrix).negative_real() == expected


@pytest.mark.parametrize("n", [1, 2, 3])
def test_the_eigenvalues_of_the_smallest_matrices_are_found(n):
    matrix = sp.csc_array(np.diag(np.arange(1.0, n + 1.0)) - 1.5 * np.eye(n))
    found = nearest_to_zero(matrix, splu(matrix).solve)
    assert found is not None and negative_real(found) == 1


def test_only_real_eigenvalues_below_zero_count_as_instability():
    assert negative_real(np.array([-1.0, 2.0, -3.0 + 2.0j, -3.0 - 2.0j])) == 1
    # two equal ones that rounding has made a pair
    assert negative_real(np.array([-1.0 + 1e-8j, -1.0 - 1e-8j, 5.0])) == 2


def test_a_lattice_whose_stability_is_not_known_says_so(monkeypatch):
    scene = make_scene(loads=[{"kind": "pressure", "value": 5.0}])
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 5))
    for kind in (Factor, SymmetricPartFactor):
        monkeypatch.setattr(kind, "negative_real", lambda self: None)
    assert any("stability not known" in note for note in lumped.solve(scene, springs).remarks)


def test_descent_refuses_a_direction_along_which_the_energy_rises(monkeypatch):
    scene = make_scene()
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 5))
    problem = lumped.build_problem(scene, springs)
    flat = np.zeros_like(problem.loads.dead)
    factor = problem.system.factor(problem.tangent(flat, 0.0))
    monkeypatch.setattr(factor, "solve", lambda b, enough, of=factor.solve: -of(b))
    monkeypatch.setattr(energy_descent, "_definite_factor", lambda *given: (factor, 1))
    with pytest.raises(LoadStepFailed, match="not positive definite"):
        energy_descent.descend(Path(problem, problem, problem.rest()), 1.0)


@pytest.mark.parametrize("layers", [2, 3, 4])
def test_an_admissible_displacement_is_its_own_nearest(layers):
    supports = [{"edge": "x0", "kind": "hinged"}, {"edge": "x1", "kind": "clamped", "tilt": 0.2}]
    scene = make_scene(supports=[*supports, {"edge": "y1", "kind": "held", "components": ["y"]}])
    problem = lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(4, 3, layers)))
    unknowns = np.random.default_rng(layers).standard_normal(problem.system.unknowns)
    admissible = problem.expand(unknowns) + problem.prescribed(1.0)
    np.testing.assert_allclose(problem.project_to_supports(admissible, 1.0), admissible, rtol=0, atol=1e-14)
    # of any other the miss is at right angles to all that is admissible
    other = np.random.default_rng(9).standard_normal(admissible.shape)
    miss = problem.reduce(other - problem.project_to_supports(other, 1.0))
    np.testing.assert_allclose(miss, 0.0, atol=1e-13)


def test_a_negative_eigenvalue_behind_the_nearest_ones_is_not_taken_for_stability():
    """Twenty soft eigenvalues before one of −1000; unsymmetric."""
    values = np.concatenate([1e-3 * np.arange(1.0, 21.0), np.arange(1.0, 40.0), [-1000.0]])
    matrix, made = sp.csc_array(np.diag(values) + np.diag(np.full(59, 1e-4), 1)), []
    factor = DirectSolver(symmetric=False).factor(matrix, lambda: made.append(1))
    assert factor.negative_real() is None and len(made) == 1
    assert DirectSolver(symmetric=False).factor(abs(matrix)).negative_real() == 0


def test_the_sign_of_the_determinant_is_that_of_its_permutations_and_pivots():
    random = np.random.default_rng(3)
    for n in (1, 2, 5, 40):
        matrix = random.standard_normal((n, n))
        assert odd_below_zero(sp.csr_array(matrix)) == (np.linalg.det(matrix) < 0.0)
    assert odd_below_zero(sp.csc_array((3, 3))) is None
