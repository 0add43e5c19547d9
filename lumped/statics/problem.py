"""A lattice under its supports and loads: residual, tangent and factors on the free unknowns.

With u = T q + g(λ), equilibrium is Tᵀ (λ f(u) − f_int(u)) = 0. Displacements and forces are (n, 3) [m], [N].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from lumped.actuators import Drive
from lumped.assembly import Assembly, Stresses
from lumped.linear.solver import Factor, ReducedSystem
from lumped.loads import Loads
from lumped.statics.faults import Fault
from lumped.supports import Constraints
from sheetbench.scenes import Iteration

Progress = Callable[[Iteration], None]


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
        self.system = ReducedSystem(
            self.assembly.pattern, self.constraints.transform, self.conservative, self._multiplier_unknowns()
        )

    def _multiplier_unknowns(self) -> np.ndarray | None:
        """Which unknowns are multipliers of the actuators' constraints, (m,) bool."""
        if self.assembly.coupling is None:
            return None
        of_unknowns: np.ndarray = abs(self.constraints.transform).T @ self.assembly.coupling.algebraic.ravel()
        return of_unknowns > 0.0

    @property
    def descends(self) -> bool:
        """Whether stable equilibria are minima of an energy of the free unknowns."""
        return self.conservative and self.multipliers == 0

    def reduce(self, force: np.ndarray) -> np.ndarray:
        """Tᵀ f, the force on the free unknowns."""
        reduced: np.ndarray = self.constraints.transform.T @ force.ravel()
        return reduced

    def expand(self, unknowns: np.ndarray) -> np.ndarray:
        """T q as a displacement."""
        return (self.constraints.transform @ unknowns).reshape(-1, 3)

    def tangent(self, u: np.ndarray, load_factor: float, stresses: Stresses | None = None) -> np.ndarray:
        """Blocks of the tangent of the residual, loads included."""
        blocks = self.assembly.tangent(u, stresses)
        self.loads.add_tangent(u, load_factor, blocks)
        if self.base is not None:
            self.base.add_tangent(u, 1.0, blocks)
        if self.assembly.coupling is not None:
            slots = self.assembly.coupling_slots
            self.assembly.coupling.add_tangent(u, self.commands(load_factor), slots, blocks)
        return blocks

    def factor(self, blocks: np.ndarray) -> Factor:
        """Factors of the reduced tangent; every call counts."""
        self.factorisations += 1
        return self.system.factor(blocks)

    def negative(self, factor: Factor) -> int | None:
        """Eigenvalues below zero of the factored tangent (real parts, when it is unsymmetric), on motions
        that the actuators' constraints allow: each multiplier brings one more."""
        if self.conservative:
            return None if factor.negative is None else factor.negative - self.multipliers
        if self.multipliers:
            return None
        self.factorisations += 1
        return factor.negative_real_parts()

    def prescribed(self, load_factor: float) -> np.ndarray:
        """Displacement of the masses that supports and actuators put in place."""
        placed = self.constraints.prescribed(load_factor if self.base is None else 1.0)
        if self.assembly.coupling is not None:
            placed = placed + self.assembly.coupling.driven(self.commands(load_factor))
        return placed

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
        """Elastic energy less the work of dead loads [J]; only conservative problems have one."""
        energy, _ = self.internal(u, load_factor)
        return energy - float(np.sum(self.external(u, load_factor) * u))

    def force_scale(self, u: np.ndarray, load_factor: float) -> float:
        """Norm of the external forces plus that of the supports' [N]: what residuals are relative to."""
        _, internal = self.internal(u, load_factor)
        return self._scale(internal, self.external(u, load_factor))

    def residual(self, u: np.ndarray, load_factor: float) -> tuple[np.ndarray, float]:
        """Unbalanced force (n, 3) [N] and its norm on the free unknowns relative to the forces."""
        _, internal = self.internal(u, load_factor)
        external = self.external(u, load_factor)
        unbalanced = external - internal
        scale = self._scale(internal, external)
        with np.errstate(over="ignore", invalid="ignore"):
            size = float(np.linalg.norm(self.reduce(unbalanced)))
        return unbalanced, size / scale if scale > 0.0 else size

    def _scale(self, internal: np.ndarray, external: np.ndarray) -> float:
        held = np.where(self.constraints.held, internal, 0.0)
        return float(np.linalg.norm(external) + np.linalg.norm(held))

    def note(self, load_factor: float, residual: float, step: float) -> None:
        """Keep one line of history and tell whoever watches."""
        line = Iteration(load_factor, residual, step)
        self.history.append(line)
        if self.progress:
            self.progress(line)
