"""A family of springs: what assembly, descent and the integrators ask of it, and of the dampers beside it.

A family is data (masses, rest geometry, a stiffness of every spring's own) and two modules of compiled loops
over it, `springs` and `dampers`, whose functions take the displacement, then the family's arrays. With a
measure ε(u) and a stress τ = k ε, a spring's force is τ ∇ε and its tangent k ∇ε ∇εᵀ + τ ∇²ε, where τ is an
argument: that at u, an extrapolated one, its harmless part, or a damper's c ε̇.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any, ClassVar, Self

import numpy as np


@dataclass(frozen=True, eq=False)
class Family(ABC):
    """nodes: (m, …) masses of each spring; stiffness: (m,) or (m, 3) [N/m]; slots: (m, …) block numbers of
    each spring's pairs of masses. Displacements and forces are (n, 3) [m], [N]."""

    nodes: np.ndarray
    stiffness: np.ndarray
    slots: np.ndarray

    springs: ClassVar[Any]
    dampers: ClassVar[Any]
    conservative: ClassVar[bool] = True  # whether there is an energy, and so a symmetric tangent

    def __len__(self) -> int:
        return len(self.nodes)

    @property
    @abstractmethod
    def geometry(self) -> tuple[np.ndarray, ...]:
        """What the loops take between nodes and stiffness."""

    @cached_property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """What the loops take after the displacement."""
        return (self.nodes, *self.geometry, self.stiffness)

    def add_force(self, u: np.ndarray, force: np.ndarray) -> float:
        """Add the internal force; the energy [J]."""
        energy: float = self.springs.add_forces(u, *self.arrays, force)
        return energy

    def add_average_force(self, start: np.ndarray, end: np.ndarray, force: np.ndarray) -> None:
        """Add the force over a step whose work is the energy stored in it."""
        self.springs.add_average_forces(start, end, *self.arrays, force)

    def stresses(self, u: np.ndarray) -> np.ndarray:
        """Stress of every spring, shaped as the stiffness: tension [N] of links, [N/m] of cells."""
        stresses: np.ndarray = self.springs.stresses(u, *self.arrays)
        return stresses

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Stresses that the linearisation at u predicts after `step`."""
        found: np.ndarray = self.springs.extrapolated(u, step, *self.arrays)
        return found

    def rates(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Rates k ∇ε·v of the stresses at u."""
        rates: np.ndarray = self.springs.rates(u, v, *self.arrays)
        return rates

    def harmless(self, stress: np.ndarray) -> np.ndarray:
        """Stresses with which the tangent is positive while strains are small: none of compression."""
        return np.maximum(stress, 0.0)

    def add_tangent(self, u: np.ndarray, stress: np.ndarray, blocks: np.ndarray) -> None:
        """Add the tangent to the 3×3 blocks (b, 3, 3) [N/m]."""
        self.springs.add_tangent(u, *self.arrays, stress, self.slots, blocks)

    @abstractmethod
    def energies(self, stress: np.ndarray) -> np.ndarray:
        """Energy of every spring under its stress, (m,) [J]."""

    @abstractmethod
    def by_name(self, energies: np.ndarray) -> dict[str, float]:
        """Energies (m,) summed under the names that the springs have in a spring set [J]."""

    def symmetric(self) -> Family:
        """Springs with an energy, and so a symmetric tangent, that stand for these in a matrix: these."""
        return self

    def damped(self, time: float) -> Dampers:
        """Dampers of coefficient time [s] × stiffness."""
        return Dampers(replace(self, stiffness=time * self.stiffness))

    def rounded(self) -> Self:
        """The same in single precision."""
        values = {field.name: getattr(self, field.name) for field in fields(self)}
        doubles = {name for name, value in values.items() if getattr(value, "dtype", None) == np.float64}
        return replace(self, **{name: values[name].astype(np.float32) for name in doubles})


@dataclass(frozen=True)
class Dampers:
    """Dampers that resist the rates of a family's measures, their coefficients [N·s/m] in place of its
    stiffness: force c ε̇ ∇ε, power taken c ε̇². Velocities are (n, 3) [m/s]."""

    family: Family

    def add_force(self, u: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
        """Add the damping force, signed as an internal one; the power taken [W]."""
        power: float = self.family.dampers.add_forces(u, v, *self.family.arrays, force)
        return power

    def add_velocity_tangent(self, u: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        """Add scale × the derivative of the force by the velocity, c ∇ε ∇εᵀ, to the 3×3 blocks."""
        scaled = replace(self.family, stiffness=scale * self.family.stiffness)
        scaled.add_tangent(u, np.zeros_like(scaled.stiffness), blocks)

    def add_displacement_tangent(self, u: np.ndarray, v: np.ndarray, blocks: np.ndarray) -> None:
        """Add the derivative of the force by the displacement, c ε̇ ∇²ε + c ∇ε (∇²ε v)ᵀ, unsymmetric."""
        unloaded = replace(self.family, stiffness=np.zeros_like(self.family.stiffness))
        unloaded.add_tangent(u, self.family.rates(u, v), blocks)
        self.family.dampers.add_turning(u, v, *self.family.arrays, self.family.slots, blocks)
