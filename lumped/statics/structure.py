"""The lattice as a structure of the path tracer (`sheetbench.numerics.continuation`).

With u = T q + g(λ) a step is Tᵀ K T δq = Tᵀ (λ f − f_int − K δg), δg what supports and actuators have yet to
move, K at the load that the state is at. One compiled call goes a step and finds the internal forces and the
stresses that it extrapolates, so a state has its residual with it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from lumped.actuators import Drive
from lumped.items import Placed
from lumped.statics.faults import inspect
from lumped.statics.problem import LatticeState, Problem, Residual
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Fault, Path
from sheetbench.numerics.continuation.structure import Structure
from sheetbench.numerics.direct import Count, Factor, iterated
from sheetbench.scenes import Scene, outside_model

STRETCH = "largest in-plane link strain"
ITERATED = 5000  # unknowns from which a factorisation costs as much as ten solutions
LIMITS = Limits(
    tolerance=1e-11,
    refine_below=1e-5,
    steps_with_last_factors=True,
    reach_growth=1.5,
    first_reach=0.4,
    lengthen_up_to=7,
    careful_after=30,
    factorisations=2000,
    in_all=2000,
)


class LatticeForces(NamedTuple):
    """The residual at a state, and what is to be moved (n, 3) [m], None for nothing."""

    residual: Residual
    moved: np.ndarray | None

    @property
    def size(self) -> float:
        return self.residual.scale


class LatticeStructure(Structure[LatticeState, LatticeForces]):
    """A scene's lattice, ready for `trace_path`; its own solver too: factors of blocks (b, 3, 3)."""

    def __init__(self, scene: Scene, problem: Problem):
        self.scene, self.problem, self.limits = scene, problem, LIMITS
        self.prestrained, self.size = problem.assembly.natural is not None, problem.size
        self.contacts = problem.contacts
        self._moves = bool(problem.prescribed(1.0).any())
        self._iterates = problem.descends and problem.system.unknowns > ITERATED

    @property
    def symmetric(self) -> bool:
        return self.problem.conservative

    @property
    def multipliers(self) -> int:
        return self.problem.multipliers

    def rest(self) -> LatticeState:
        return LatticeState(np.zeros(self.problem.loads.dead.shape), 0.0)

    def start(self, u: np.ndarray) -> Start[LatticeState]:
        """Return the start at full load beside a displacement (n, 3) [m]."""
        u = self.problem.project_to_supports(u, 1.0)
        state = self.problem.advance(u, np.zeros(self.problem.system.unknowns), 1.0)
        return Start(state, 1.0, self.length(self.rest(), state), 0.0)

    def forces(self, state: LatticeState, load_factor: float) -> LatticeForces:
        known = state.residual if state.load_factor == load_factor else None
        moved = self._moved(state, load_factor)
        return LatticeForces(known or self.problem.residual(state.u, load_factor), moved)

    def _moved(self, state: LatticeState, load_factor: float) -> np.ndarray | None:
        if not self._moves or state.load_factor == load_factor:
            return None
        return self.problem.prescribed(load_factor) - self.problem.prescribed(state.load_factor)

    def imbalance(self, state: LatticeState, forces: LatticeForces) -> float:
        return forces.residual.norm

    def imbalance_floor(self, state: LatticeState, forces: LatticeForces) -> float:
        return self.problem.rounding(state.u)

    def gap(self, state: LatticeState, load_factor: float) -> float:
        moved = self._moved(state, load_factor)
        if moved is None:
            return 0.0
        layers = moved[self.problem.assembly.lattice.columns()]  # one that is turned moves the sheet's end
        turn = (
            float(np.abs(layers[..., -1, :] - layers[..., 0, :]).max())
            / self.problem.assembly.lattice.spacing[2]
        )
        return max(float(np.abs(moved).max() / self.problem.size), turn)

    def rows(self, state: LatticeState, forces: LatticeForces, load_factor: float) -> np.ndarray | None:
        return forces.residual.reduced if forces.moved is None else None

    def system(
        self, state: LatticeState, forces: LatticeForces, load_factor: float, mixed: bool = True
    ) -> tuple[np.ndarray, np.ndarray]:
        problem, rows = self.problem, forces.residual.reduced
        blocks = problem.tangent(state.u, state.load_factor, state.stresses if mixed else None)
        if forces.moved is not None:
            rows = rows - problem.reduce(problem.system.apply(blocks, forces.moved))
        return blocks, rows

    def advance(
        self, state: LatticeState, forces: LatticeForces, load_factor: float, step: np.ndarray
    ) -> LatticeState:
        return self.problem.advance(state.u, step, load_factor, forces.moved)

    def correct(
        self, state: LatticeState, forces: LatticeForces, load_factor: float, count: Count
    ) -> tuple[Factor, np.ndarray, np.ndarray, LatticeState] | None:
        if self._iterates or forces.moved is not None:
            return None
        return self.problem.correct(state, forces.residual.reduced, load_factor, count)

    def with_stresses(self, state: LatticeState, of: LatticeState) -> LatticeState:
        return state._replace(stresses=of.stresses)

    def sparse(self, matrix: np.ndarray) -> sp.csc_array:
        return self.problem.system.matrix(matrix)

    def length(self, start: LatticeState, end: LatticeState) -> float:
        known = end.start is start.u
        return (end.length if known else float(np.abs(end.u - start.u).max())) / self.problem.size

    def has_meaning(self, state: LatticeState) -> bool:
        links = self.problem.assembly.at(state.load_factor).links
        return not outside_model(self.scene, links.largest_strain(state.u), STRETCH)

    def inspect(self, path: Path[LatticeState, LatticeForces]) -> Fault | None:
        """Return why the path's last equilibrium means nothing, if it does."""
        return inspect(self.problem.assembly.at(path.state.load_factor), path.state.u[None])[1]

    def loading(self) -> float:
        problem = self.problem
        return float(np.abs(problem.external(np.zeros_like(problem.loads.dead), 1.0)).sum())

    def placed(self, state: LatticeState, load_factor: float) -> Placed:
        return state.u, Drive(load_factor)

    def restarted(self, state: LatticeState) -> tuple[LatticeState, float]:
        return state._replace(residual=None), 0.0

    def factor(self, blocks: np.ndarray, more: Count = lambda: None) -> Factor:
        return self.problem.system.factor(blocks, more)

    def iterated(self, blocks: np.ndarray, near: Factor, rows: np.ndarray) -> np.ndarray | None:
        return iterated(self.problem.system.matrix(blocks), near, rows) if self._iterates else None
