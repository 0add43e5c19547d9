"""A lattice under its supports and loads: residual, tangent and factors on the free unknowns.

With u = T q + g(λ), equilibrium is Tᵀ (λ f(u) − f_int(u)) = 0. Displacements and forces are (n, 3) [m], [N].
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from lumped.actuators import Coupling, Drive
from lumped.assembly import Assembly
from lumped.contact import Contact
from lumped.items import LatticeItem
from lumped.loads import Loads
from lumped.springs import all_families
from lumped.springs.all_families import NO_STRESSES, SpringArrays, Stresses
from lumped.springs.survey import Survey
from lumped.supports import Constraints
from sheetbench.numerics import banded
from sheetbench.numerics.continuation.newton import SOLVED
from sheetbench.numerics.direct import Count, Factor
from sheetbench.numerics.maps import Rows, product, transposed_product
from sheetbench.numerics.reduced import ReducedSystem, banded_factor
from sheetbench.numerics.typed import njit, typed

NOTHING = np.empty((0, 3))


class Unknowns(NamedTuple):
    """held: (n, 3) bool, what supports hold; free: T; band: where the reduced matrix goes, if in a band."""

    held: np.ndarray
    free: Rows
    band: banded.Band


class Residual(NamedTuple):
    """What the equilibrium equation leaves: the unbalanced force (n, 3) [N], the part of it on the free
    unknowns (m,) and that one's norm [N]; scale: the norm [N] of the external forces plus the supports'."""

    force: np.ndarray
    reduced: np.ndarray
    norm: float
    scale: float


class LatticeState(NamedTuple):
    """Displacement u (n, 3) [m] at a load factor, what the equilibrium equation leaves there and the stresses
    that the linearisation before the last step predicts, where they are known; where that step began, and how
    far it went at most [m]."""

    u: np.ndarray
    load_factor: float
    residual: Residual | None = None
    stresses: Stresses | None = None
    start: np.ndarray | None = None
    length: float = 0.0


@dataclass
class Problem:
    """A lattice under its supports and loads, which grow with the load factor λ.

    size: the sheet's longer side [m]; items: what else acts on the sheet (`lumped.items`).
    """

    assembly: Assembly
    constraints: Constraints
    loads: Loads
    size: float
    items: tuple[LatticeItem, ...] = ()

    def __post_init__(self) -> None:
        self.conservative = self.assembly.conservative and self.loads.conservative
        self.contacts = [item for item in self.items if isinstance(item, Contact)]
        coupling = self.assembly.coupling
        self.multipliers = coupling.multipliers if coupling is not None else 0
        self._free = self.constraints.transform_arrays
        self._others = self.items or self.assembly.coupling is not None or self.loads.follow
        pattern, transform = self.assembly.pattern, self.constraints.transform
        if coupling is None:
            self.system = self.constraints.reduced(pattern, self.conservative)
        else:
            multipliers = self._multiplier_unknowns(coupling)
            self.system = ReducedSystem(pattern, transform, self.conservative, multipliers)
        band = self.system.band or banded.NO_BAND
        self._unknowns = typed(Unknowns(self.constraints.held, self._free, band))

    def _multiplier_unknowns(self, coupling: Coupling) -> np.ndarray:
        """Which unknowns are multipliers of the actuators' constraints, (m,) bool."""
        of_unknowns: np.ndarray = abs(self.constraints.transform).T @ coupling.algebraic.ravel()
        return of_unknowns > 0.0

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

    @cached_property
    def driving(self) -> float:
        """Norm of the forces [N] of the natural state on the flat sheet, often the only ones."""
        if self.assembly.natural is None:
            return 0.0
        return float(np.linalg.norm(self.assembly.force(np.zeros_like(self.loads.dead))[1]))

    def tangent(self, u: np.ndarray, load_factor: float, stresses: Stresses | None = None) -> np.ndarray:
        """Blocks of the tangent of the residual, loads included."""
        blocks = self.assembly.at(load_factor).tangent(u, stresses, extrapolated=stresses is not None)
        return self._with_loads(blocks, u, load_factor)

    def nonnegative_tangent(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """Return blocks of the tangent less what could make that of the springs indefinite."""
        springs = self.assembly.at(load_factor).all_families
        return self._with_loads(springs.nonnegative_tangent(u), u, load_factor, True)

    def _with_loads(
        self, blocks: np.ndarray, u: np.ndarray, load_factor: float, definite: bool = False
    ) -> np.ndarray:
        self.loads.add_tangent(u, load_factor, blocks)
        for item in self.items:
            item.add_tangent((u, Drive(load_factor)), 1.0, blocks, definite)
        if self.assembly.coupling is not None:
            slots = self.assembly.coupling_slots
            self.assembly.coupling.add_tangent(u, Drive(load_factor), slots, blocks)
        return blocks

    def prescribed(self, load_factor: float) -> np.ndarray:
        """Displacement of the masses that supports and actuators put in place."""
        placed = self.constraints.prescribed(load_factor)
        if self.assembly.coupling is not None:
            placed = placed + self.assembly.coupling.driven(Drive(load_factor))
        return placed

    def project_to_supports(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """Return the displacement closest to u (n, 3) [m] that the supports allow."""
        prescribed = self.prescribed(load_factor)
        return self.expand(self.constraints.nearest(u - prescribed)) + prescribed

    def internal(self, u: np.ndarray, load_factor: float) -> tuple[float, np.ndarray]:
        """Elastic energy [J] and internal force, actuators included."""
        energy, force = self.assembly.at(load_factor).force(u)
        return energy + self._add_others(u, Drive(load_factor), force), force

    def _add_others(self, u: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add the internal force of actuators and items; return their energy [J]."""
        energy = sum(item.add_force((u, drive), force) for item in self.items)
        if self.assembly.coupling is not None:
            energy += self.assembly.coupling.add_force(u, drive, force)
        return energy

    def survey(self, u: np.ndarray, load_factor: float) -> Survey:
        """Return what the springs store, the items together under a name of their own, and how far springs
        are strained."""
        found = self.assembly.at(load_factor).survey(u)
        if self.items:
            at, force = (u, Drive(load_factor)), np.zeros_like(u)
            found.energies["contact"] = sum(item.add_force(at, force) for item in self.items)
        return found

    def external(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """External force λ f(u)."""
        return load_factor * self.loads.force(u)

    def potential(self, u: np.ndarray, load_factor: float) -> float:
        """Elastic energy less the work of the loads [J]; only conservative problems have one."""
        energy, _ = self.internal(u, load_factor)
        return energy - load_factor * self.loads.work(u)

    def residual(self, u: np.ndarray, load_factor: float) -> Residual:
        """Return the residual at u."""
        others = self.assembly.coupling is not None or self.assembly.natural is not None or self.items
        flat = not (others or u.any())  # where springs are at rest
        internal = np.zeros(u.shape) if flat else self.internal(u, load_factor)[1]
        return self._residual(internal, u, load_factor)

    def _residual(self, internal: np.ndarray, u: np.ndarray, load_factor: float) -> Residual:
        load, n = self.loads.force(u), self.system.unknowns
        return Residual(*unbalanced_force(internal, load, self.driving, load_factor, self._unknowns, n))

    def advance(
        self, u: np.ndarray, step: np.ndarray, load_factor: float, moved: np.ndarray | None = None
    ) -> LatticeState:
        """Return where a step (m,) [m] of the unknowns from u leads, with what is moved (n, 3) [m] beside,
        the residual and the predicted stresses there."""
        springs, drive = self.assembly.at(load_factor).all_families, Drive(load_factor)
        moved, external = NOTHING if moved is None else moved, (self.loads.last_dead, self.driving)
        after, length, internal, stresses, residual = advance(
            u, step, moved, *external, load_factor, self._unknowns, springs.springs
        )
        if self._others or not springs.conservative:
            internal = springs.beside(after, internal)
            self._add_others(after, drive, internal)
            residual = self._residual(internal, after, load_factor)
        return LatticeState(after, load_factor, Residual(*residual), stresses, u, length)

    def correct(
        self, state: LatticeState, rows: np.ndarray, load_factor: float, count: Count
    ) -> tuple[Factor, np.ndarray, np.ndarray, LatticeState] | None:
        """Return the factors of the tangent with the stresses predicted at a state, the step (m,) [m] of the
        unknowns that they give of rows (m,) [N], these and where it leads: one compiled call, and None where
        not all is compiled."""
        u, band = state.u, self.system.band
        springs = self.assembly.at(load_factor).all_families
        if self._others or not springs.conservative or band is None:
            return None
        count()
        blocks, factors, definite, step, (after, length, _, stresses, residual) = correct(
            u,
            state.stresses or NO_STRESSES,
            rows,
            self.loads.last_dead,
            self.driving,
            load_factor,
            self._unknowns,
            springs.springs,
        )
        if definite:
            reached = LatticeState(after, load_factor, Residual(*residual), stresses, u, length)
            return banded_factor(band, factors, partial(self.system.matrix, blocks)), step, rows, reached
        factor = self.system.factor(blocks, count)
        step = factor.solve(rows, SOLVED)
        return factor, step, rows, self.advance(u, step, load_factor)

    def rounding(self, u: np.ndarray) -> float:
        """Return the norm of the forces [N] that rounding of the link forces leaves."""
        assembly, largest = self.assembly, float(np.abs(u).max())
        # relative displacements are differences of u: their rounding, times the stiffness
        if assembly.coupling is None:
            links = assembly.rounding * largest * assembly.all_families.link_stiffness_norm
            return links + sum(item.rounding() for item in self.items)
        carried = assembly.all_families.link_stiffness * largest + assembly.coupling.carried()
        return float(assembly.rounding * np.linalg.norm(carried))


@njit(cache=True, nogil=True)
def advance(
    u: np.ndarray,
    step: np.ndarray,
    moved: np.ndarray,
    load: np.ndarray,
    driving: float,
    load_factor: float,
    unknowns: Unknowns,
    springs: SpringArrays,
) -> tuple[np.ndarray, float, np.ndarray, Stresses, tuple[np.ndarray, np.ndarray, float, float]]:
    """Return what `all_families.advance` does of a step (m,) [m] of the unknowns with what is `moved` (n, 3)
    [m] beside, if anything, and `unbalanced_force` there."""
    move = product(unknowns.free, step).reshape(u.shape)
    if len(moved):
        move += moved
    after, length, internal, stresses = all_families.advance(u, move, springs)
    residual = unbalanced_force(internal, load, driving, load_factor, unknowns, len(step))
    return after, length, internal, stresses, residual


@njit(cache=True, nogil=True)
def correct(
    u: np.ndarray,
    stresses: Stresses,
    rows: np.ndarray,
    load: np.ndarray,
    driving: float,
    load_factor: float,
    unknowns: Unknowns,
    springs: SpringArrays,
) -> tuple[np.ndarray, np.ndarray, bool, np.ndarray, Any]:
    """Return the tangent's blocks, factors in a band, whether they are such and give a finite step, that step
    from u and what `advance` makes of it."""
    none, band = np.empty(0), unknowns.band
    predicted = len(stresses[0]) + len(stresses[1]) > 0
    blocks = all_families.tangent(u, stresses, predicted, 1.0, 1.0, none, springs)
    factors, definite = banded.factored(blocks, band)
    step = banded.solve_unrefined(factors, band.width, band.order, rows) if definite else np.zeros(len(rows))
    definite = definite and np.isfinite(np.sum(step))
    found = advance(u, step, np.empty((0, 3)), load, driving, load_factor, unknowns, springs)
    return blocks, factors, definite, step, found


@njit(cache=True, nogil=True)
def unbalanced_force(
    internal: np.ndarray,
    load: np.ndarray,
    driving: float,
    load_factor: float,
    unknowns: Unknowns,
    n: int,
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return load_factor × load less internal force r (k, 3) [N], Tᵀ r (n,), its norm, and the norm of the
    external forces plus those of the supports' and, driving, of a natural state [N]."""
    out = np.empty_like(internal)
    total = loads = supports = 0.0
    for i in range(len(out)):
        for q in range(3):
            external = load_factor * load[i, q]
            out[i, q] = external - internal[i, q]
            loads += external**2
            if unknowns.held[i, q]:
                supports += internal[i, q] ** 2
    reduced = transposed_product(unknowns.free, out.ravel(), n)
    for value in reduced:
        total += value * value
    return out, reduced, np.sqrt(total), np.sqrt(loads) + np.sqrt(supports) + abs(load_factor) * driving
