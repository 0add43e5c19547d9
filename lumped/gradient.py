"""Derivatives of an equilibrium by the numbers of its scene, from one solve with the tangent's factors.

At equilibrium the residual R(q, θ) = Tᵀ (f − f_int)(T q + g(θ), θ) is zero for every θ, so that with the
tangent K = −∂R/∂q at hand dq/dθ = K⁻¹ ∂R/∂θ and du/dθ = T dq/dθ + dg/dθ, one solve a parameter
(`pushforward`); and of a number J(u) with λ = T K⁻ᵀ Tᵀ ∂J/∂u, whatever the parameters,

    dJ/dθ = λ · ∂(f − f_int)/∂θ + ∂J/∂u · dg/dθ                                          (`pullback`).

The derivatives by fields over the cells (`lumped.cell_fields`) are sums of λ · ∂f_int/∂(constants of the
springs), one loop with each law's own derivatives; by E and ρ of an even sheet they are the fields' sums.
Other parameters of the scene have ∂R/∂θ as a central difference of the residual at fixed q
(`lumped.parameter_sides`), of the loads where nothing else changes. Masses that touch an obstacle go on
touching it.

Names: the parameters of `scenes.parameters` (young, patchN.young, loadN.force.z, natural.kxx, …;
"material.young" and "sheet.thickness" too); the spring constants of `scenes.SpringSet` (axial_x, axial_y, …
in each direction), layer_distance; "cells.young", … over all cells; "forces" (n, 3) [N] on the masses.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from copy import copy
from functools import cached_property
from types import MappingProxyType
from typing import Any, ClassVar

import numpy as np
import scipy.sparse as sp

from lumped.assembly import Assembly
from lumped.calibration import Calibration
from lumped.cell_fields import CURVATURE, FIELD, POISSON, STATE, STRAIN, CellFields, Values
from lumped.loads import Loads
from lumped.mid_surface import MidSurface
from lumped.parameter_sides import both_sides
from lumped.pattern import SHARED_UP_TO
from lumped.statics.build import build_problem
from lumped.statics.problem import Problem
from sheetbench.errors import NoEquilibrium
from sheetbench.numerics.direct import DirectSolver, Factor, SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.parameters import names_of, short_name

FORCES = "forces"
TOGETHER = ("poisson", "thickness")
FIELD_STEP = {STRAIN: 1e-6, CURVATURE: 1e-3}  # 1 and 1/m; of others 1e-5 of the largest
ITS_OWN: Values = MappingProxyType({})
Sides = tuple["list[Base]", float]


class Base:
    """A scene's lattice and its calibrated springs, shared by equilibria at any parameter values. previous:
    the lattice of a scene with an equal plan and grid."""

    _last: ClassVar[tuple[Any, Base] | None] = None

    def __init__(self, scene: Scene, calibration: Calibration, previous: Problem | None = None):
        self.scene, self.calibration = scene, calibration
        self.problem = build_problem(scene, calibration, previous=previous)
        self.cells = CellFields(scene, calibration, self.problem.assembly)
        self._sides = dict[str, Sides]()

    @classmethod
    def of(cls, scene: Scene, calibration: Calibration) -> Base:
        """Return the lattice with the springs of a calibration; a small lattice is reused from the last
        call."""
        key = scene, calibration
        if cls._last is not None and cls._last[0] == key:
            return cls._last[1]
        found = cls(*key)
        if found.problem.assembly.lattice.mass_count <= SHARED_UP_TO:
            cls._last = key, found
        return found

    def sides(self, name: str) -> Sides:
        """Return the lattices a little below and above a parameter's value, and the distance between both
        values; each is built once, for ν and h in one pass."""
        if name not in self._sides:
            even = self.calibration.cells is None and self.scene.material.poisson is not None
            names = TOGETHER if even and name in TOGETHER else (name,)
            each = both_sides(self.scene, self.calibration, names)
            for one, (ends, over) in zip(names, each, strict=True):
                self._sides[one] = [Base(*end, previous=self.problem) for end in ends], over
        return self._sides[name]

    def scaled_by(self, name: str) -> bool:
        """Return whether a parameter scales E or ρ of all cells and nothing else."""
        scene = self.scene
        if name not in ("young", "density") or scene.layers or scene.obstacles:
            return False
        if not getattr(scene.material, name) or any(getattr(patch, name) for patch in scene.patches):
            return False
        pulled = scene.natural is not None and scene.natural.pretension is not None
        return name == "density" or (self.calibration.method.startswith("consistent") and not pulled)

    def with_values(self, values: Values) -> Problem:
        """Return the problem with fields over the cells and forces."""
        if not values:
            return self.problem
        problem, assembly, loads = self.problem, self.problem.assembly, self.problem.loads
        if values.keys() - {FORCES}:
            assembly = self.cells.assembly_of(values)
        if assembly.cells is not problem.assembly.cells:
            loads = Loads(problem.scene, assembly)
        if FORCES in values:
            loads = copy(loads)
            loads.last_dead = loads.last_dead + values[FORCES]
        return Problem(problem.scene, assembly, problem.constraints, loads, problem.contacts)

    def names(self) -> list[str]:
        """Return the names of all derivatives."""
        fields = (name for name in self.cells.base if self.cells.isotropic or name != POISSON)
        return [FORCES, *fields, *names_of(self.scene)]


class Equilibrium:
    """Derivatives at a stable equilibrium u (n, 3) [m] of a lattice. values: of fields over the cells and
    forces, by name, in place of the scene's own; problem: with them, if it is known; share: load factor."""

    def __init__(
        self,
        base: Base,
        u: np.ndarray,
        values: Values = ITS_OWN,
        problem: Problem | None = None,
        share: float = 1.0,
    ):
        self.base, self.u, self.values, self.share = base, u, values, share
        self.problem = problem or base.with_values(values)
        self.rates_of_cells = base.cells.rates_at(values)

    @classmethod
    def of(cls, scene: Scene, calibration: Calibration, u: np.ndarray) -> Equilibrium:
        """Return the derivatives at u of a scene's lattice with the springs of a calibration (`Base.of`)."""
        return cls(Base.of(scene, calibration), u)

    @cached_property
    def _factor(self) -> Factor:
        try:
            with one_blas_thread():  # that of the path's end may be older
                found = self.problem.system.factor(self.problem.tangent(self.u, self.share))
        except SingularMatrixError as error:
            raise NoEquilibrium(f"lumped: no derivatives, a singular tangent: {error}") from None
        if self.problem.descends and found.negative > 0:
            raise NoEquilibrium("lumped: no derivatives, an unstable equilibrium")
        return found

    @cached_property
    def _transposed(self) -> Factor:
        if self.problem.symmetric:
            return self._factor
        matrix = self.problem.system.matrix(self.problem.tangent(self.u, self.share))
        return DirectSolver(symmetric=False).factor(sp.csc_array(matrix.T))

    def pullback(self, by_displacement: np.ndarray) -> Gradient:
        """Return the derivatives of J by name; by_displacement: ∂J/∂u (n, 3) of the masses."""
        with one_blas_thread():
            adjoint = self._transposed.solve(self.problem.reduce(by_displacement))
        return Gradient(self, by_displacement, adjoint)

    def at_points(self, points: np.ndarray, weights: np.ndarray) -> Gradient:
        """Return the derivatives of J by name; weights: ∂J/∂u (p, 3) at plan points (p, 2)."""
        return self.pullback(self.surface(points)[1].shared(weights, len(self.u)))

    def pushforward(self, changes: Mapping[str, Any]) -> np.ndarray:
        """Return the change (n, 3) [m] of the displacement by changes of parameters, to first order."""
        rows, moved = np.zeros(self.problem.system.unknowns), np.zeros_like(self.u)
        for name, change in changes.items():
            rate, placed, _ = self.rates(name, change)
            rows, moved = rows + rate, moved + placed
        with one_blas_thread():
            return self.problem.expand(self._factor.solve(rows)) + moved

    def displacement_rate(self, points: np.ndarray, name: str) -> np.ndarray:
        """Return the displacement's derivative (p, 3) at plan points (p, 2) by a parameter."""
        return self.surface(points)[1].of(self.pushforward({name: 1.0}))

    def surface(self, points: np.ndarray) -> tuple[np.ndarray, MidSurface]:
        """Return the displacement (p, 3) [m] at plan points (p, 2), and the map of its changes."""
        return self.problem.middle(self.u, points)

    def rates(self, name: str, change: Any = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return ∂R/∂θ (m,) [N], and the rates of the displacement (n, 3) [m] and of the unbalanced force (n,
        3) [N] at fixed unknowns, times a change of a parameter."""
        if name == FORCES:
            return self.problem.reduce(force := np.asarray(change)), np.zeros_like(self.u), force
        if name.startswith(FIELD):
            field, way = self.base.cells.value(name, self.values), np.asarray(change, dtype=float)
            step = FIELD_STEP.get(name, 1e-5 * np.abs(field).max() or 1e-5) / (np.abs(way).max() or 1.0)
            ends = ({**self.values, name: field + end * way} for end in (-step, step))
            (low, high), scale = map(self.base.with_values, ends), 0.5 / step
        else:
            sides, over = self.base.sides(name)
            (low, high), scale = (side.with_values(self.values) for side in sides), change / over
        if low.assembly is high.assembly and low.constraints is high.constraints and not low.contacts:
            force = self.share * scale * (high.loads.force(self.u) - low.loads.force(self.u))
            return self.problem.reduce(force), np.zeros_like(self.u), force
        share, found = self.share, []
        unknowns = self.problem.constraints.nearest(self.u - self.problem.prescribed(share))
        here = self.problem.expand(unknowns) + self.problem.prescribed(share)  # u, but for a flat sheet
        for side in (low, high):
            placed = self.u + (side.expand(unknowns) + side.prescribed(share) - here)
            left = side.residual(placed, share)
            found.append((left.reduced, placed, left.force))
        rows, moved, force = (scale * (up - down) for down, up in zip(*found, strict=True))
        return rows, moved, force

    @cached_property
    def complete(self) -> Assembly:
        """The lattice with springs of all kinds."""
        assembly = self.problem.assembly
        return assembly if len(assembly.springs[2]) else self.base.cells.assembly_of(self.values, True)


class Gradient(Mapping[str, Any]):
    """Derivatives of a number J by name, each computed on access; adjoint: K⁻ᵀ Tᵀ ∂J/∂u, (m,)."""

    def __init__(self, of: Equilibrium, by_displacement: np.ndarray, adjoint: np.ndarray):
        self._of, self._by, self._adjoint = of, by_displacement, adjoint

    @cached_property
    def by_forces(self) -> np.ndarray:
        """λ (n, 3), the derivatives by forces on the masses."""
        return self._of.problem.expand(self._adjoint)

    @cached_property
    def _by_constants(self) -> list[np.ndarray]:
        return self._of.complete.all_families.powers_by_constants(self._of.u, self.by_forces)

    @cached_property
    def _by_state(self) -> dict[str, np.ndarray]:
        of = self._of
        return of.base.cells.by_state(of.values, of.complete, self._by_constants)

    def __getitem__(self, name: str) -> Any:
        of, base, name = self._of, self._of.base, short_name(name)
        if name == FORCES:
            return self.by_forces
        if name in STATE:
            return self._by_state[name]
        if name.startswith(FIELD):
            at = of.values, of.complete, self._by_constants, self.by_forces, of.rates_of_cells
            return base.cells.by_number(name, *at)
        if base.scaled_by(name) and (field := FIELD + name) not in of.values:
            share = base.cells.base[field] / getattr(base.scene.material, name)
            return float(np.sum(self[field] * share))
        with one_blas_thread():
            rows, moved, _ = of.rates(name)
        return float(self._adjoint @ rows + np.sum(self._by * moved))

    def at_rest(self) -> Gradient:
        """Return the derivatives of J by the free unknowns alone, where supports do not move."""
        return Gradient(self._of, np.zeros_like(self._by), self._adjoint)

    def __iter__(self) -> Iterator[str]:
        return iter(self._of.base.names())

    def __len__(self) -> int:
        return len(self._of.base.names())
