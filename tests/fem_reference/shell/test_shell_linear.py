"""The adaptive tracing of an awkward structure, of one unknown."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import LoadStepFailed
from sheetbench.numerics.continuation.structure import Structure
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.numerics.direct import DirectSolver
from sheetbench.numerics.stability import nearest_to_zero


@dataclass
class Balance:
    residual: float
    size: float = 1.0


@dataclass
class Spring(Structure[float, Balance]):
    force: Callable[[float], float]
    slope: Callable[[float], float]
    symmetric: bool = True

    def rest(self):
        return 0.0

    def forces(self, u, load_factor):
        return Balance(self.force(u) - load_factor)

    def imbalance(self, u, forces):
        return abs(forces.residual)

    def gap(self, u, load_factor):
        return 0.0

    def linearised(self, u, forces, load_factor, mixed=True):
        return csr_matrix(([self.slope(u)], ([0], [0]))), np.array([-forces.residual])

    def advance(self, u, forces, load_factor, step):
        return u + step[0]

    def length(self, start, end):
        return abs(end - start)


pytestmark = pytest.mark.smoke


def test_steps_shrink_where_one_step_does_not_converge():
    """f = atan 8(u − 0.4) + atan 3.2: soft, stiff, soft; Newton in one step flies off the far end."""
    whole = np.arctan(8 * 0.8) + np.arctan(3.2)

    def force(u):
        return (np.arctan(8 * (u - 0.4)) + np.arctan(3.2)) / whole

    path = trace_path(Spring(force, lambda u: 8 / (1 + 64 * (u - 0.4) ** 2) / whole), DirectSolver())
    assert path.status is Status.CONVERGED and path.load_factor == 1.0
    assert path.state == pytest.approx(1.2, rel=1e-6)
    assert any(entry.load_factor < 1.0 for entry in path.history)


def test_a_limit_point_ends_with_its_load_and_a_status():
    """f = u (1 − u) · 2: no equilibrium beyond λ = ½."""
    path = trace_path(Spring(lambda u: 2 * u * (1 - u), lambda u: 2 - 4 * u), DirectSolver())
    assert path.status in (Status.DIVERGED, Status.STEP_LIMIT, Status.SINGULAR)
    assert 0.45 < path.load_factor <= 0.5
    assert "load factor" in path.notes[-1]


def test_a_start_close_to_an_unstable_equilibrium_is_left_for_the_path_from_rest():
    """f = 4 u − 2 u² = 1 at u = 1 ∓ √½."""
    spring = Spring(lambda u: 4 * u - 2 * u**2, lambda u: 4 - 4 * u)
    for near in (0.29, 1.7, 1.0):
        path = trace_path(spring, DirectSolver(), near=Start(near, 1.0, near, 1.0))
        assert path.status is Status.CONVERGED and path.state == pytest.approx(1 - np.sqrt(0.5), rel=1e-8)


def test_overflow_ends_a_path_as_non_finite():
    path = trace_path(Spring(lambda u: np.inf if u else 0.0, lambda u: 1.0), DirectSolver())
    assert path.status is Status.NON_FINITE and path.load_factor == 0.0


@pytest.mark.parametrize("symmetric", [True, False], ids=["dead loads", "follower loads"])
@pytest.mark.parametrize("slope, status", [(-1.0, Status.UNSTABLE), (1.0, Status.CONVERGED)])
def test_the_end_is_checked_for_stability(slope, status, symmetric):
    spring = Spring(lambda u: slope * u, lambda u: slope, symmetric=symmetric)
    path = trace_path(spring, DirectSolver(symmetric=symmetric))
    assert path.status is status
    assert path.factorisations == 2 or not symmetric


def test_the_eigenvalues_nearest_to_zero_of_an_unsymmetric_matrix():
    noise = np.triu(np.random.default_rng(2).uniform(-1, 1, (60, 60)), 1)
    values = np.concatenate([[-0.5, 1.0, 2.0, 3.0, 4.0, 5.0], np.arange(50.0, 104.0)])
    matrix = csr_matrix(noise + np.diag(values))
    lowest = nearest_to_zero(matrix, DirectSolver(symmetric=False).factor(matrix).solve, 6)
    assert lowest is not None
    np.testing.assert_allclose(np.sort(lowest.real), values[:6], rtol=1e-8)


def humps(rise, symmetric=True):
    """From every whole u the force rises by a quarter, then falls back."""

    def force(u):
        part = u - np.floor(u)
        return rise * np.floor(u) + part - part**2

    return Spring(force, lambda u: 1.0 - 2.0 * (u - np.floor(u)), symmetric)


def foothold(path, load_factor, rise):
    """u on the rising half of the next hump."""
    hump = np.floor(path.state) + 1.0
    path.factorisations += 1
    return float(hump + 0.5 - np.sqrt(0.25 - (load_factor - rise * hump)))


def nothing(path, load_factor):
    raise LoadStepFailed(Status.STEP_LIMIT, "the relaxation makes no progress", 0.0)


def test_snaps_are_bounded():
    rise = 0.02
    path = trace_path(humps(rise), DirectSolver(), settle=lambda *where: foothold(*where, rise))
    assert len(path.snaps) == Limits.snaps
    assert path.status is Status.STEP_LIMIT and "no equilibrium found beyond" in path.notes[-1]
    found = path.snaps
    assert found[0] == pytest.approx(0.25, abs=2e-3) and np.all(np.diff(found) > 0.0)


def test_where_nothing_is_found_status_and_place_stay_and_a_clause_says_what_was_tried():
    stopped = trace_path(humps(0.2), DirectSolver())
    path = trace_path(humps(0.2), DirectSolver(), settle=nothing)
    assert stopped.status is Status.STEP_LIMIT
    assert (path.status, path.state, path.load_factor) == (stopped.status, stopped.state, stopped.load_factor)
    (said,) = stopped.notes
    assert path.notes == [f"{said}; relaxed at a load factor 0.01 higher, the relaxation makes no progress"]


def test_follower_loads_do_not_snap():
    path = trace_path(humps(0.2, symmetric=False), DirectSolver(symmetric=False), settle=nothing)
    assert path.status is Status.STEP_LIMIT
    assert not path.snaps and "relaxed" not in path.notes[-1]
