"""The elastic rods of `rod` on the linear plate: the same strains, linearised about the flat sheet.

    ½ Σ S (B q − e₀)²,    B = H Q₀

with q the change of Q = (φ, d, m). With s along the edge, t outwards, tilt β and the axis at the height c the
strains are, per length,

    axial u_s,s + c β_s,s    shear w,s + β_s    aside u_t,s + c β_t,s + m_s    twist β_t,s    square β_t + m_z
    bending −β_s,s out of the plane, −m_s,s in it

so that a rod off the mid-surface couples bending and membrane, as it should. Its intrinsic curvature is an
initial moment EI κ₀; what that moment does as the rod deflects is of second order. Unknowns beside the
plate's are m_s and m_z at the nodes of the edges. SI units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference.surface.bound_rods import BoundRods
from fem_reference.surface.rod_elements import Strained


@dataclass(frozen=True)
class PlateRods:
    """The rods of a plate with n nodes: number (2n + q, 3) of every vector's unknowns, −1 where it has none.

    The plate's are 5·node + field, m has two.
    """

    bound: BoundRods
    number: np.ndarray

    @classmethod
    def on(cls, bound: BoundRods, nodes: int) -> PlateRods:
        """The rods on a plate with so many nodes."""
        number = np.full((2 * nodes + len(bound.own), 3), -1)
        of_plate = np.arange(5 * nodes).reshape(-1, 5)
        number[:nodes], number[nodes : 2 * nodes, :2] = of_plate[:, :3], of_plate[:, 3:]
        across = bound.own == 0.0
        number[2 * nodes :][across] = 5 * nodes + np.arange(across.sum())
        return cls(bound, number)

    @property
    def held(self) -> np.ndarray:
        """Which of the rods' own unknowns their bases hold."""
        return np.repeat(self.bound.held, 2)

    @property
    def unknowns(self) -> np.ndarray:
        """Numbers of the sides' unknowns, (k, 27)."""
        return self.number[self.bound.sites].reshape(-1, 27)

    def stiffness(self) -> np.ndarray:
        """Bᵀ S B of the sides, (k, 27, 27)."""
        operator = self._operator()
        flat = operator.reshape(*operator.shape[:2], 27)
        return flat.swapaxes(1, 2) @ (self.bound.elements.stiffness[:, :, None] * flat)

    def strained(self, u: np.ndarray) -> Strained:
        """B, stresses and pull of all unknowns u: internal, less the rods' weight."""
        rods, operator = self.bound.elements, self._operator()
        stress = rods.stiffness * (self._strain(u) - rods.intrinsic)
        return Strained(operator, stress, rods.force(operator, stress) - rods.weight)

    def force(self, size: int) -> np.ndarray:
        """The rods' weight and initial moments on all unknowns, (size,)."""
        pull = self.strained(np.zeros(size)).pull.reshape(-1, 27)
        out, free = np.zeros(size), self.unknowns >= 0
        np.subtract.at(out, self.unknowns[free], pull[free])
        return out

    def energy(self, u: np.ndarray) -> float:
        """Strain energy [J] of all rods."""
        rods = self.bound.elements
        return 0.5 * float(np.sum(rods.stiffness * (self._strain(u) - rods.intrinsic) ** 2))

    def _operator(self) -> np.ndarray:
        """B (k, 15, 9, 3)."""
        return self.bound.elements.gradient(np.zeros_like(self.bound.elements.reference))

    def _strain(self, u: np.ndarray) -> np.ndarray:
        change = np.where(self.unknowns >= 0, u[self.unknowns], 0.0).reshape(-1, 9, 3)
        return np.einsum("esic,eic->es", self._operator(), change)
