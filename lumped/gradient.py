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
from lumped.cell_fields import NUMBERS, STATE, CellFields
from lumped.loads import Loads
from lumped.mid_surface import MidSurface
from lumped.parameter_sides import Calibrate, Sides, both_sides
from lumped.pattern import SHARED_UP_TO
from lumped.statics.build import build_problem
from lumped.statics.problem import Problem
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.numerics.direct import DirectSolver, Factor, SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.parameters import names_of, short_name

FIELD = "cells."
FORCES = "forces"
TOGETHER = ("poisson", "thickness")
FIELD_STEP = {"strain": 1e-6, "curvature": 1e-3}  # 1 and 1/m; of others 1e-5 of the largest


Values = Mapping[str, np.ndarray]


class Equilibrium:
    """Derivatives at a stable equilibrium u (n, 3) [m] of a scene's lattice, made at u = 0. values: of fields
    over the cells and forces, by name, in place of the scene's own. calibrate: finds the springs of a changed
    scene; by default the calibration's method without options."""

    _last: ClassVar[list[tuple[Any, Equilibrium]]] = []
    values: Values = MappingProxyType({})

    def __init__(self, scene: Scene, calibration: Calibration, calibrate: Calibrate | None = None):
        self.scene, self.calibration, self.calibrate = scene, calibration, calibrate
        self.problem = self.plain = build_problem(scene, calibration)
        self.cells, self.u = CellFields(scene, calibration, self.plain.assembly), 0.0 * self.plain.loads.dead
        self.constants, self._sides = calibration.constants.names(), dict[str, Sides]()
        self._parts = dict(vars(self))

    @classmethod
    def of(
        cls,
        scene: Scene,
        calibration: Calibration,
        u: np.ndarray | None = None,
        calibrate: Calibrate | None = None,
    ) -> Equilibrium:
        """Return the derivatives at u of a scene's lattice with the springs of a calibration; a small lattice
        that is equal to the last is not made again."""
        springs = calibration.springs, calibration.method, calibration.grading, calibration.masses
        key = calibrate, scene, calibration.grid, springs, id(calibration.cells)
        found = next((found for last, found in cls._last if last == key), None)
        if found is None:
            found = cls(scene, calibration, calibrate)
            if found.plain.assembly.lattice.mass_count <= SHARED_UP_TO:
                cls._last = [(key, found)]
        return found if u is None else found.at(u)

    def at(self, u: np.ndarray, values: Values = MappingProxyType({})) -> Equilibrium:
        """Return the derivatives at another equilibrium, with values of its own."""
        other = object.__new__(type(self))
        vars(other).update(self._parts, _parts=self._parts, u=u, values=values)
        if values:
            other.problem = other.with_values({})
        return other

    def sides(self, name: str) -> Sides:
        """Return `both_sides` of a parameter, made once; of ν and h together, as one pass finds all four."""
        if name not in self._sides:
            even = self.calibration.cells is None and self.scene.material.poisson is not None
            names = TOGETHER if even and name in TOGETHER else (name,)
            sides = both_sides(self.calibration, self.plain, names, self.calibrate)
            self._sides |= zip(names, sides, strict=True)
        return self._sides[name]

    def scaled_by(self, name: str) -> bool:
        """Return whether a parameter is E or ρ of all cells in proportion, and of nothing else."""
        scene = self.scene
        if name not in ("young", "density") or scene.layers or scene.obstacles:
            return False
        if not getattr(scene.material, name) or any(getattr(patch, name) for patch in scene.patches):
            return False
        pulled = scene.natural is not None and scene.natural.pretension is not None
        return name == "density" or (self.calibration.method.startswith("consistent") and not pulled)

    @property
    def fields(self) -> dict[str, np.ndarray]:
        """The fields over the cells that are not the scene's own."""
        return _fields(self.values)

    def with_values(self, values: Values) -> Problem:
        """Return the problem with more values."""
        plain, assembly, both = self.plain, self.plain.assembly, {**self.values, **values}
        if fields := _fields(both):
            assembly = self.cells.assembly_of(fields)
        loads = plain.loads
        if assembly.cells is not plain.assembly.cells:
            loads = Loads(plain.scene, assembly)
        if FORCES in both:
            loads = copy(loads)
            loads.last_dead = loads.last_dead + both[FORCES]
        return Problem(plain.scene, assembly, plain.constraints, loads, plain.contacts)

    @cached_property
    def _factor(self) -> Factor:
        try:
            with one_blas_thread():  # that of the path's end may be older
                found = self.problem.system.factor(self.problem.tangent(self.u, 1.0))
        except SingularMatrixError as error:
            raise NoEquilibrium(f"lumped: no derivatives, a singular tangent: {error}") from None
        if self.problem.descends and found.negative > 0:
            raise NoEquilibrium("lumped: no derivatives, an unstable equilibrium")
        return found

    @cached_property
    def _transposed(self) -> Factor:
        if self.problem.symmetric:
            return self._factor
        matrix = self.problem.system.matrix(self.problem.tangent(self.u, 1.0))
        return DirectSolver(symmetric=False).factor(sp.csc_array(matrix.T))

    def names(self) -> list[str]:
        """Return the names of all derivatives."""
        fields = [name for name in NUMBERS if self.cells.isotropic or name != "poisson"]
        return [FORCES, *(FIELD + name for name in (*fields, *STATE)), *names_of(self.scene)]

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

    def moved_at(self, points: np.ndarray, name: str) -> np.ndarray:
        """Return the displacement's derivative (p, 3) at plan points (p, 2) by a parameter."""
        return self.surface(points)[1].of(self.pushforward({name: 1.0}))

    def surface(self, points: np.ndarray) -> tuple[np.ndarray, MidSurface]:
        """Return the displacement (p, 3) [m] at plan points (p, 2), and the map of its changes."""
        return self.problem.middle(self.u, points)

    def rates(self, name: str, change: Any = 1.0) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return ∂R/∂θ (m,) [N], and the rates of the displacement (n, 3) [m] and of the unbalanced force
        (n, 3) [N] at unknowns that stay as at u, times a change of a parameter."""
        if name == FORCES:
            return self.problem.reduce(force := np.asarray(change)), np.zeros_like(self.u), force
        if name.startswith(FIELD):
            base, way = self.field(name), np.asarray(change, dtype=float)
            usual = 1e-5 * np.abs(base).max() or 1e-5
            step = FIELD_STEP.get(name.removeprefix(FIELD), usual) / (np.abs(way).max() or 1.0)
            low, high = (self.with_values({name: base + h * way}) for h in (-step, step))
            change, over = 1.0, 2.0 * step
        else:
            pairs, over = self.sides(name)
            low, high = (
                Equilibrium(side.scene, springs).at(self.u, self.values).problem if self.values else side
                for side, springs in pairs
            )
        scale = change / over
        if low.assembly is high.assembly and low.constraints is high.constraints and not low.contacts:
            force = scale * (high.loads.force(self.u) - low.loads.force(self.u))
            return self.problem.reduce(force), np.zeros_like(self.u), force
        unknowns, found = self.problem.constraints.nearest(self.u - self.problem.prescribed(1.0)), []
        for side in (low, high):
            placed = side.expand(unknowns) + side.prescribed(1.0)
            left = side.residual(placed, 1.0)
            found.append((left.reduced, placed, left.force))
        rows, moved, force = (scale * (up - down) for down, up in zip(*found, strict=True))
        return rows, moved, force

    @cached_property
    def complete(self) -> Assembly:
        """The lattice with springs of all kinds."""
        return self.cells.complete(self.fields, self.problem.assembly)

    def field(self, name: str) -> np.ndarray:
        """Return a field over the cells as it is."""
        known = [FIELD + one for one in (*NUMBERS, *STATE)]
        if name not in known:
            raise BadInput(f"{name}: choose from {', '.join(known)}")
        return np.asarray(self.values.get(name, self.cells.base[name.removeprefix(FIELD)]))


def _fields(values: Values) -> dict[str, np.ndarray]:
    return {name.removeprefix(FIELD): of for name, of in values.items() if name.startswith(FIELD)}


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
        return self._of.cells.by_state(self._of.fields, self._of.complete, self._by_constants)

    def __getitem__(self, name: str) -> Any:
        of, name = self._of, short_name(name)
        if name == FORCES:
            return self.by_forces
        if name.startswith(FIELD):
            of.field(name)
            if (field := name.removeprefix(FIELD)) in STATE:
                return self._by_state[field]
            return of.cells.by_number(field, of.fields, of.complete, self._by_constants, self.by_forces)
        field = FIELD + name
        if of.scaled_by(name) and field not in of.values:
            value = getattr(of.plain.scene.material, name)
            return float(np.sum(self[field] * of.field(field)) / value)
        with one_blas_thread():
            rows, moved, _ = of.rates(name)
        return float(self._adjoint @ rows + np.sum(self._by * moved))

    def at_rest(self) -> Gradient:
        """Return the derivatives of J by the free unknowns alone, where supports do not move."""
        return Gradient(self._of, np.zeros_like(self._by), self._adjoint)

    def __iter__(self) -> Iterator[str]:
        return iter(self._of.names())

    def __len__(self) -> int:
        return len(self._of.names())
