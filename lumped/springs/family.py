"""A family of springs: what assembly, descent and the integrators ask of it, and of the dampers beside it.

A family is data (masses, rest geometry, the constants of every spring's law) and a module of compiled loops
over it, `lumped.springs.links` or `lumped.springs.cells`, whose functions take the displacement, then the
family's arrays. Stresses S, stiffness D and its material part M are those of `lumped.springs.laws`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np


@dataclass(frozen=True, eq=False)
class Family(ABC):
    """nodes: (m, …) masses of each spring; stiffness: (m,) or (m, 4) [N/m]; slots: (m, …) block numbers of
    each spring's pairs of masses. Displacements and forces are (n, 3) [m], [N]."""

    nodes: np.ndarray
    stiffness: np.ndarray
    slots: np.ndarray

    loops: ClassVar[Any]
    measures: ClassVar[int] = 4  # that a spring's memory holds room for
    conservative: ClassVar[bool] = True  # whether there is an energy, and so a symmetric tangent
    no_stress: ClassVar[np.ndarray]  # for which the tangent takes its own

    def __len__(self) -> int:
        return len(self.nodes)

    @property
    @abstractmethod
    def arrays(self) -> Any:
        """Return what the loops take after the displacement, `LinkArrays` or `CellArrays`."""

    def add_force(self, u: np.ndarray, force: np.ndarray) -> float:
        """Add the internal force; return the energy [J]."""
        energy: float = self.loops.add_forces(u, self.arrays, force)
        return energy

    def add_average_force(self, start: np.ndarray, end: np.ndarray, force: np.ndarray) -> None:
        """Add the force over a step whose work is the energy stored in it."""
        self.loops.add_average_forces(start, end, self.arrays, force)

    def stresses(self, u: np.ndarray) -> np.ndarray:
        """Return the stress of every spring, (m,) of links, (m, 3) of cells [N/m]."""
        return self.extrapolated(u, np.zeros_like(u))

    def extrapolated(self, u: np.ndarray, step: np.ndarray) -> np.ndarray:
        """Return the stresses that the linearisation at u predicts after `step`."""
        predicted: np.ndarray = self.loops.extrapolated(u, step, self.arrays)
        return predicted

    @abstractmethod
    def nonnegative_part(self, u: np.ndarray) -> np.ndarray:
        """Return stresses with which, and with the material part M, the tangent is a sum of squares; with
        negative area springs (ν < 1/3) only while strains are small."""

    def add_tangent(
        self, u: np.ndarray, stress: np.ndarray, blocks: np.ndarray, share: float = 1.0, lower: bool = False
    ) -> None:
        """Add the tangent with this stress, and M + share (D − M), to the 3×3 blocks [N/m], or to those on
        and below the diagonal."""
        self.loops.add_tangent(u, self.arrays, stress, share, lower, blocks)

    @abstractmethod
    def energies(self, u: np.ndarray, linear: bool = False) -> np.ndarray:
        """Return the energy of every spring, (m,), or of both kinds of springs on every cell, (m, 2) [J], or
        what is quadratic in u of it."""

    @abstractmethod
    def by_name(self, energies: np.ndarray) -> dict[str, float]:
        """Return energies summed under the names that the springs have in a spring set [J]."""

    def rounded(self) -> Family:
        """Return the springs whose force is computed in single precision: these, with their rest data."""
        return self

    def damped(self, time: float) -> Dampers:
        """Return dampers of coefficient time [s] × stiffness."""
        return Dampers(replace(self, stiffness=time * self.stiffness))


@dataclass(frozen=True)
class Dampers:
    """Dampers that resist the rates of a family's measures, their coefficients [N·s/m] in place of its
    stiffness: stress M ġ, power taken ġ·M ġ. Velocities are (n, 3) [m/s]."""

    family: Family

    def add_velocity_tangent(self, u: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        """Add scale × the derivative of the force by the velocity to the 3×3 blocks."""
        scaled = replace(self.family, stiffness=scale * self.family.stiffness)
        scaled.add_tangent(u, scaled.no_stress, blocks, 0.0)

    def add_displacement_tangent(self, u: np.ndarray, v: np.ndarray, blocks: np.ndarray) -> None:
        """Add the derivative of the force by the displacement to the 3×3 blocks, unsymmetric."""
        self.family.loops.add_damping_tangent(u, v, self.family.arrays, blocks)
