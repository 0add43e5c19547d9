"""Snaps of one unknown: how many there may be, what is said where nothing is found, follower loads."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.sparse import csr_matrix

from fem_reference.solving.equilibrium import SNAPS, trace
from fem_reference.solving.path import Path, StepFailed
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import Status

pytestmark = pytest.mark.smoke


@dataclass
class Balance:
    residual: float
    size: float = 1.0


@dataclass
class Humps:
    """One unknown u with force f(u) = λ: from every whole u it rises by a quarter, then falls back."""

    rise: float
    symmetric: bool = True

    def rest(self):
        return 0.0

    def forces(self, u, load_factor):
        part = u - np.floor(u)
        return Balance(self.rise * np.floor(u) + part - part**2 - load_factor)

    def imbalance(self, u, forces):
        return abs(forces.residual)

    def gap(self, u, load_factor):
        return 0.0

    def system(self, u, forces, load_factor, mixed=True):
        slope = 1.0 - 2.0 * (u - np.floor(u))
        return csr_matrix(([slope], ([0], [0]))), np.array([-forces.residual])

    def advance(self, u, forces, load_factor, step):
        return u + step[0]

    def length(self, start, end):
        return abs(end - start)


def foothold(path: Path, load_factor: float, rise: float) -> float:
    """u on the rising half of the next hump."""
    hump = np.floor(path.state) + 1.0
    path.factorisations += 1
    return float(hump + 0.5 - np.sqrt(0.25 - (load_factor - rise * hump)))


def nothing(path: Path, load_factor: float) -> float:
    raise StepFailed(Status.STEP_LIMIT, "it creeps no further", 0.0)


def test_snaps_are_bounded():
    rise = 0.02
    path = trace(Humps(rise), DirectSolver(), settle=lambda *where: foothold(*where, rise))
    assert len(path.snaps) == SNAPS
    assert path.status is Status.STEP_LIMIT and "no equilibrium found beyond" in path.notes[-1]
    found = path.snaps
    assert found[0] == pytest.approx(0.25, abs=2e-3) and np.all(np.diff(found) > 0.0)


def test_where_nothing_is_found_status_and_place_stay_and_a_clause_says_what_was_tried():
    stopped = trace(Humps(0.2), DirectSolver())
    path = trace(Humps(0.2), DirectSolver(), settle=nothing)
    assert stopped.status is Status.STEP_LIMIT
    assert (path.status, path.state, path.load_factor) == (stopped.status, stopped.state, stopped.load_factor)
    (said,) = stopped.notes
    assert path.notes == [f"{said}; relaxed at a load factor 0.01 higher, it creeps no further"]


def test_follower_loads_do_not_snap():
    path = trace(Humps(0.2, symmetric=False), DirectSolver(symmetric=False), settle=nothing)
    assert path.status is Status.STEP_LIMIT
    assert not path.snaps and "relaxed" not in path.notes[-1]
