"""Snaps of one unknown: how many there may be, what is said where nothing is found, follower loads."""

import numpy as np
import pytest
from one_unknown import Spring

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.path import LoadStepFailed
from sheetbench.numerics.continuation.trace import trace_path
from sheetbench.numerics.direct import DirectSolver

pytestmark = pytest.mark.smoke


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
    raise LoadStepFailed(Status.STEP_LIMIT, "it creeps no further", 0.0)


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
    assert path.notes == [f"{said}; relaxed at a load factor 0.01 higher, it creeps no further"]


def test_follower_loads_do_not_snap():
    path = trace_path(humps(0.2, symmetric=False), DirectSolver(symmetric=False), settle=nothing)
    assert path.status is Status.STEP_LIMIT
    assert not path.snaps and "relaxed" not in path.notes[-1]
