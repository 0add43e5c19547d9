"""A discrete sheet of elements whose strains are quadratic in the coordinates, e = ½ Qᵀ H Q − ½ Q₀ᵀ H Q₀.

    f = Bᵀ s,    K = Bᵀ D B + Σ s_k H_k,    s = s(e) + τ D ė + what the branches add

The stress of K may be another than that of f: statics take the one that their last step extrapolated.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Sequence
from copy import copy
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np
from scipy.sparse import csr_matrix

from fem_reference.discrete.rods import Rods
from fem_reference.discrete.shape import SheetShape
from fem_reference.discrete.sheet import Discrete
from fem_reference.shell.element import weighed
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import Fault
from sheetbench.numerics.direct import DirectSolver
from sheetbench.numerics.sparsity import Pattern, add_blocks

if TYPE_CHECKING:
    from fem_reference.surface.rod import BoundRods


class DiscreteElements(Discrete):
    """element: all elements; sites: their vectors (m, a) among all; held: which coordinates of positions are;
    pattern: of the tangent, the plan's elements first and then the rods' sides. creep: drag σ and strains
    e_n (m, k) of a step of creep, which adds σ D (e − e_n) to the stresses, of D at no strain."""

    element: Any
    sites: np.ndarray
    held: np.ndarray
    creeps: ClassVar[bool] = False
    creep: tuple[float, np.ndarray] | None = None
    pattern: Pattern

    def gather(self, q: np.ndarray) -> np.ndarray:
        """Changes of the elements' vectors (m, a, 3) of coordinates (N,)."""
        return q.reshape(-1, 3).take(self.sites, axis=0)

    def scatter(self, pull: np.ndarray) -> np.ndarray:
        """Sums (N,) of what pulls at the elements' vectors (m, a, 3)."""
        return np.bincount(self._components, pull.ravel(), self.size)

    @cached_property
    def _components(self) -> np.ndarray:
        """The elements' coordinates (3 a m,) among all."""
        return (3 * self.sites.ravel()[:, None] + np.arange(3)).ravel()

    @abstractmethod
    def stiffness(
        self, shape: SheetShape, moduli: np.ndarray, stress: np.ndarray, residual: np.ndarray, by_a: float
    ) -> np.ndarray:
        """Data of the elements' K and `by_a` times their M, and of what the constraints add under a residual
        (N,)."""

    @abstractmethod
    def fold(self, shape: SheetShape, on: np.ndarray, tangent: np.ndarray) -> np.ndarray:
        """Those (k, 18, 3, 18, 3) of forces on φ and d at elements `on`, by their unknowns, (k, b, b)."""

    @abstractmethod
    def onto_rods(self, shape: SheetShape) -> np.ndarray:
        """∂Q/∂(unknowns) of the rods' sides (k, 3 a, b)."""

    def places(self, bound: BoundRods) -> np.ndarray:
        """Places in the plane (M, 2) of the plan's elements and then of the rods' sides."""
        sites = [self.plan.elements, *(rod.nodes for rod in bound.rods)]
        return np.concatenate([self.plan.nodes[nodes].mean(axis=1) for nodes in sites])

    def solver(self) -> DirectSolver:
        """What factorises tangents."""
        return DirectSolver(self.symmetric, lambda: self.pattern.fronts)

    def reduce(self, shape: SheetShape, force: np.ndarray) -> np.ndarray:
        """Zᵀ f (unknowns,) of forces (N,)."""
        return np.asarray(self.basis(shape.q, shape.at).T @ force)

    def expand(self, shape: SheetShape, step: np.ndarray) -> np.ndarray:
        """Z x (N,) of a step (unknowns,)."""
        return np.asarray(self.basis(shape.q, shape.at) @ step)

    def fault(self, shape: SheetShape) -> Fault | None:
        """Why an equilibrium is given up: an element that has turned inside out."""
        found = self.inside_out(shape.q)
        return Fault(Status.INVERTED, found) if found else None

    def stress(self, shape: SheetShape) -> np.ndarray:
        """s + τ D ė (m, k), and what the branches add at the end of their step."""
        stress, step = shape.elastic, shape.branches
        if step is not None:
            stress = stress + ((step.gain - 1.0) * stress + step.past.reshape(stress.shape))
        return stress + self.tau * weighed(shape.moduli, shape.rate) if self.tau else stress

    def internal(self, shape: SheetShape) -> np.ndarray:
        """Elastic and viscous forces (N,) of the sheet's elements and of its rods."""
        out = self.scatter(self.element.forces(shape.operator, self.stress(shape)))
        for body in self.bodies:
            out = out + body.scatter(body.pull(shape.q, body.stress(shape)))
        return out

    def forces(self, shape: SheetShape) -> np.ndarray:
        """g (N,): internal and viscous less external forces."""
        forces = self.internal(shape) - self.external(shape)
        damped = self.alpha and shape.v is not None
        return forces + self.alpha * (self.sheet_mass @ shape.v) if damped else forces

    def tangent(self, shape: SheetShape, residual: np.ndarray, by_a: float, by_v: float) -> csr_matrix:
        """Zᵀ (by_a M + by_v C + K) Z, and what the constraints add under a residual (N,)."""
        gain = 1.0 if shape.branches is None else shape.branches.gain
        moduli = (gain + by_v * self.tau) * shape.moduli
        on_rods = [body.stress(shape) for body in self.bodies]
        return self.system(shape, moduli, self.stress(shape), on_rods, residual, by_a, by_v)[0]

    def system(
        self,
        shape: SheetShape,
        moduli: np.ndarray,
        stress: np.ndarray,
        on_rods: Sequence[np.ndarray],
        residual: np.ndarray,
        by_a: float = 0.0,
        by_v: float = 0.0,
        move: np.ndarray | None = None,
    ) -> tuple[csr_matrix, np.ndarray]:
        """Tangent under stresses of elements and rods, and its product (N,) with a step (N,) of all
        coordinates."""
        data = self.stiffness(shape, moduli, stress, residual, by_a + self.alpha * by_v)
        slots, element, product = self.pattern.slots, self.element, np.zeros(self.size)
        if move is not None:
            of_move = self.gather(move)
            pull = element.forces(shape.operator, weighed(moduli, element.step(shape.operator, of_move)))
            product += self.scatter(pull + element.geometric(of_move, stress))
        for item in self.items:
            if not self.linear and (found := item.tangent(shape)) is not None:
                on, by_surface = found
                add_blocks(data, slots[0][on], -self.fold(shape, on, by_surface))
                if move is not None:
                    moved = self.surface_change(move)[on]
                    product -= self.of_surface(on, np.einsum("eicjd,ejd->eic", by_surface, moved))
            if by_v and (found := item.damping(shape)) is not None:
                on, by_rates = found
                add_blocks(data, slots[0][on], -by_v * self.fold(shape, on, by_rates))
        for body, own in zip(self.bodies, on_rods, strict=True):
            sides, onto = body.tangent(shape, own, by_a, by_v), self.onto_rods(shape)
            add_blocks(data, slots[1], onto.swapaxes(1, 2) @ sides @ onto)
            if move is not None:
                product += body.scatter(sides @ move[body.rows][:, :, None])
        return self.pattern.with_data(data), product

    def moduli(self, shape: SheetShape, pressure: np.ndarray | None) -> np.ndarray:
        """D (m, k, k), of a law with a pressure of its own at that one."""
        return shape.moduli if pressure is None else self.element.moduli(shape.strain, pressure)

    def pressure(self, shape: SheetShape, by: np.ndarray) -> np.ndarray | None:
        """Pressure, linear in a change of the strain (m, k), of a law that has one of its own."""
        return None

    def dragged(self, shape: SheetShape, drag: float) -> Self:
        """The sheet whose equilibrium is the end of a step of creep from a shape, against drag σ."""
        slow = copy(self)
        slow.creep = drag, shape.strain
        slow.bodies = [body.dragged(shape, drag) for body in self.bodies]
        return slow

    def strain(self, change: np.ndarray, at: float) -> np.ndarray:
        """Return strains (m, k) of a change of the elements' vectors (m, a, 3), less the natural ones."""
        found = self.element.strain(change)
        return found if self.natural is None else found - self.natural.at(*self.instant(at))

    def elastic(self, shape: SheetShape) -> float:
        """Strain energy [J] of the sheet."""
        return sum(self.element.energies(shape.strain).values())

    def measured(self, force: np.ndarray, scale: np.ndarray | float = 1.0) -> float:
        """Norm [N] of forces, those on directors, whose scale is the lever, over that."""
        return float(np.linalg.norm(force / scale, self.norm))

    def scale_of(self, body: Rods) -> np.ndarray:
        """The scale of a body's vectors (k, a, 3)."""
        return self.scale[body.rows].reshape(body.elements.reference.shape)

    def summed(self, shape: SheetShape) -> float:
        """Σ |B| |s| [N] of elements and rods, what forces are sums of, those on directors over the lever."""
        magnitudes = self.element.magnitudes(shape.operator, shape.elastic)
        total = float((magnitudes / self.scale[3 * self.sites[0]]).sum())
        for body in self.bodies:
            sides = body.magnitudes(shape.q, body.stress(shape))
            total += float((sides / self.scale_of(body)).sum())
        return total
