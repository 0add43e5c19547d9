"""Relaxation of a structure: the stable equilibrium to which it creeps from the end of a load path.

Beyond a limit point the nearest equilibrium is far away. A sheet of Kelvin–Voigt material without inertia,
with stresses D (e + τ ė), creeps there: under dead loads, λ held, its potential Π = ½ ∫ e·D e − λ f·u falls
at the rate ∫ τ ė·D ė. A backward Euler step of length τ/σ from strains e_n is an equilibrium with stresses

    s = (1 + σ) D e − σ D e_n,      a minimum of Π + ½ σ ∫ (e − e_n)·D (e − e_n),

computed by the mixed Newton iterations of load steps (see `trace`), so that a large rotation costs no more.
Since drag is proportional to stiffness, long and short waves creep equally fast, and rigid motions freely. σ
grows until the tangent at the step's start is positive definite, and when the step does not converge or Π
would rise; after easy steps it shrinks, until Newton's method takes over, to the tolerance of every load
step. So no step raises Π, to rounding. The inertia of the tangent decides on the end; a saddle is left along
its direction of most negative curvature. Directors are unit vectors to the load steps' tolerance throughout.
Rods creep with the sheet. Sources: Kelley & Keyes (1998) on pseudo-transient continuation; Ascher, Huang &
van den Doel (2007) on gradient flow with large steps.
"""

from typing import Generic, cast

import numpy as np
from scipy.sparse import csr_matrix

from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.newton import Start, newton
from sheetbench.numerics.continuation.path import LoadStepFailed, Path
from sheetbench.numerics.continuation.structure import Creeping, Forces, State
from sheetbench.numerics.direct import Factor, SingularMatrixError

FACTORISATIONS = 400  # of one relaxation; a shell folds over a ball in 320 to 370
CORRECTIONS = 8  # of one step
STEP_TOLERANCE = 0.1  # residual at the end of a step, relative to the residual at its start
REST_TOLERANCE = 1e-6  # or relative to the forces in balance
LARGEST_RATIO = 0.7  # a step fails if corrections after the second shrink by less
LONGEST = 1.0  # correction, in sizes of the sheet
LESS_DRAG_UP_TO = 4  # factorisations of a step after which drag falls
FASTER, CAREFUL = 4.0, 1.5  # factors by which drag falls: usually, and within CAUTION steps of a failure
CAUTION = 3
FIRST_DRAG = 1.0  # σ
STIFFEST = 1e9  # σ beyond which nothing moves
NEWTON_BELOW = 1e-5  # residual, relative to the forces in balance, below which Newton's method takes over
FURTHER = 0.1  # factor by which the residual must fall after a failure of Newton's method
ROUNDING = 1e-12  # of the energies in balance
PUSH, SMALLEST_PUSH = 1e-2, 1e-6  # displacements from a saddle, in sizes of the sheet
# after 12 steps the mode of a held, heated plate still had larger stiff parts than buckling ones
INVERSE_STEPS = 40


def relax(path: Path[State, Forces], load_factor: float) -> State:
    """Return the stable equilibrium at a load factor > 0 to which the sheet creeps from a path's last one.

    The path's state does not change; its factorisations and history grow. Raises LoadStepFailed without one.
    """
    limit = path.limit
    path.limit = min(limit, path.factorisations + FACTORISATIONS)
    try:
        return _Creep(path, load_factor).end()
    except SingularMatrixError as error:
        raise LoadStepFailed(Status.SINGULAR, str(error), 0.0) from None
    finally:
        path.limit = limit


class _Creep(Generic[State, Forces]):
    """The creep's present state, potential, drag σ and length of the last step."""

    def __init__(self, path: Path[State, Forces], load_factor: float):
        self.structure = structure = cast(Creeping[State, Forces], path.structure)
        self.path, self.load_factor = path, load_factor
        self.state = structure.unextrapolated(path.state)
        forces = structure.forces(self.state, load_factor)
        self.size = forces.size or structure.imbalance(self.state, forces) or 1.0  # of a sheet without loads
        self.first = structure.potential(self.state, load_factor)[0]
        self.energy = np.inf  # nothing to compare with: supports may move in the first step
        self.drag, self.careful, self.length = FIRST_DRAG, 0, 0.0
        self.nearly = NEWTON_BELOW

    def end(self) -> State:
        """Return the stable equilibrium. Raises LoadStepFailed, SingularMatrixError."""
        while True:
            self._step()
            forces = self.structure.forces(self.state, self.load_factor)
            residual = self.structure.imbalance(self.state, forces) / self.size
            if residual > self.nearly:
                continue
            state = self._equilibrium()
            if state is None:
                self.nearly = FURTHER * residual
            else:
                factor = self._factor(self.structure, state)
                if factor.negative == factor.zero == 0:
                    return state
                self._leave_saddle(state)

    def _step(self) -> None:
        """Take one accepted step, with the drag increased until it is accepted. Raises LoadStepFailed."""
        while True:
            before = self.path.factorisations
            state = self._creep_step()
            if state is not None and self._accepts(state):
                break
            self.drag, self.careful = FASTER * self.drag, CAUTION
            if self.drag > STIFFEST:
                raise LoadStepFailed(Status.STEP_LIMIT, "the relaxation makes no progress", 0.0)
        self.length = self.structure.length(self.state, state)
        self.state = self.structure.unextrapolated(state)
        self.careful -= 1
        if self.path.factorisations - before <= LESS_DRAG_UP_TO:
            self.drag /= CAREFUL if self.careful > 0 else FASTER

    def _accepts(self, state: State) -> bool:
        """Return whether the potential has not risen; if so, compare with it from now on."""
        energy, balanced = self.structure.potential(state, self.load_factor)
        if not energy <= self.energy + ROUNDING * balanced:  # also catches nan
            return False
        self.energy = min(self.energy, energy)
        return True

    def _creep_step(self) -> State | None:
        """Return the end of a step of creep, None if its iterations fail."""
        structure = self.structure.creep_step(self.state, self.load_factor, self.drag)
        state, lengths, first = self.state, list[float](), np.inf
        for k in range(CORRECTIONS + 1):
            forces = structure.forces(state, self.load_factor)
            relative = structure.imbalance(state, forces) / self.size
            self.path.note(self.load_factor, relative, lengths[-1] if lengths else 0.0)
            if not np.isfinite(relative):
                return None
            first = relative if k == 0 else first
            settled = relative <= max(STEP_TOLERANCE * first, REST_TOLERANCE)
            if k > 0 and settled and structure.gap(state, self.load_factor) <= self.path.limits.tolerance:
                return state
            if k == CORRECTIONS or (len(lengths) > 2 and lengths[-1] > LARGEST_RATIO * lengths[-2]):
                return None
            matrix, rows = structure.linearised(state, forces, self.load_factor)
            factor = self._factor_matrix(matrix)
            if k == 0 and factor.negative:
                return None
            following = structure.advance(state, forces, self.load_factor, factor.solve(rows))
            lengths.append(structure.length(state, following))
            if not lengths[-1] <= LONGEST:
                return None
            state = following
        return None

    def _equilibrium(self) -> State | None:
        """Return the equilibrium by Newton's method from the last step, None if it fails. Its work is
        compared with the energy that the creep has released."""
        released = abs(self.first - self.energy)
        start = Start(self.state, self.load_factor, self.length, released)
        try:
            state, _ = newton(self.path, start)
        except LoadStepFailed:
            return None
        return self.structure.unextrapolated(state) if self._accepts(state) else None

    def _leave_saddle(self, saddle: State) -> None:
        """Leave a saddle towards lower potential along the lowest mode of K v = μ K_m v. K_m is the tangent
        of the material alone. Raises LoadStepFailed."""
        structure, drag = self.structure, FIRST_DRAG
        forces = structure.forces(saddle, self.load_factor)
        tangent, _ = structure.linearised(saddle, forces, self.load_factor, mixed=False)
        factor = self._factor(structure.creep_step(saddle, self.load_factor, drag), saddle)
        while factor.negative:
            drag *= FASTER
            factor = self._factor(structure.creep_step(saddle, self.load_factor, drag), saddle)
        mode = np.random.default_rng(0).uniform(-1.0, 1.0, structure.unknowns)
        for _ in range(INVERSE_STEPS):
            mode = factor.solve((factor.matrix @ mode - tangent @ mode) / drag)
            mode /= np.abs(mode).max()
        mode /= structure.length(saddle, structure.advance(saddle, forces, self.load_factor, mode))
        push = PUSH
        while push > SMALLEST_PUSH:
            states = [self._push(saddle, sign * push * mode) for sign in (1.0, -1.0)]
            energies = [structure.potential(state, self.load_factor)[0] for state in states]
            lower = int(np.argmin(energies))
            if energies[lower] < self.energy:
                self.state, self.energy = states[lower], energies[lower]
                self.drag, self.careful = drag, CAUTION
                return
            push /= FASTER
        raise LoadStepFailed(Status.UNSTABLE, "the relaxation ends at a saddle point", 0.0)

    def _push(self, state: State, step: np.ndarray) -> State:
        """Return a state moved by a step (unknowns,), with directors of unit length."""
        while True:
            forces = self.structure.forces(state, self.load_factor)
            moved = self.structure.advance(state, forces, self.load_factor, step)
            state = self.structure.unextrapolated(moved)
            if self.structure.gap(state, self.load_factor) <= self.path.limits.tolerance:
                return state
            step = np.zeros_like(step)

    def _factor(self, structure: Creeping[State, Forces], state: State) -> Factor:
        """Return the factors of the true tangent."""
        forces = structure.forces(state, self.load_factor)
        return self._factor_matrix(structure.linearised(state, forces, self.load_factor, mixed=False)[0])

    def _factor_matrix(self, matrix: csr_matrix) -> Factor:
        """Return the factors of a matrix. Raises LoadStepFailed after too many factorisations."""
        if self.path.factorisations >= self.path.limit:
            raise LoadStepFailed(Status.STEP_LIMIT, f"not at rest after {FACTORISATIONS} factorisations", 0.0)
        return self.path.factored(matrix)
