"""A discrete sheet of elements whose strains are quadratic in the coordinates, e = ½ Qᵀ H Q − ½ Q₀ᵀ H Q₀.

    f = Bᵀ s,    K = Bᵀ D B + Σ s_k H_k,    s = s(e) + τ D ė + s of the Maxwell branches

The stress in K may differ from the stress in f: statics use the stress that their last step extrapolated.
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
    """Discrete sheet of elements. element: all elements; sites: indices of their vectors (m, a) among all;
    held: mask of held coordinates of positions; pattern: of the tangent, the plan's elements first and then
    the rods' sides. creep: drag σ and strains e_n (m, k) of a step of creep, which adds σ D (e − e_n) to the
    stresses, D at zero strain."""

    element: Any
    sites: np.ndarray
    held: np.ndarray
    creeps: ClassVar[bool] = False
    creep: tuple[float, np.ndarray] | None = None
    pattern: Pattern

    def gather(self, q: np.ndarray) -> np.ndarray:
        """Return changes (m, a, 3) of the elements' vectors from coordinates (N,)."""
        return q.reshape(-1, 3).take(self.sites, axis=0)

    def scatter(self, pull: np.ndarray) -> np.ndarray:
        """Assemble forces (N,) from forces on the elements' vectors (m, a, 3)."""
        return np.bincount(self._components, pull.ravel(), self.size)

    @cached_property
    def _components(self) -> np.ndarray:
        """Indices (3 a m,) of the elements' coordinates among all."""
        return (3 * self.sites.ravel()[:, None] + np.arange(3)).ravel()

    @abstractmethod
    def stiffness(
        self, shape: SheetShape, moduli: np.ndarray, stress: np.ndarray, residual: np.ndarray, by_a: float
    ) -> np.ndarray:
        """Return data of the elements' K + `by_a` M, with the constraints' stiffness under a residual."""

    @abstractmethod
    def fold(self, shape: SheetShape, on: np.ndarray, tangent: np.ndarray) -> np.ndarray:
        """Transform the tangents (k, 18, 3, 18, 3) of forces on elements `on` to their unknowns, (k, b,
        b)."""

    @abstractmethod
    def onto_rods(self, shape: SheetShape) -> np.ndarray:
        """Return the derivatives (k, 3 a, b) of the vectors Q of the rods' sides by the unknowns."""

    def places(self, bound: BoundRods) -> np.ndarray:
        """Return centres (M, 2) [m] in the plane of the plan's elements and then of the rods' sides."""
        sites = [self.plan.elements, *(rod.nodes for rod in bound.rods)]
        return np.concatenate([self.plan.nodes[nodes].mean(axis=1) for nodes in sites])

    def solver(self) -> DirectSolver:
        """Return the solver that factorises tangents."""
        return DirectSolver(self.symmetric, lambda: self.pattern.fronts)

    def reduce(self, shape: SheetShape, force: np.ndarray) -> np.ndarray:
        """Return Zᵀ f (unknowns,) of forces (N,)."""
        return np.asarray(self.basis(shape.q, shape.at).T @ force)

    def expand(self, shape: SheetShape, step: np.ndarray) -> np.ndarray:
        """Return Z x (N,) of a step (unknowns,)."""
        return np.asarray(self.basis(shape.q, shape.at) @ step)

    def fault(self, shape: SheetShape) -> Fault | None:
        """Return the fault of an equilibrium with an inverted element, else None."""
        message = self.inverted_element(shape.q)
        return Fault(Status.INVERTED, message) if message else None

    def stress(self, shape: SheetShape) -> np.ndarray:
        """Return s + τ D ė (m, k) with the stress of the branches at the end of their step."""
        stress, step = shape.elastic, shape.branches
        if step is not None:
            stress = stress + ((step.gain - 1.0) * stress + step.past.reshape(stress.shape))
        return stress + self.tau * weighed(shape.moduli, shape.rate) if self.tau else stress

    def internal(self, shape: SheetShape) -> np.ndarray:
        """Return elastic and viscous forces (N,) of the sheet's elements and of its rods."""
        out = self.scatter(self.element.forces(shape.operator, self.stress(shape)))
        for body in self.bodies:
            out = out + body.scatter(body.pull(shape.q, body.stress(shape)))
        return out

    def forces(self, shape: SheetShape) -> np.ndarray:
        """Return g (N,): internal and viscous less external forces."""
        forces = self.internal(shape) - self.external(shape)
        damped = self.alpha and shape.v is not None
        return forces + self.alpha * (self.sheet_mass @ shape.v) if damped else forces

    def tangent(self, shape: SheetShape, residual: np.ndarray, by_a: float, by_v: float) -> csr_matrix:
        """Return Zᵀ (by_a M + by_v C + K) Z with the constraints' stiffness under a residual (N,)."""
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
        """Return the tangent under given stresses, and its product (N,) with a step `move` (N,)."""
        data = self.stiffness(shape, moduli, stress, residual, by_a + self.alpha * by_v)
        slots, element, product = self.pattern.slots, self.element, np.zeros(self.size)
        if move is not None:
            of_move = self.gather(move)
            pull = element.forces(shape.operator, weighed(moduli, element.step(shape.operator, of_move)))
            product += self.scatter(pull + element.geometric(of_move, stress))
        for item in self.items:
            if not self.linear and (block := item.tangent(shape)) is not None:
                on, by_surface = block
                add_blocks(data, slots[0][on], -self.fold(shape, on, by_surface))
                if move is not None:
                    moved = self.surface_change(move)[on]
                    product -= self.of_surface(on, np.einsum("eicjd,ejd->eic", by_surface, moved))
            if by_v and (block := item.damping(shape)) is not None:
                on, by_rates = block
                add_blocks(data, slots[0][on], -by_v * self.fold(shape, on, by_rates))
        for body, body_stress in zip(self.bodies, on_rods, strict=True):
            sides, onto = body.tangent(shape, body_stress, by_a, by_v), self.onto_rods(shape)
            add_blocks(data, slots[1], onto.swapaxes(1, 2) @ sides @ onto)
            if move is not None:
                product += body.scatter(sides @ move[body.rows][:, :, None])
        return self.pattern.with_data(data), product

    def moduli(self, shape: SheetShape, pressure: np.ndarray | None) -> np.ndarray:
        """Return D (m, k, k), at the given pressure where the law has a pressure of its own."""
        return shape.moduli if pressure is None else self.element.moduli(shape.strain, pressure)

    def pressure(self, shape: SheetShape, by: np.ndarray) -> np.ndarray | None:
        """Return the pressure, linear in a change of the strain (m, k), of a law that has one, else None."""
        return None

    def creep_step(self, shape: SheetShape, drag: float) -> Self:
        """Return the sheet with the stresses of a creep step against drag σ from a shape: its equilibrium
        ends the step."""
        slow = copy(self)
        slow.creep = drag, shape.strain
        slow.bodies = [body.creep_step(shape, drag) for body in self.bodies]
        return slow

    def strain(self, change: np.ndarray, at: float) -> np.ndarray:
        """Return strains (m, k) of a change of the elements' vectors (m, a, 3), less the natural ones."""
        strain = self.element.strain(change)
        return strain if self.natural is None else strain - self.natural.at(*self.instant(at))

    def elastic(self, shape: SheetShape) -> float:
        """Return the sheet's strain energy [J]."""
        return sum(self.element.energies(shape.strain).values())

    def norm_of(self, force: np.ndarray, scale: np.ndarray | float = 1.0) -> float:
        """Return the norm [N] of forces; scale: 1, or the longer side for forces on directors."""
        return float(np.linalg.norm(force / scale, self.norm))

    def scale_of(self, body: Rods) -> np.ndarray:
        """Return the scale of a body's vectors (k, a, 3)."""
        return self.scale[body.rows].reshape(body.elements.reference.shape)

    def summed(self, shape: SheetShape) -> float:
        """Return Σ |B| |s| [N], the magnitudes of the forces' terms, on directors over the longer side."""
        magnitudes = self.element.magnitudes(shape.operator, shape.elastic)
        total = float((magnitudes / self.scale[3 * self.sites[0]]).sum())
        for body in self.bodies:
            sides = body.magnitudes(shape.q, body.stress(shape))
            total += float((sides / self.scale_of(body)).sum())
        return total
