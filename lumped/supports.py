"""Supports as linear constraints on the masses: u = T q + g(λ), q the free unknowns.

clamped  every layer of the edge's row held, on the director of the clamp
hinged   the mean of the layers held: the last layer is minus the sum of the others; with the twist held
         every layer's component along the edge
held     the mean of the layers held in the named components
curved   every layer held on the director of the rod
symmetric  the component across the edge held, in every layer

The places of bent and tilted edges at a load factor λ are defined by the scene (`scenes.meaning.kinematics`).
"""

import math
from collections.abc import Callable
from copy import copy
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Self

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from lumped.actuators import Coupling
from lumped.coverage import Reach, held_columns, reached_parts
from lumped.lattice import Lattice
from lumped.pattern import SHARED_UP_TO, MassPattern
from sheetbench.numerics.cache import cached, frozen
from sheetbench.numerics.reduced_system import ReducedSystem, reduced
from sheetbench.numerics.sparse_products import Rows, csr_arrays, product, transposed_product
from sheetbench.scenes import Scene, Sheet, Support, held_axes, tilt_axes
from sheetbench.scenes.meaning.kinematics import TurnedEdge, bent_or_tilted, shifts
from sheetbench.scenes.objects.supports import named

PLACES = {"motion": None, "tilt": 0.0, "curvature": 0.0}  # keys of supports that move masses and hold none


@dataclass(frozen=True, eq=False)
class Constraints:
    """Constraints of supports and actuators. transform: (3n, m) sparse, q → u; lattice: of the masses;
    driven: bent rods and tilted clamps; shift: (n, 3) [m] final displacement by supports that move; holders:
    columns of masses (m, layers) and axes held, by the support's name; held: (n, 3) bool, components that a
    support acts on; fixed: (n, 3) bool, held components that do not depend on q."""

    transform: sp.csr_array
    lattice: Lattice
    driven: list[TurnedEdge]
    shift: np.ndarray
    holders: dict[str, tuple[np.ndarray, tuple[int, ...]]]
    held: np.ndarray
    fixed: np.ndarray
    coupling: Coupling | None = None
    _reduced: dict[tuple[MassPattern, bool], ReducedSystem] = field(default_factory=dict)

    def on(self, lattice: Lattice) -> Self:
        """Return the constraints for a lattice with an equal plan."""
        return self if lattice is self.lattice else self.with_shared_arrays(lattice=lattice)

    def with_shared_arrays(self, **parts: Any) -> Self:
        """Return constraints with an equal transform, whose arrays are shared."""
        arrays, other = self.transform_arrays, copy(self)
        vars(other).update(parts, transform_arrays=arrays)
        return other

    def turned(self, load_factor: float) -> np.ndarray:
        """Return the part of g (n, 3) [m] that bent rods and tilted clamps prescribe."""
        g = np.zeros_like(self.shift)
        for edge in self.driven:
            masses = self.holders[edge.edge][0].ravel()
            rest = self.lattice.positions[masses]
            g[masses] = edge.displaced(rest[:, :2], load_factor).lifted(rest[:, 2])
        if self.coupling is not None:
            self.coupling.apply_held_corners(g)
        return g

    def prescribed(self, load_factor: float) -> np.ndarray:
        """Return g (n, 3) [m] of statics, the last values of supports' motions included."""
        return self.turned(load_factor) + load_factor * self.shift

    @cached_property
    def transform_arrays(self) -> Rows:
        """The arrays of the transform for compiled loops."""
        return csr_arrays(self.transform)

    def nearest(self, u: np.ndarray) -> np.ndarray:
        """Return the unknowns (m,) whose T q is closest to u (n, 3): (TᵀT)⁻¹ Tᵀ u."""
        rows = transposed_product(self.transform_arrays, u.ravel(), self.transform.shape[1])
        return self._normal_solve(rows)

    @cached_property
    def _normal_solve(self) -> Callable[[np.ndarray], np.ndarray]:
        """The solver of TᵀT q = b; TᵀT is diagonal up to two layers without bindings."""
        normal = sp.csc_array(self.transform.T @ self.transform)
        diagonal = normal.diagonal()
        if normal.nnz == len(diagonal):
            return lambda b: b / diagonal
        return splu(normal).solve

    def reduced(self, pattern: MassPattern, symmetric: bool) -> ReducedSystem:
        """Return the system of the free unknowns, without multipliers, over a pattern, from a cache."""
        system = self._reduced.get((pattern, symmetric))
        if system is None:
            system = self._reduced[pattern, symmetric] = reduced(pattern, self.transform, symmetric)
        return system

    def reactions(self, residual: np.ndarray) -> tuple[dict[str, np.ndarray], np.ndarray]:
        """Return the force (3,) [N] of each support on the sheet, by name, and of all supports on each mass,
        (n, 3) [N]. residual: internal minus external force (n, 3) [N]. A mass held by several supports counts
        equally to each; the force that holds the end of a chain acts on its corner's masses."""
        if self.coupling is not None and self.coupling.corners():
            residual = residual.copy()
            for body, end, column in self.coupling.corners():
                exerted = self.coupling.on_rows(body, residual)
                residual[column] += body.corner_force(end, exerted) / len(column)
        forces = product(self.summed, residual.ravel()).reshape(-1, 3)
        return dict(zip(self.holders, forces, strict=True)), np.where(self.held, residual, 0.0)

    @cached_property
    def summed(self) -> Rows:
        """The map of the force that holds the masses, (3 n,) [N], to the force of each support, (3 supports,)
        [N], without chains; a mass held by several supports counts equally to each."""
        holders = np.zeros(self.held.size)
        rows, columns = [np.empty(0, int)], [np.empty(0, int)]
        for number, (masses, axes) in enumerate(self.holders.values()):
            places = 3 * masses.reshape(-1, 1) + np.array(axes, int)
            holders[places] += 1.0
            rows.append(np.broadcast_to(3 * number + np.array(axes, int), places.shape).ravel())
            columns.append(places.ravel())
        row, column = np.concatenate(rows), np.concatenate(columns)
        values = self.held.ravel()[column] / holders[column]
        shape = (3 * len(self.holders), self.held.size)
        return csr_arrays(sp.csr_array(sp.coo_array((values, (row, column)), shape=shape)))


def constrain(scene: Scene, lattice: Lattice, coupling: Coupling | None = None) -> Constraints:
    """Return the constraints of a scene's supports on a lattice, and of its actuators: u of a bound mass is a
    linear map of the actuator's rows. An edge moved rigidly is held by the motion, not by supports.
    Constraints without actuators on a small lattice are cached; supports that only move, tilt or bend
    otherwise share a transform."""
    return _constrain(tuple(scene.supports), reached_parts(scene), scene.sheet, lattice, coupling)


def _size(*given: Any) -> float:
    *_, lattice, coupling = given
    return math.inf if coupling else float(lattice.mass_count)


@cached(last=16, most=SHARED_UP_TO, size=_size)
def _constrain(
    supports: tuple[Support, ...], reached: Reach, sheet: Sheet, lattice: Lattice, coupling: Coupling | None
) -> Constraints:
    places = [{key: PLACES[key] for key in PLACES if key in type(one).model_fields} for one in supports]
    still = tuple(one.model_copy(update=of) for one, of in zip(supports, places, strict=True))
    constraints = _constrain_still(still, reached, lattice, coupling)
    shift = np.zeros(constraints.held.shape)
    for moved in shifts(supports):
        masses = constraints.holders[moved.support][0]
        for axis, distance in zip(moved.axes, moved.displacement, strict=True):
            shift[masses, axis] = distance
    return constraints.with_shared_arrays(driven=bent_or_tilted(supports, sheet), shift=shift)


@cached(last=16, most=SHARED_UP_TO, size=_size)
def _constrain_still(
    supports: tuple[Support, ...], reached: Reach, lattice: Lattice, coupling: Coupling | None
) -> Constraints:
    moved = np.zeros(lattice.mass_count, dtype=bool) if coupling is None else coupling.moved
    n = lattice.mass_count if coupling is None else coupling.size
    fixed = np.zeros((n, 3), dtype=bool)
    dependent = np.zeros((n, 3), dtype=bool)  # first the last masses of columns whose mean is held
    holders: dict[str, tuple[np.ndarray, tuple[int, ...]]] = {}
    for name, support in named(supports).items():
        masses = held_columns(lattice, support, reached, name)
        masses = masses[~moved[masses[:, 0]]]
        axes = held_axes(support)
        holders[name] = (masses, axes)
        fixed[masses.reshape(-1, 1), list(tilt_axes(support))] = True
        dependent[masses[:, -1:], list(axes)] = True
    fixed[lattice.absent_masses] = True
    last, along = np.nonzero(dependent & ~fixed)
    layers, held = last[:, None] + np.arange(1 - lattice.grid[2], 1), fixed.copy()
    held[layers, along[:, None]] = True
    dependent[: lattice.mass_count][moved] = True
    bodies = coupling.bodies if coupling is not None else []
    for body in bodies:
        dependent[body.masses] = True
    ties = coupling.ties if coupling is not None else []
    for tie in ties:
        dependent[tie.rows] = True
    if coupling is not None:
        fixed[lattice.mass_count :] = held[lattice.mass_count :] = ~coupling.free
    transform = sp.csr_array(sp.eye_array(3 * n, format="csc")[:, np.flatnonzero(~(fixed | dependent))])
    maps = [_last_layers(n, 3 * layers + along[:, None])] if len(last) else []
    maps += [_link(n, tie.rows, tie.others, tie.weights) for tie in ties]
    maps += [_link(n, b.masses, b.place.start + np.arange(b.rows), b.binding) for b in bodies]
    for of_others in maps:
        transform = sp.csr_array(transform + of_others @ transform)
    transform.sort_indices()
    frozen(fixed)
    return Constraints(transform, lattice, [], np.zeros((n, 3)), holders, held, fixed, coupling)


def _last_layers(n: int, components: np.ndarray) -> sp.csr_array:
    """Return the map (3n, 3n) that makes last layers minus the sum of the others, for components (c,
    layers)."""
    others = components[:, :-1].ravel()
    entries = (np.full(len(others), -1.0), (np.repeat(components[:, -1], components.shape[1] - 1), others))
    return sp.csr_array(sp.coo_array(entries, shape=(3 * n, 3 * n)))


def _link(n: int, targets: np.ndarray, sources: np.ndarray, weights: np.ndarray) -> sp.csr_array:
    """Return the map (3n, 3n) of rows (k,) that are weights (k, s) @ other rows (s,)."""
    at, source = np.nonzero(weights)
    axes = np.arange(3)[:, None]
    rows, columns = (3 * targets[at] + axes).ravel(), (3 * sources[source] + axes).ravel()
    values = np.tile(weights[at, source], 3)
    return sp.csr_array(sp.coo_array((values, (rows, columns)), shape=(3 * n, 3 * n)))
