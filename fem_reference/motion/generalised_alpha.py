"""Generalised-α of a reference (`sheetbench.numerics.time.rule`), its step controlled by the error.

Equilibrium at a step's end is M a₁ + g(q₁, v₁, t₁) ⊥ Z(q₁). A step ends where a prescribed velocity jumps;
its impulse is passed on to the free unknowns, and the next step begins with new accelerations.

Just after a jump dampers slow the shortest waves faster than any step resolves: the rule would answer with
oscillations of their strains that fall by ρ a step, and dampers would seem to dissipate many times the
energy. So the first steps after it are backward Euler's, q₁ = q₀ + h v₁ and v₁ = v₀ + h a₁, which never
oscillate. The first one is so short that it dissipates `TAKEN` of the kinetic energy; they go on until their
local error, ½ h² |a₁|, no longer lets them double. Rannacher 1984 (Numer. Math. 43, 309–327) begins Crank and
Nicolson's rule in this way.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.energies import SheetMotion, dissipation_and_work
from fem_reference.sheets import start
from sheetbench.numerics.direct import DirectSolver, Factor
from sheetbench.numerics.time.controller import Controller
from sheetbench.numerics.time.method import Advance, MotionMethod, StepFailed
from sheetbench.numerics.time.rule import BACKWARD_EULER, AlphaStep, generalised, shifted, step_of
from sheetbench.scenes.meaning.motion import kinks
from sheetbench.scenes.objects.relaxation import BranchStep

RADIUS = 0.8
ERROR = 1e-5  # of a step, relative to the largest displacement so far
SOLVED = 1e-3  # last correction, relative to the error allowed
ROUNDED = 1e-13  # correction, relative to the displacement
CORRECTIONS = 12
KEEP_FACTORS_BELOW = 0.1  # ratio of successive corrections up to which factors are kept
FRACTION = 1.0 / 64.0  # smallest part of a fixed step that fails
LEAST = 1e-8  # smallest displacement that counts, relative to the sheet's longer side
SMALLEST = 1e-9  # step, relative to the run
EULER = 2  # steps after a jump whose length does not double
TAKEN = 1e-3  # share of the kinetic energy that the first of them may dissipate


class Sampled(NamedTuple):
    """Motions at k moments (k,) [s], and the energies (k,) [J] dissipated and put in since a step began."""

    time: np.ndarray
    motions: list[SheetMotion]
    dissipated: np.ndarray
    work: np.ndarray


class ConstrainedAlpha(MotionMethod[SheetMotion]):
    """Generalised-α steps. step [s]: fixed, or None for one by the error; first: the first one tried.
    adapts, span, kinks: of `sheetbench.numerics.time.method`. Steps end at samples of a sheet with chains:
    their firm stiffnesses make much energy of the small strains that a cubic within a step leaves."""

    state, remembered = SheetMotion, ("_before", "_largest", "_local", "_euler")
    control: Controller

    def __init__(self, model: DiscreteElements, step: float | None, error: float, first: float):
        self._model, self.adapts, self._error = model, step is None, error
        self._usual = self._rule = generalised(RADIUS)
        self._first = first if step is None else step
        band = (0.95, 1.25) if self.adapts else (0.0, np.inf)  # a fixed one always counts
        self.control = Controller(3, 2.0, band, self._first)
        self.span, self.kinks = 1 if model.bodies else None, np.array(kinks(model.scene))
        self._before, self._taken = 0.0, 0.0  # the last step, and the one that factors are of
        self._factor: Factor | None = None
        self._solver = model.solver()
        self._largest = LEAST * max(model.scene.sheet.lengths)  # displacement [m]
        self._local = 1.0  # the last step's error over that allowed
        self._euler = 0  # steps to come by backward Euler

    def forget(self) -> None:
        """Drop the factors, so that a resumed run goes on exactly like an uninterrupted one."""
        self._factor = None

    def start(self) -> Advance[SheetMotion]:
        """Return the motion at t = 0, with the work of prescribed velocities that jump there."""
        q = start(self._model)
        return self.begin(0.0, q, np.zeros_like(q))

    def _largest_component(self, change: np.ndarray) -> float:
        """Return the largest component of the nodes' displacements in a change (N,) of the coordinates."""
        return float(np.abs(self._model.displacement(change)).max())

    def _branches(self, motion: SheetMotion, time: float) -> BranchStep | None:
        """Return the step of the branches from a motion to a time [s], if there are any."""
        branches = self._model.branches
        return branches.step(motion.memory, time - motion.time) if branches.times else None

    def go(self, motion: SheetMotion, at_most: float) -> Advance[SheetMotion]:
        """Return a step; it begins anew where a prescribed velocity jumps. Raises StepFailed."""
        model, work = self._model, 0.0
        for kink in self.kinks[np.abs(self.kinks - motion.time) < 1e-9 * self.kinks].tolist():
            if model.jumps(kink):
                branches = self._branches(motion, kink)
                restart = self.begin(kink, model.on_supports(motion.q, kink), motion.v, branches)
                motion, work = restart.state, restart.work
        after = self.advance(motion, at_most)
        self._step = motion, dissipation_and_work(model, motion, after, 1.0 - self._rule.af), work
        return Advance(after, float(self._step[1][0]), work + float(self._step[1][1]))

    def at(self, times: np.ndarray, last: Advance[SheetMotion]) -> Sampled:
        """Return the motions at times (k,) [s] within the last step, with energies since it began."""
        end = last.state
        if end.time == times[0]:
            return Sampled(times, [end], np.array([last.dissipated]), np.array([last.work]))
        start, spent, work = self._step
        motions = [between(start, end, time) for time in times.tolist()]
        motions = [replace(m, memory=self._memory_after(m.q, self._branches(start, m.time))) for m in motions]
        share = np.array([(m.time - start.time) / (end.time - start.time) for m in motions])
        return Sampled(times, motions, share * spent[0], work + share * spent[1])

    def _memory_after(self, q: np.ndarray, branches: BranchStep | None) -> np.ndarray:
        """Return the memory (1 + b, 2, m) at the end of a step of the branches: stresses, strains and the
        branches' parts. Without a step it is the memory at rest; without branches it is empty."""
        material_branches, shape = self._model.branches, self._model.shape(q, 1.0)
        if not material_branches.times:
            return np.zeros(0)
        x = np.stack([part.ravel() for part in (shape.elastic, shape.strain)])
        return material_branches.at_rest(x) if branches is None else branches.after(x)

    def begin(
        self, time: float, q: np.ndarray, v: np.ndarray, branches: BranchStep | None = None
    ) -> Advance[SheetMotion]:
        """Return the motion from a time on, with prescribed velocities, accelerations of its forces, and the
        work of jumps. branches: their step until then; at rest without one."""
        model = self._model
        basis = model.basis(q)
        rate = model.constrained_rate(q, v, time)
        factor = DirectSolver().factor((basis.T @ model.mass @ basis).tocsr())
        rate = rate - basis @ factor.solve(basis.T @ (model.mass @ (rate - v)))
        a = model.centripetal(q, rate)
        forces = model.forces(model.shape(q, time, rate, branches))
        a = a - basis @ factor.solve(basis.T @ (model.mass @ a + forces))
        self._before, self._factor = 0.0, None
        self._euler = EULER if np.any(rate != v) else 0
        before, after, lost = (float(u @ (model.mass @ u)) for u in (v, rate, a))  # twice kinetic energies
        if self.adapts:
            allowed = 2.0 * self._error * self._largest
            steps = [self._first, np.sqrt(allowed / max(self._largest_component(a), 1e-30))]
            if self._euler:  # its first step dissipates ½ h² `lost`
                steps.append(np.sqrt(TAKEN * max(before, after) / max(lost, 1e-30)))
            self.control.step = min(steps)
        memory = self._memory_after(q, branches)
        motion = SheetMotion(time, q, rate, a, a, model.mass @ a + forces, memory)
        return Advance(motion, 0.0, 0.5 * (after - before))

    def advance(self, motion: SheetMotion, at_most: float) -> SheetMotion:
        """Return the motion after one step of at most `at_most` [s]. Raises StepFailed."""
        control, largest = self.control, self._largest
        self._rule = rule = BACKWARD_EULER if self._euler else self._usual
        control.order = rule.order
        allowed, smallest = 1.0, SMALLEST * max(motion.time, at_most)
        if not self.adapts:
            allowed, smallest, control.step = np.inf, FRACTION * self._first, self._first

        def attempt(h: float) -> tuple[tuple[SheetMotion, float], float, float]:
            nonlocal largest
            old = shifted(motion.a, motion.algorithm, h, self._before)
            after = self._advanced(motion, h, step_of(rule, h, motion.q, motion.v, motion.a, old))
            largest = max(self._largest, self._largest_component(after.q))
            jump = self._largest_component(after.a if self._euler else after.algorithm - old)
            error = h * h * rule.error * jump / (self._error * largest)
            return (after, error), error, allowed

        (after, error), h = control.take(attempt, at_most, smallest, fewer=4)
        self._before, self._largest, self._local = h, largest, error
        short = control.ratio(error, 1.0) < 2.0 or h > 0.5 * at_most
        if self._euler and (short or not self.adapts):
            self._euler -= 1
            self._factor = self._factor if self._euler else None
        return after

    def _advanced(self, motion: SheetMotion, h: float, step: AlphaStep) -> SheetMotion:
        """Return the end of a step of h [s] by Newton's iteration, with factors kept while corrections shrink
        to `KEEP_FACTORS_BELOW`. Raises StepFailed, SingularMatrixError."""
        model, time = self._model, motion.time + h
        branches = self._branches(motion, time)

        def at(q: np.ndarray) -> SheetMotion:
            v, a = step.velocity(q), step.acceleration(q)
            exerted = model.mass @ a + model.forces(model.shape(q, time, v, branches))
            return SheetMotion(time, q, v, a, step.algorithm(a), exerted)

        end = at(model.on_supports(step.guess, time))
        largest = max(self._largest, self._largest_component(end.q))
        tolerance = max(SOLVED * self._error * min(self._local, 1.0), ROUNDED) * largest
        if self._taken != h:
            self._factor = None
        last = 0.0
        for _ in range(CORRECTIONS):
            basis = model.basis(end.q)
            if self._factor is None:
                shape = model.shape(end.q, time, end.v, branches)
                matrix = model.tangent(shape, end.exerted, step.by_a, step.by_v)
                self._factor, self._taken = self._solver.factor(matrix), h
            move = basis @ self._factor.solve_unrefined(-(basis.T @ end.exerted))
            length = self._largest_component(move)
            if not np.isfinite(length):
                raise StepFailed("a number overflowed")
            end = at(model.moved(end.q, move))
            ratio = length / last if last else 1.0
            if length * min(ratio, 1.0) <= tolerance:
                return replace(end, memory=self._memory_after(end.q, branches)) if branches else end
            if last and ratio > KEEP_FACTORS_BELOW:
                self._factor = None
            last = length
        raise StepFailed("the corrections do not shrink")


def between(start: SheetMotion, end: SheetMotion, time: float) -> SheetMotion:
    """Return the motion within a step: coordinates cubic in time, all else linear."""
    h = end.time - start.time
    s = min((time - start.time) / h, 1.0)
    if s == 1.0:
        return end
    cubic = (1.0 + 2.0 * s) * (1.0 - s) ** 2 * start.q + s * s * (3.0 - 2.0 * s) * end.q
    cubic = cubic + h * s * (1.0 - s) * ((1.0 - s) * start.v - s * end.v)
    names = ("v", "a", "algorithm", "exerted")
    return SheetMotion(time, cubic, *((1.0 - s) * getattr(start, n) + s * getattr(end, n) for n in names))
