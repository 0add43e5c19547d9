"""A lattice under its supports and loads: residual, tangent and factors on the free unknowns.

With u = T q + g(λ), equilibrium is Tᵀ (λ f(u) − f_int(u)) = 0. Displacements and forces are (n, 3) [m], [N].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.actuators import Coupling, Drive
from lumped.assembly import Assembly
from lumped.loads import Loads
from lumped.springs.all_families import Stresses
from lumped.statics.faults import Fault
from lumped.supports import Constraints
from sheetbench.numerics.direct import Factor, iterated
from sheetbench.numerics.maps import Rows, product, transposed_product
from sheetbench.numerics.reduced import ReducedSystem
from sheetbench.scenes import Iteration

Progress = Callable[[Iteration], None]
SOLVED = 1e-14  # backward error of a correction that is not refined: the next one is its refinement
ITERATED = 5000  # unknowns from which a factorisation costs as much as ten solutions


class Tangent(NamedTuple):
    """A tangent's blocks (b, 3, 3) [N/m] and the factors of it reduced."""

    blocks: np.ndarray
    factor: Factor


class Residual(NamedTuple):
    """What the equilibrium equation leaves: the unbalanced force (n, 3) [N], the part of it on the free
    unknowns (m,) and that one's norm [N]; scale: the norm [N] of the external forces plus the supports'."""

    force: np.ndarray
    reduced: np.ndarray
    norm: float
    scale: float

    @property
    def relative(self) -> float:
        """The norm over the scale of the forces."""
        return self.norm / self.scale if self.scale > 0.0 else self.norm


class Advance(NamedTuple):
    """A displacement (n, 3) [m], how far the step there went at most [m], what the equilibrium equation
    leaves, and the stresses that the linearisation before the step predicts, where asked for."""

    u: np.ndarray
    length: float
    residual: Residual
    stresses: Stresses | None


@dataclass
class Problem:
    """A lattice under its supports and loads, which grow with the load factor λ.

    size: the sheet's longer side [m]. base: loads that act in full at every λ; the supports are then in
    their places from the start and only `loads` grow. factorisations counts every tangent factorised. fault:
    what ended the path at a state that means nothing, if anything did.
    """

    assembly: Assembly
    constraints: Constraints
    loads: Loads
    size: float
    base: Loads | None = None
    factorisations: int = 0
    history: list[Iteration] = field(default_factory=list)
    progress: Progress | None = None
    fault: Fault | None = None

    def __post_init__(self) -> None:
        dead = self.loads.conservative and (self.base is None or self.base.conservative)
        self.conservative = self.assembly.conservative and dead
        coupling = self.assembly.coupling
        self.multipliers = coupling.multipliers if coupling is not None else 0
        self._free = self.constraints.transform_arrays
        pattern, transform = self.assembly.pattern, self.constraints.transform
        if coupling is None:
            self.system = self.constraints.reduced(pattern, self.conservative)
        else:
            multipliers = self._multiplier_unknowns(coupling)
            self.system = ReducedSystem(pattern, transform, self.conservative, multipliers)

    def _multiplier_unknowns(self, coupling: Coupling) -> np.ndarray:
        """Which unknowns are multipliers of the actuators' constraints, (m,) bool."""
        of_unknowns: np.ndarray = abs(self.constraints.transform).T @ coupling.algebraic.ravel()
        return of_unknowns > 0.0

    @property
    def iterates(self) -> bool:
        """Whether factors are dear enough to solve with those of a tangent close by."""
        return self.conservative and self.multipliers == 0 and self.system.unknowns > ITERATED

    @property
    def descends(self) -> bool:
        """Whether stable equilibria are minima of an energy of the free unknowns."""
        return self.conservative and self.multipliers == 0

    def reduce(self, force: np.ndarray) -> np.ndarray:
        """Tᵀ f, the force on the free unknowns."""
        reduced: np.ndarray = transposed_product(self._free, force.ravel(), self.system.unknowns)
        return reduced

    def expand(self, unknowns: np.ndarray) -> np.ndarray:
        """T q as a displacement."""
        full: np.ndarray = product(self._free, np.ascontiguousarray(unknowns))
        return full.reshape(-1, 3)

    def tangent(self, u: np.ndarray, load_factor: float, stresses: Stresses | None = None) -> np.ndarray:
        """Blocks of the tangent of the residual, loads included."""
        blocks = self.assembly.tangent(u, stresses, extrapolated=stresses is not None)
        return self._with_loads(blocks, u, load_factor)

    def nonnegative_tangent(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """Return blocks of the tangent less what could make that of the springs indefinite."""
        return self._with_loads(self.assembly.all_families.nonnegative_tangent(u), u, load_factor)

    def _with_loads(self, blocks: np.ndarray, u: np.ndarray, load_factor: float) -> np.ndarray:
        self.loads.add_tangent(u, load_factor, blocks)
        if self.base is not None:
            self.base.add_tangent(u, 1.0, blocks)
        if self.assembly.coupling is not None:
            slots = self.assembly.coupling_slots
            self.assembly.coupling.add_tangent(u, self.commands(load_factor), slots, blocks)
        return blocks

    def factor(self, blocks: np.ndarray) -> Factor:
        """Factors of the reduced tangent; every one made counts."""
        self._count()
        return self.system.factor(blocks, self._count)

    def _count(self) -> None:
        self.factorisations += 1

    def negative(self, factor: Factor) -> int | None:
        """Eigenvalues below zero of the factored tangent (real ones, when it is unsymmetric), on motions
        that the actuators' constraints allow: each multiplier brings one more. None where it is not known."""
        if self.conservative:
            return None if factor.negative is None else factor.negative - self.multipliers
        if self.multipliers:
            return None
        return factor.negative_real()

    def prescribed(self, load_factor: float) -> np.ndarray:
        """Displacement of the masses that supports and actuators put in place."""
        placed = self.constraints.prescribed(load_factor if self.base is None else 1.0)
        if self.assembly.coupling is not None:
            placed = placed + self.assembly.coupling.driven(self.commands(load_factor))
        return placed

    def project_to_supports(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """Return the displacement closest to u (n, 3) [m] that the supports allow."""
        prescribed = self.prescribed(load_factor)
        return self.expand(self.constraints.nearest(u - prescribed)) + prescribed

    def internal(self, u: np.ndarray, load_factor: float) -> tuple[float, np.ndarray]:
        """Elastic energy [J] and internal force, actuators included."""
        energy, force = self.assembly.force(u)
        if self.assembly.coupling is not None:
            energy += self.assembly.coupling.add_force(u, self.commands(load_factor), force)
        return energy, force

    def growing(self, u: np.ndarray) -> np.ndarray:
        """Derivative of the unbalanced force by the load factor at fixed u: loads and commands."""
        force = self.loads.force(u)
        if self.assembly.coupling is None or self.base is not None:
            return force
        return force - self.assembly.coupling.command_force(u, Drive(1.0))

    def commands(self, load_factor: float) -> Drive:
        """The actuators' commands at a load factor."""
        return Drive(load_factor if self.base is None else 1.0)

    def external(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """External force λ f(u), plus the base loads."""
        force = load_factor * self.loads.force(u)
        return force if self.base is None else force + self.base.force(u)

    def potential(self, u: np.ndarray, load_factor: float) -> float:
        """Elastic energy less the work of the loads [J]; only conservative problems have one."""
        energy, _ = self.internal(u, load_factor)
        base = 0.0 if self.base is None else self.base.work(u)
        return energy - load_factor * self.loads.work(u) - base

    def force_scale(self, u: np.ndarray, load_factor: float) -> float:
        """Norm of the external forces plus that of the supports' [N]: what residuals are relative to."""
        _, internal = self.internal(u, load_factor)
        return self.scale_of(internal, self.external(u, load_factor))

    def scale_of(self, internal: np.ndarray, external: np.ndarray) -> float:
        """Return the norm [N] of external forces plus that of the supports', of forces (n, 3) [N]."""
        size: float = size_of(internal, external, self.constraints.held)
        return size

    def residual(self, u: np.ndarray, load_factor: float) -> Residual:
        """Return what the equilibrium equation leaves at u."""
        return self.advance(u, np.zeros_like(u), load_factor).residual

    def linearise(self, u: np.ndarray, load_factor: float, stresses: Stresses | None = None) -> Tangent:
        """Return the tangent at u, or with these stresses, and its factors; every call counts. Raises
        SingularMatrixError when there are none."""
        blocks = self.tangent(u, load_factor, stresses)
        return Tangent(blocks, self.factor(blocks))

    def advance(self, u: np.ndarray, step: np.ndarray, load_factor: float, predict: bool = False) -> Advance:
        """Go from u by a step (n, 3) [m]; predict: the stresses too."""
        after, length, internal, stresses = self.assembly.advance(u, step, predict)
        if self.assembly.coupling is not None:
            self.assembly.coupling.add_force(after, self.commands(load_factor), internal)
        external = self.external(after, load_factor)
        left = unbalanced_force(internal, external, self.constraints.held, self._free, self.system.unknowns)
        return Advance(after, length, Residual(*left), stresses if predict else None)

    def correct(
        self, factor: Factor, u: np.ndarray, load_factor: float, residual: Residual, predict: bool = False
    ) -> Advance:
        """Go from u by the Newton correction of its residual with these factors; predict: the stresses too.
        Raises SingularMatrixError when they do not solve the system."""
        return self.advance(u, self.expand(factor.solve(residual.reduced, SOLVED)), load_factor, predict)

    def solve_near(
        self, u: np.ndarray, load_factor: float, residual: Residual, stresses: Stresses | None, near: Factor
    ) -> Advance | None:
        """Go from u by the correction of its residual with the tangent there, solved by iterations with
        factors of one close by; None where those do not serve."""
        matrix = self.system.matrix(self.tangent(u, load_factor, stresses))
        found = iterated(matrix, near, residual.reduced)
        return None if found is None else self.advance(u, self.expand(found), load_factor, True)

    def note(self, load_factor: float, residual: float, step: float) -> None:
        """Keep one line of history and tell whoever watches."""
        line = Iteration(load_factor, residual, step)
        self.history.append(line)
        if self.progress:
            self.progress(line)


@njit(cache=True, nogil=True)
def unbalanced_force(
    internal: np.ndarray, external: np.ndarray, held: np.ndarray, free: Rows, n: int
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return external less internal force r (k, 3) [N], Tᵀ r (n,), its norm and the forces' `size_of`."""
    out = np.empty_like(internal)
    for i in range(len(out)):
        for q in range(3):
            out[i, q] = external[i, q] - internal[i, q]
    reduced = transposed_product(free, out.ravel(), n)
    total = 0.0
    for value in reduced:
        total += value * value
    return out, reduced, np.sqrt(total), size_of(internal, external, held)


@njit(cache=True, nogil=True)
def size_of(internal: np.ndarray, external: np.ndarray, held: np.ndarray) -> float:
    """Return the norm of the external forces plus that of the supports' [N]; held: (k, 3) bool."""
    loads = supports = 0.0
    for i in range(len(internal)):
        for q in range(3):
            loads += external[i, q] ** 2
            if held[i, q]:
                supports += internal[i, q] ** 2
    return np.sqrt(loads) + np.sqrt(supports)
