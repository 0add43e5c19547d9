"""A lattice under its supports and loads: residual, tangent and factors, a `Structure` of the path tracer
(`sheetbench.numerics.continuation`).

The displacement is u = T q + g(λ), equilibrium Tᵀ (λ f(u) − f_int(u)) = 0, and a step Tᵀ K T δq =
Tᵀ (λ f − f_int − K δg), δg the motion of supports and actuators still to come, K at the state's load. One
compiled call takes a step and computes the internal forces and the extrapolated stresses after it, so that a
state contains its residual. Displacements and forces are (n, 3) [m], [N].
"""

import math
from collections.abc import Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp

from lumped.actuators import Drive
from lumped.assembly import Assembly
from lumped.cell_surface import middle
from lumped.contact import Contact, Deformed
from lumped.loads import Loads
from lumped.mid_surface import MidSurface
from lumped.springs.all_families import Stresses, Survey
from lumped.statics.correction import advance, unbalanced_force
from lumped.statics.faults import inspect
from lumped.supports import Constraints
from sheetbench.numerics import banded
from sheetbench.numerics.cache import frozen
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.continuation.newton import Start
from sheetbench.numerics.continuation.path import Fault, Path
from sheetbench.numerics.continuation.structure import Correction, Structure
from sheetbench.numerics.direct import Count, Factor, iterated
from sheetbench.numerics.reduced_system import ReducedSystem, banded_factor
from sheetbench.numerics.sparse_products import product, transposed_product
from sheetbench.scenes import Scene, outside_model

NOTHING = np.empty((0, 3))
STRETCH = "largest in-plane link strain"
ITERATED = 5000  # unknowns from which a factorisation costs as much as ten solutions
LIMITS = Limits(
    tolerance=1e-11,
    refine_below=1e-5,
    steps_with_last_factors=True,
    reach_growth=1.5,
    first_reach=0.4,
    lengthen_up_to=7,
    careful_after=30,
    factorisations=2000,
    in_all=2000,
)


class Residual(NamedTuple):
    """Residual of the equilibrium equation. force: (n, 3) [N] unbalanced; reduced: (m,) its part on the free
    unknowns; norm: [N] of the reduced force; size: [N] norm of the external forces plus the supports'; moved:
    (n, 3) [m] motion of supports and actuators still to come, None without any."""

    force: np.ndarray
    reduced: np.ndarray
    norm: float
    size: float
    moved: np.ndarray | None = None


class LatticeState(NamedTuple):
    """Displacement u (n, 3) [m] at a load factor. residual: of the equilibrium equation, if computed;
    stresses: predicted by the linearisation before the last step; start: displacement before that step;
    length: [m] of the step's largest component; energies: [J] of the springs by name, if computed."""

    u: np.ndarray
    load_factor: float
    residual: Residual | None = None
    stresses: Stresses | None = None
    start: np.ndarray | None = None
    length: float = 0.0
    energies: dict[str, float] | None = None


LatticePath = Path[LatticeState, Residual]


class Problem(Structure[LatticeState, Residual]):
    """A scene's lattice under supports and loads, which grow with the load factor λ, with the solver of its
    linear systems, given by blocks (b, 3, 3).

    size: the sheet's longer side [m]; contacts: with obstacles; symmetric: whether all forces have a
    potential; descends: whether stable equilibria are minima of an energy of the free unknowns.
    """

    def __init__(
        self,
        scene: Scene,
        assembly: Assembly,
        constraints: Constraints,
        loads: Loads,
        contacts: Sequence[Contact] = (),
    ):
        self.scene, self.assembly, self.constraints, self.loads = scene, assembly, constraints, loads
        self.contacts, self.size, self.limits = contacts, max(scene.sheet.lengths), LIMITS
        self.symmetric = self.conservative = assembly.conservative and loads.conservative
        self.prestrained, driving = assembly.natural is not None, 0.0
        if self.prestrained:  # often the only load
            driving = float(np.linalg.norm(assembly.force(np.zeros_like(loads.dead))[1]))
        coupling, transform = assembly.coupling, constraints.transform
        self.multipliers = 0 if coupling is None else coupling.multipliers
        self.descends = self.symmetric and self.multipliers == 0
        self._free = constraints.transform_arrays
        self._equilibrium = constraints.held, self._free, driving
        self._others = contacts or coupling is not None or loads.follow
        if coupling is None:
            self.system = constraints.reduced(assembly.pattern, self.symmetric)
        else:
            multipliers = abs(transform).T @ coupling.algebraic.ravel() > 0.0
            self.system = ReducedSystem(assembly.pattern, transform, self.symmetric, multipliers)
        self._placed = frozen(self._prescribed(1.0))
        self._moves = bool(self._placed.any())
        self._iterates = self.descends and self.system.unknowns > ITERATED
        self.factor = self.system.factor

    def reduce(self, force: np.ndarray) -> np.ndarray:
        """Return Tᵀ f, the force on the free unknowns."""
        reduced: np.ndarray = transposed_product(self._free, force.ravel(), self.system.unknowns)
        return reduced

    def expand(self, unknowns: np.ndarray) -> np.ndarray:
        """Return T q, a displacement (n, 3) [m]."""
        full: np.ndarray = product(self._free, np.ascontiguousarray(unknowns))
        return full.reshape(-1, 3)

    def tangent(
        self, u: np.ndarray, load_factor: float, stresses: Stresses | None = None, definite: bool = False
    ) -> np.ndarray:
        """Return the blocks of the tangent of the residual, loads included; definite: leave out parts that
        could make the springs' tangent indefinite."""
        springs, drive = self.assembly.at(load_factor).all_families, Drive(load_factor)
        if definite:
            blocks = springs.nonnegative_tangent(u)
        else:
            blocks = springs.tangent(u, stresses, extrapolated=stresses is not None)
        self.loads.add_tangent(u, load_factor, blocks)
        for one in self.contacts:
            one.add_tangent((u, drive), 1.0, blocks, definite)
        if self.assembly.coupling is not None:
            self.assembly.coupling.add_tangent(u, drive, self.assembly.coupling_slots, blocks)
        return blocks

    def prescribed(self, load_factor: float) -> np.ndarray:
        """Return the displacement (n, 3) [m] that supports and actuators prescribe, 0 of other masses."""
        return self._placed if load_factor == 1.0 else self._prescribed(load_factor)

    def _prescribed(self, load_factor: float) -> np.ndarray:
        g = self.constraints.prescribed(load_factor)
        if self.assembly.coupling is not None:
            g = g + self.assembly.coupling.prescribed_displacement(Drive(load_factor))
        return g

    def project_to_supports(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """Return the displacement closest to u (n, 3) [m] that the supports allow."""
        prescribed = self.prescribed(load_factor)
        return self.expand(self.constraints.nearest(u - prescribed)) + prescribed

    def internal(self, u: np.ndarray, load_factor: float) -> tuple[float, np.ndarray]:
        """Return elastic energy [J] and internal force, actuators included."""
        energy, force = self.assembly.at(load_factor).force(u)
        return energy + self._add_others(u, Drive(load_factor), force), force

    def _add_others(self, u: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add the internal force of actuators and obstacles; return their energy [J]."""
        energy = sum(one.add_force((u, drive), force) for one in self.contacts)
        if self.assembly.coupling is not None:
            energy += self.assembly.coupling.add_force(u, drive, force)
        return energy

    def survey(self, u: np.ndarray, load_factor: float) -> Survey:
        """Return the springs' energies and largest strain, and the energy of contact with all obstacles."""
        survey = self.assembly.at(load_factor).survey(u)
        if self.contacts:
            at, force = (u, Drive(load_factor)), np.zeros_like(u)
            survey.energies["contact"] = sum(one.add_force(at, force) for one in self.contacts)
        return survey

    def middle(self, u: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, MidSurface]:
        """Return displacements (p, 3) [m] at plan points (p, 2) of the surface that obstacles touch at u
        under full load, and the map of their changes. Raises BadInput off the sheet."""
        curved = any(one.bent and one.report((u, Drive(1.0)))[0].points for one in self.contacts)
        return middle(self.assembly.lattice, np.asarray(points, dtype=float), u, curved)

    def external(self, u: np.ndarray, load_factor: float) -> np.ndarray:
        """Return the external force λ f(u)."""
        return load_factor * self.loads.force(u)

    def potential(self, u: np.ndarray, load_factor: float) -> float:
        """Return the elastic energy less the work of the loads [J] of a conservative problem."""
        energy, _ = self.internal(u, load_factor)
        return energy - load_factor * self.loads.work(u)

    def residual(self, u: np.ndarray, load_factor: float) -> Residual:
        """Return the residual at u."""
        others = self.assembly.coupling is not None or self.prestrained or self.contacts
        flat = not (others or u.any())  # springs are at rest
        internal = np.zeros(u.shape) if flat else self.internal(u, load_factor)[1]
        return self._residual(internal, u, load_factor)

    def _residual(self, internal: np.ndarray, u: np.ndarray, load_factor: float) -> Residual:
        load, n = self.loads.force(u), self.system.unknowns
        return Residual(*unbalanced_force(internal, load, load_factor, *self._equilibrium, n))

    def rest(self) -> LatticeState:
        return LatticeState(np.zeros(self.loads.dead.shape), 0.0)

    def start(self, u: np.ndarray) -> Start[LatticeState]:
        """Return the start at full load from a displacement (n, 3) [m]."""
        projected = LatticeState(self.project_to_supports(u, 1.0), 1.0)
        state = self.advance(projected, None, 1.0, np.zeros(self.system.unknowns))
        return Start(state, 1.0, self.length(self.rest(), state), 0.0)

    def forces(self, state: LatticeState, load_factor: float) -> Residual:
        computed = state.residual if state.load_factor == load_factor else None
        residual = computed or self.residual(state.u, load_factor)
        moved = self._support_motion(state, load_factor)
        return residual if moved is None else residual._replace(moved=moved)

    def _support_motion(self, state: LatticeState, load_factor: float) -> np.ndarray | None:
        """Return the motion (n, 3) [m] of supports and actuators to another load factor, None without any."""
        if not self._moves or state.load_factor == load_factor:
            return None
        return self.prescribed(load_factor) - self.prescribed(state.load_factor)

    def imbalance(self, state: LatticeState, forces: Residual) -> float:
        return forces.norm

    def imbalance_floor(self, state: LatticeState) -> float:
        assembly, largest = self.assembly, float(np.abs(state.u).max())
        # relative displacements are differences of u: their rounding, times the stiffness
        carried = assembly.all_families.link_stiffness_norm * largest
        if assembly.coupling is not None:
            by_row = assembly.all_families.link_stiffness * largest + assembly.coupling.carried()
            carried = float(np.linalg.norm(by_row))
        at = self.configuration(state, state.load_factor)
        return assembly.rounding * carried + sum(one.rounding(at) for one in self.contacts)

    def gap(self, state: LatticeState, load_factor: float) -> float:
        moved, lattice = self._support_motion(state, load_factor), self.assembly.lattice
        if moved is None:
            return 0.0
        layers = moved[lattice.columns()]  # a support that turns moves the sheet's end
        turn = float(np.abs(layers[..., -1, :] - layers[..., 0, :]).max()) / lattice.spacing[2]
        return max(float(np.abs(moved).max() / self.size), turn)

    def rows(self, state: LatticeState, forces: Residual, load_factor: float) -> np.ndarray | None:
        return forces.reduced if forces.moved is None else None

    def linearised(
        self, state: LatticeState, forces: Residual, load_factor: float, mixed: bool = True
    ) -> tuple[np.ndarray, np.ndarray]:
        stresses, rows = state.stresses if mixed else None, forces.reduced
        blocks = self.tangent(state.u, state.load_factor, stresses)
        if forces.moved is not None:
            rows = rows - self.reduce(self.system.apply(blocks, forces.moved))
        return blocks, rows

    def advance(
        self, state: LatticeState, forces: Residual | None, load_factor: float, step: np.ndarray
    ) -> LatticeState:
        springs, moved = self.assembly.at(load_factor).all_families, forces and forces.moved
        moved = NOTHING if moved is None else moved
        given = springs.springs, self.loads.last_dead, load_factor, *self._equilibrium
        after, length, stresses, internal, unbalanced = advance(state.u, step, moved, *given)
        residual = Residual(*unbalanced)
        if self._others or not springs.conservative:
            internal = springs.add_other_forces(after, internal)
            self._add_others(after, Drive(load_factor), internal)
            residual = self._residual(internal, after, load_factor)
        return LatticeState(after, load_factor, residual, stresses, state.u, length)

    def correct(
        self, state: LatticeState, forces: Residual, load_factor: float, count: Count
    ) -> Correction | None:
        rows, band = forces.reduced, self.system.band
        springs = self.assembly.at(load_factor).all_families
        others = self._others or not springs.conservative or forces.moved is not None
        if others or band is None or self._iterates:
            return None
        count()
        blocks = springs.tangent(state.u, state.stresses, extrapolated=state.stresses is not None)
        factors, definite = banded.factored(blocks, band)
        step = banded.solve_unrefined(factors, band.width, band.order, rows) if definite else rows
        if definite and math.isfinite(step @ step):
            factor = banded_factor(band, factors, partial(self.system.matrix, blocks))
            return Correction(factor, step, rows, self.advance(state, forces, load_factor, step))
        return self.solved(state, forces, load_factor, self.system.factor(blocks, count), rows)

    def with_stresses(self, state: LatticeState, of: LatticeState) -> LatticeState:
        return state._replace(stresses=of.stresses)

    def sparse(self, matrix: np.ndarray) -> sp.csc_array:
        return self.system.matrix(matrix)

    def length(self, start: LatticeState, end: LatticeState) -> float:
        one_step = end.start is start.u
        return (end.length if one_step else float(np.abs(end.u - start.u).max())) / self.size

    def has_meaning(self, state: LatticeState) -> bool:
        links = self.assembly.at(state.load_factor).links
        return not outside_model(self.scene, links.largest_strain(state.u), STRETCH)

    def inspect(self, path: LatticePath) -> Fault | None:
        """Return the fault of the path's last equilibrium, if it is invalid."""
        return inspect(self.assembly.at(path.state.load_factor), path.state.u[None])[1]

    def loading(self) -> float:
        return float(np.abs(self.external(np.zeros_like(self.loads.dead), 1.0)).sum())

    def configuration(self, state: LatticeState, load_factor: float) -> Deformed:
        return state.u, Drive(load_factor)

    def restarted(
        self, state: LatticeState, before: LatticeState, beyond: float
    ) -> tuple[LatticeState, float]:
        u = state.u + beyond * (state.u - before.u)
        return state._replace(u=u, residual=None), self.internal(u, 1.0)[0]

    def iterated(self, blocks: np.ndarray, near: Factor, rows: np.ndarray) -> np.ndarray | None:
        return iterated(self.system.matrix(blocks), near, rows) if self._iterates else None
