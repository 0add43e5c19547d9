"""Derivatives of a plate's or shell's equilibrium by the numbers of its scene, adjoint and forward.

At an equilibrium Zᵀ R(q, θ) = 0, with what is prescribed at δ(θ) (`discrete.sheet`). A function J of the
displacement has, with one solution for all θ,

    (Zᵀ K Z)ᵀ μ = −Zᵀ ∂J/∂q,   λ = Z μ,     dJ/dθ = λ·∂R/∂θ + (∂J/∂q + Kᵀ λ)·∂δ/∂θ,

and a change of θ moves the sheet by

    (Zᵀ K Z) x = −Zᵀ (∂R/∂θ + K ∂δ/∂θ),     du = Z x + ∂δ/∂θ.

By the constants of the sheet λ·∂R/∂θ is a power at the Gauss points with exact derivatives
(`surface.constants`), which summed over elements are those by a field of one value an element; a scene's own
follow by the chain rule. Other numbers change loads, supports, chains and natural strains: these are made
anew on both sides, most of them linear. What touches an obstacle goes on touching it.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from fem_reference.discrete.contact import Touching
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.element import weighed
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.constants import Values, by_values, constants_with, values_of
from fem_reference.surface.location import shares
from sheetbench.errors import Impossible, NoEquilibrium
from sheetbench.numerics.direct import Factor, SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.numbers import numbers, with_number

STEP = 1e-4  # of a number, or of the largest of a list
USUAL = {"strain": 1e-2, "displacement": 1e-2}  # what such numbers are beside, where they are zero; else 1
MATERIAL = ("material", "sheet", "layer", "patch")
Numbers = Mapping[str, np.ndarray]  # by the keys of a scene


class Sensitivity:
    """The derivatives of a sheet's stable equilibrium q (N,) under the full load. centres: of the elements,
    (m, 2) [m], in the order of fields."""

    def __init__(self, sheet: DiscreteShell, q: np.ndarray):
        if sheet.section is not None:
            raise Impossible("derivatives: not with a section of the caller's own, which has no constants")
        self.sheet, self.shape, self.scene = sheet, sheet.shape(q, 1.0), sheet.scene
        self.centres = sheet.plan.nodes[sheet.plan.elements[:, 8]]

    @cached_property
    def matrix(self) -> Any:
        """Zᵀ K Z."""
        return self.sheet.tangent(self.shape, self.sheet.forces(self.shape), 0.0, 0.0)

    @cached_property
    def factor(self) -> Factor:
        """Factors of that. Raises NoEquilibrium where it is singular or, of dead loads, not stable."""
        return self._factor(self.matrix)

    @cached_property
    def _transposed(self) -> Factor:
        return self.factor if self.sheet.symmetric else self._factor(self.matrix.T.tocsr())

    def _factor(self, matrix: Any) -> Factor:
        try:
            found = self.sheet.solver().factor(matrix)
        except SingularMatrixError as error:
            raise NoEquilibrium(f"{self.sheet.model}: singular: it has no derivatives: {error}") from None
        if found.negative > 0 or found.zero > 0:
            raise NoEquilibrium(f"{self.sheet.model}: unstable: its derivatives are of another branch")
        return found

    @cached_property
    def values(self) -> Values:
        """The sheet's constants at the Gauss points."""
        return self._values_of(self.scene)

    def _values_of(self, scene: Scene) -> Values:
        return values_of(scene, self.sheet.plan.corners, not self.sheet.linear)

    def nodal(self, points: np.ndarray, weights: np.ndarray) -> np.ndarray:
        """Return ∂J/∂u (n, 3) of the nodes for one (p, 3) at plan points (p, 2) [m]."""
        element, value = shares(self.sheet.plan.mesh, np.asarray(points, dtype=float))
        out = np.zeros((self.sheet.nodes, 3))
        np.add.at(out, self.sheet.plan.elements[element], value[:, :, None] * np.asarray(weights)[:, None])
        return out

    def pullback(self, by_displacement: np.ndarray) -> dict[str, np.ndarray]:
        """Return dJ/dθ of every number of the scene, by its key, and by "elements.KEY" of every constant of
        one value an element, (m,); by_displacement: ∂J/∂u (n, 3) of the nodes. Raises NoEquilibrium."""
        sheet = self.sheet
        given = np.zeros(sheet.size)
        sheet.displacement(given)[:] = by_displacement
        with one_blas_thread():
            solved = self._transposed.solve(sheet.reduce(self.shape, given))
            moved = -sheet.expand(self.shape, solved)
            points = self.power(moved)
            found = by_elements(points)
            for key, value in numbers(self.scene).items():
                found[key] = np.zeros_like(value)
                for place in np.ndindex(value.shape):
                    step = np.zeros_like(value)
                    step[place] = 1.0
                    found[key][place] = self._along({key: step}, points, moved, given)
        return found

    def pushforward(self, change: Numbers) -> np.ndarray:
        """Return du (n, 3) of the nodes for changes of the scene's numbers. Raises NoEquilibrium."""
        sheet, shape = self.sheet, self.shape
        with one_blas_thread():
            ends, over = self._ends(change)
            rate, placed = self._rates(ends, over, whole=True)
            rate += self._product(placed)
            step = sheet.expand(shape, self.factor.solve(-sheet.reduce(shape, rate)))
        return sheet.displacement(step + placed)

    def power(self, moved: np.ndarray) -> dict[str, np.ndarray]:
        """Return λ·∂R/∂c (m, 9) of λ (N,) by the constants at the Gauss points."""
        sheet, shape, element = self.sheet, self.shape, self.sheet.element
        rate = element.at_points(element.step(shape.operator, sheet.gather(moved)))
        pull, turn = np.zeros((2, *element.areas.shape))  # of the weight on λ, per mass
        if self.scene.gravity is not None:
            along = sheet.surface_change(moved) @ self.scene.gravity.last_acceleration
            pull, turn = (element.areas * (of @ AT_GAUSS[0].T) for of in (along[:, :9], along[:, 9:]))

        def of(values: Values) -> np.ndarray:
            constants, stresses = constants_with(values), element.resultants(values, shape.strain)
            power = sum((a * b).sum(axis=-1) for a, b in zip(stresses, rate, strict=True))
            return power - constants.per_area * pull - constants.moment_per_area * turn

        return by_values(of, self.values)

    def _along(
        self, change: Numbers, points: Numbers, moved: np.ndarray, given: np.ndarray
    ) -> float:
        """Return dJ along a change of one number, of λ (N,), its powers at the Gauss points, ∂J/∂q (N,)."""
        (key,) = change
        root, sheet, found = key.split(".")[0].rstrip("0123456789"), self.sheet, 0.0
        ends, over = self._ends(change)
        natural, material = root in ("natural", "temperature") or ".natural." in key, root in MATERIAL
        if material or natural:
            low, high = (self._values_of(end) for end in ends)
            sums = (np.sum(of * ((high[name] - low[name]) / over)) for name, of in points.items())
            found += float(sum(sums))
        if not material or sheet.natural is not None or sheet.bodies or sheet.contacts:
            rate, placed = self._rates(ends, over, weight=not material)
            found += float(moved @ rate)
            if placed.any():
                found += float((given + self._product(moved, transposed=True)) @ placed)
        return found

    def _ends(self, change: Numbers) -> tuple[tuple[Scene, Scene], float]:
        """Return the scene on both sides, and how many times the change lies between."""
        now = numbers(self.scene)
        sizes = {key: np.abs(now[key]).max() or USUAL.get(key.split(".")[-1], 1.0) for key in change}
        share = STEP / max(np.abs(by).max() / sizes[key] for key, by in change.items())
        low = high = self.scene
        for key, by in change.items():
            low, high = with_number(low, key, now[key] - share * by), with_number(high, key, now[key] + share * by)
        return (low, high), 2.0 * share

    def _rates(
        self, ends: tuple[Scene, Scene], over: float, weight: bool = True, whole: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return ∂R/∂θ (N,) without what the constants of the elements do, unless it is the whole, and
        ∂δ/∂θ (N,). weight: whether with loads and the weight of the sheet."""
        sheet, shape, placed = self.sheet, self.shape, np.zeros(self.sheet.size)
        sides = [sheet.with_scene(end) for end in ends]
        forces = []
        for side in sides:
            element = side.elements_of(None, side.law)[0] if whole else sheet.element
            strain = side.strain(shape.change, 1.0) if whole else self._unstrained(side)
            force = sheet.scatter(element.forces(shape.operator, element.stress(strain)))
            for body in side.bodies:
                force += body.scatter(body.pull(shape.q, body.stress(shape)))
                force -= sum(body.scatter(dead) for dead, _ in side.weights) * (not weight)
            items = [one for one in side.items if weight and not isinstance(one, Touching)]
            forces.append(force - sum(one.force(shape) for one in items))
        low, high = sides
        rate = (forces[1] - forces[0]) / over
        for one, *both in zip(sheet.contacts, low.contacts, high.contacts, strict=True):
            rate -= one.rate(shape, *both, over)
        placed[: 6 * sheet.nodes] = ((high.change(1.0) - low.change(1.0)) / over).ravel()
        return rate, placed

    def _unstrained(self, side: DiscreteShell) -> np.ndarray:
        """Return less the natural strains of a sheet."""
        return np.zeros_like(self.shape.strain) if side.natural is None else -side.natural.at()

    def _product(self, move: np.ndarray, transposed: bool = False) -> np.ndarray:
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


def by_elements(points: Numbers) -> dict[str, np.ndarray]:
    """Return sums over elements (m,) of what is not zero everywhere, under the keys of fields."""
    return {f"elements.{key}": of.sum(axis=1) for key, of in points.items() if of.any()}


def at_answer(kind: type[DiscreteShell], mesh: Any, scene: Scene, law: str, section: Any, q: np.ndarray) -> Sensitivity:
    """x"""
