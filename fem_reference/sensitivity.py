"""Derivatives of a plate's or shell's equilibrium by the numbers of its scene, adjoint and forward.

An equilibrium has Zᵀ R(q, θ) = 0, with prescribed displacements δ(θ) (`discrete.sheet`). A function J of the
displacement has, with one solution for all θ,

    (Zᵀ K Z)ᵀ μ = −Zᵀ ∂J/∂q,   λ = Z μ,     dJ/dθ = λ·∂R/∂θ + (∂J/∂q + Kᵀ λ)·∂δ/∂θ,

and a change of θ moves the sheet by

    (Zᵀ K Z) x = −Zᵀ (∂R/∂θ + K ∂δ/∂θ),     du = Z x + ∂δ/∂θ.

For the sheet's constants λ·∂R/∂θ is a power at the Gauss points with exact derivatives (`surface.constants`);
its sum over an element is the derivative by a field with one value an element, and a scene's own follow by
the chain rule. Other numbers change loads, supports, chains and natural strains, made anew on both sides,
most of them linear. Points that touch an obstacle go on touching it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from fem_reference.discrete import tangent_planes
from fem_reference.discrete.contact import ObstacleContact
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.element import weighed
from fem_reference.shell.hyperelastic import HyperelasticElement
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.constants import LAW, STRAIN, Values, by_values, constants_with, values_of
from fem_reference.surface.location import shares
from fem_reference.surface.materials import stretched
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.numerics.direct import Factor, SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.natural_state import natural_at
from sheetbench.scenes.meaning.parameters import names_of, parameter, put, short_name

STEP = 1e-4  # of a parameter, or of 1 where it is zero
FIELD, STATE = "elements.", ("strain", "curvature")
UNITS = np.array([[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [0.0, 1.0]], [[0.0, 1.0], [1.0, 0.0]]])
PLACED = re.compile(r"(tilt|curvature)_|(gravity|natural|temperature|load|mass|support|actuator|obstacle)")


class SheetSensitivity:
    """The derivatives of a sheet's stable equilibrium q (N,) at a load factor. centres: of the elements,
    (m, 2) [m], in the order of fields."""

    def __init__(self, sheet: DiscreteShell, q: np.ndarray, at: float = 1.0):
        self.sheet, self.shape, self.scene = sheet, sheet.shape(q, at), sheet.scene
        self.centres = sheet.plan.nodes[sheet.plan.elements[:, 8]]

    @cached_property
    def factor(self) -> Factor:
        """Factors of Zᵀ K Z. Raises NoEquilibrium where it is singular or, of dead loads, not stable."""
        return self._factor()

    @cached_property
    def _transposed(self) -> Factor:
        return self.factor if self.sheet.symmetric else self._factor(transposed=True)

    def _factor(self, transposed: bool = False) -> Factor:
        matrix = self.sheet.tangent(self.shape, self.sheet.forces(self.shape), 0.0, 0.0)
        try:
            found = self.sheet.solver().factor(matrix.T.tocsr() if transposed else matrix)
        except SingularMatrixError as error:
            raise NoEquilibrium(f"{self.sheet.model}: no derivatives, a singular tangent: {error}") from None
        if found.negative > 0 or found.zero > 0:
            raise NoEquilibrium(f"{self.sheet.model}: no derivatives, an unstable equilibrium")
        return found

    @cached_property
    def values(self) -> Values:
        """The sheet's constants at the Gauss points."""
        return self.values_of(self.scene)

    def values_of(self, scene: Scene) -> Values:
        """Return the constants of a scene's sheet at the Gauss points."""
        return values_of(scene, self.sheet.plan.corners, not self.sheet.linear)

    @cached_property
    def fields(self) -> list[str]:
        """The names of derivatives that have a value an element."""
        others = (LAW, *STRAIN, ".low", ".high")
        own = [name for name in self.values if not name.endswith(others)]
        natural = () if isinstance(self.sheet.element, HyperelasticElement) else STATE
        return [FIELD + name for name in (*own, *natural)]

    def names(self) -> list[str]:
        """Return the names of all derivatives: of fields, and of `scenes.parameters`."""
        return [*self.fields, *names_of(self.scene)]

    def at_points(self, points: np.ndarray, weights: np.ndarray) -> SheetGradient:
        """Return the derivatives of a J with ∂J/∂u (p, 3) at plan points (p, 2)."""
        plan, mesh = np.asarray(points, dtype=float), self.sheet.plan.mesh
        (element, value), out = shares(mesh, plan), np.zeros((self.sheet.nodes, 3))
        np.add.at(out, self.sheet.plan.elements[element], value[:, :, None] * np.asarray(weights)[:, None])
        if not self.sheet.touched_without_kinks(self.shape):
            return self.pullback(out)
        on, _, by = tangent_planes.change_at(mesh, self.shape.vectors, plan)
        return self.pullback(out, self.sheet.of_surface(on, np.einsum("pijc,pi->pjc", by, weights)))

    def pullback(self, by_displacement: np.ndarray, more: np.ndarray | float = 0.0) -> SheetGradient:
        """Return the derivatives of a J with ∂J/∂u (n, 3) at the nodes, and `more` ∂J/∂q (N,)."""
        sheet, given = self.sheet, np.zeros(self.sheet.size) + more
        sheet.displacement(given)[:] += by_displacement
        with one_blas_thread():
            solved = self._transposed.solve(sheet.reduce(self.shape, given))
            moved = -sheet.expand(self.shape, solved)
            return SheetGradient(
                self.power(moved, self.values), (self, moved, given + self.product(moved, transposed=True))
            )

    def pushforward(self, changes: Mapping[str, float]) -> np.ndarray:
        """Return du (n, 3) of the nodes for changes of parameters."""
        return self.sheet.displacement(self._moved(changes))

    def _moved(self, changes: Mapping[str, float]) -> np.ndarray:
        sheet, shape, rate, placed = self.sheet, self.shape, *np.zeros((2, self.sheet.size))
        with one_blas_thread():
            for name, change in changes.items():
                both = self.rates(*self.ends(name), with_constants=True)
                rate, placed = rate + change * both[0], placed + change * both[1]
            rate += self.product(placed)
            step = sheet.expand(shape, self.factor.solve(-sheet.reduce(shape, rate)))
        return np.asarray(step + placed)

    def displacement_rate(self, points: np.ndarray, name: str) -> np.ndarray:
        """Return the displacement's derivative (p, 3) at plan points (p, 2) by a parameter."""
        return self.shape.displacement_rate(np.asarray(points, dtype=float), self._moved({name: 1.0}))

    def by_natural(self, moved: np.ndarray, name: str) -> np.ndarray:
        """Return λ·∂R/∂e0 or λ·∂R/∂k0 (m, 3) of λ (N,), xx, yy and xy, of one value an element."""
        sheet, shape, element = self.sheet, self.shape, self.sheet.element
        sites, make = sheet.natural_form()
        state = natural_at(self.scene if sheet.linear else stretched(self.scene), sites)
        now = np.zeros((2, *sites.shape, 2)) if state is None else np.array(state.at(shape.at))
        pull = weighed(shape.moduli, element.step(shape.operator, sheet.gather(moved)))
        out = np.zeros((len(sites), 3))
        for place, unit in enumerate(UNITS):
            change = np.zeros_like(now)
            change[STATE.index(name)] = shape.at * unit
            rise = 0.5 * (make(*(now + change)) - make(*(now - change)))  # quadratic
            out[:, place] = -np.sum((pull * rise).reshape(len(sites), -1), axis=1)
        if name == STATE[0] and not sheet.linear:  # of which the section is a function too
            points = self.power(moved, {**dict.fromkeys(STRAIN, 0.0), **self.values}, STRAIN)
            out += np.stack([points[one].sum(axis=1) for one in STRAIN], axis=1)
        return out

    def power(self, moved: np.ndarray, values: Values, names: Iterable[str] = ()) -> dict[str, np.ndarray]:
        """Return λ·∂R/∂c (m, 9) of λ (N,) by constants at the Gauss points, by all or by the given names."""
        sheet, shape, element = self.sheet, self.shape, self.sheet.element
        rate = element.at_points(element.step(shape.operator, sheet.gather(moved)))
        pull, turn = np.zeros((2, *element.areas.shape))  # of the weight on λ, per mass
        if self.scene.gravity is not None:
            along = shape.at * sheet.surface_change(moved) @ self.scene.gravity.last_acceleration
            pull, turn = (element.areas * (of @ AT_GAUSS[0].T) for of in (along[:, :9], along[:, 9:]))

        def of(values: Values) -> np.ndarray:
            constants, stresses = constants_with(values), element.resultants(values, shape.strain)
            power = sum((a * b).sum(axis=-1) for a, b in zip(stresses, rate, strict=True))
            return power - constants.per_area * pull - constants.moment_per_area * turn

        return by_values(of, values, names)

    def ends(self, name: str) -> tuple[tuple[Scene, Scene], float]:
        """Return the scene at both sides of a parameter's step, and the length of the step. Raises
        BadInput."""
        name = short_name(name)
        found = parameter(self.scene, name)
        step = STEP * (abs(found.value) or 1.0)
        at = (max(found.value - step, found.low), min(found.value + step, found.high))
        low, high = (put(self.scene, name, value, checked=False) for value in at)
        return (low, high), at[1] - at[0]

    def rates(
        self, ends: tuple[Scene, Scene], over: float, weight: bool = True, with_constants: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return ∂R/∂θ (N,) and ∂δ/∂θ (N,) between two scenes that differ by `over`. weight: whether with
        loads and the weight of the sheet. with_constants: whether with the elements' constants, too."""
        sheet, shape, placed = self.sheet, self.shape, np.zeros(self.sheet.size)
        low, high = (sheet.with_scene(end) for end in ends)
        forces = []
        moved = shape.change if with_constants else np.zeros_like(shape.change)  # or the natural strain alone
        for side in (low, high):
            element = side.elements_of(None, side.law)[0] if with_constants else sheet.element
            stress = element.stress(side.strain(moved, shape.at))
            force = sheet.scatter(element.forces(shape.operator, stress))
            for body in side.bodies:
                force += body.scatter(body.pull(shape.q, body.stress(shape)))
                force -= sum(body.scatter(dead) for dead, _ in side.weights) * (not weight)
            items = (one for one in side.items if weight and not isinstance(one, ObstacleContact))
            forces.append(force - sum(one.force(shape) for one in items))
        rate = (forces[1] - forces[0]) / over
        for one, before, after in zip(sheet.contacts, low.contacts, high.contacts, strict=True):
            rate -= one.rate(shape, before, after, over)
        placed[: 6 * sheet.nodes] = ((high.change(shape.at) - low.change(shape.at)) / over).ravel()
        return rate, placed

    def product(self, move: np.ndarray, transposed: bool = False) -> np.ndarray:
        """Return K δq (N,), or of the transpose, of δq (N,)."""
        sheet, shape, element = self.sheet, self.shape, self.sheet.element
        step, form = sheet.gather(move), "eicjd,eic->ejd" if transposed else "eicjd,ejd->eic"
        pull = element.forces(shape.operator, weighed(shape.moduli, element.step(shape.operator, step)))
        out = sheet.scatter(pull + element.geometric(step, shape.elastic))
        for item in () if sheet.linear else sheet.items:
            if (found := item.tangent(shape)) is not None:
                on, tangent = found
                out -= sheet.of_surface(on, np.einsum(form, tangent, sheet.surface_change(move)[on]))
        for body in sheet.bodies:
            sides = body.tangent(shape, body.stress(shape))
            out += body.scatter(sides @ move[body.rows][:, :, None])
        return out


Term = tuple[SheetSensitivity, np.ndarray, np.ndarray]


class SheetGradient(Mapping[str, Any]):
    """Derivatives of a J by name, computed on access from its powers at the Gauss points, and from states
    with vectors λ and ∂J/∂δ (N,)."""

    def __init__(self, points: Mapping[str, np.ndarray], *terms: Term):
        self._points, self._terms = points, terms
        self.of = terms[0][0]

    def __getitem__(self, name: str) -> Any:
        of, sheet = self.of, self.of.sheet
        if name.startswith(FIELD):
            if name not in of.fields:
                raise BadInput(f"{name}: choose from {', '.join(of.fields)}")
            if (field := name.removeprefix(FIELD)) in STATE:
                return sum(state.by_natural(moved, field) for state, moved, _ in self._terms)
            by_points = self._points[field]
            return np.broadcast_to(by_points, sheet.element.areas.shape).sum(axis=1)
        with one_blas_thread():
            ends, over = of.ends(name)
            low, high = map(of.values_of, ends)
            changes = ((by, (high[one] - low[one]) / over) for one, by in self._points.items())
            found = sum(float(np.sum(by * change)) for by, change in changes)
            material = PLACED.match(name) is None
            if material and sheet.natural is None and not (sheet.bodies or sheet.contacts):
                return found
            for state, moved, by_prescribed in self._terms:
                rate, placed = state.rates(ends, over, weight=not material)
                found += float(moved @ rate + by_prescribed @ placed)
        return found

    def __iter__(self) -> Iterator[str]:
        return iter(self.of.names())

    def __len__(self) -> int:
        return len(self.of.names())
