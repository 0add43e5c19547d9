"""Derivatives of a natural frequency of plate or shell by the numbers of its scene.

A mode φ has K φ = ω² M φ and φᵀ M φ = 1, where K is the Hessian H plus μ = −R_d·d of |d| = 1, and

    dω² = φᵀ (∂H/∂θ − ω² ∂M/∂θ) φ + Σ |φ_d|² dμ + (∂/∂q φᵀHφ + 2 ν φ_d)·dq,

ν = −d·(H + μ − ω²M) φ being the force that keeps φ_d in the plane across d, which turns. Derivatives of an
energy are symmetric: ∂/∂q φᵀHφ and φᵀ ∂H/∂θ φ are the derivatives of H φ and φ·∂R/∂θ along φ, differences
between both sides of q. dq is the equilibrium's own (`fem_reference.sensitivity`); about the flat sheet there
is none. Source: Fox and Kapoor, AIAA Journal 6 (1968) 2426, for a constant K.
"""

from __future__ import annotations

import numpy as np

from fem_reference.sensitivity import SheetGradient, SheetSensitivity, Term
from fem_reference.shell.directors import multiplier
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.biquadratic import AT_GAUSS
from fem_reference.surface.constants import Values, by_values, constants_with
from sheetbench.errors import Impossible
from sheetbench.numerics.threads import one_blas_thread

SMALL = 1e-4  # of the thickness, that a mode moves the sheet for a difference


class FrequencyGradient(SheetGradient):
    """df/dθ [Hz per unit] by name, of a mode φ (N,) and its ω² about q (N,) at a load factor."""

    def __init__(self, sheet: DiscreteShell, q: np.ndarray, at: float, mode: np.ndarray, squared: float):
        if sheet.contacts:
            raise Impossible("derivatives of frequencies: not with obstacles, where frequencies may jump")
        scale = 1.0 / (4.0 * np.pi * np.sqrt(squared))  # df/dω²
        step = SMALL * sheet.scene.sheet.thickness / np.abs(sheet.displacement(mode)).max()
        of = SheetSensitivity(sheet, q, at)
        sides = [(SheetSensitivity(sheet, q + end * mode, at), scale / (2.0 * end)) for end in (-step, step)]
        with one_blas_thread():
            terms: list[Term] = [(state, by * mode, np.zeros_like(mode)) for state, by in sides]
            if at:
                third = sum(by * state.product(mode) for state, by in sides)
                terms.append(_of_shape(of, mode, squared, scale, third))
            points = by_values(lambda values: -squared * scale * _inertia(of, mode, values), of.values)
            for state, moved, _ in terms:
                points = {name: by + points[name] for name, by in state.power(moved, of.values).items()}
        super().__init__(points, *terms)
        self._mode, self._by_mass = mode, -squared * scale

    def __getitem__(self, name: str) -> float:
        derivative: float = super().__getitem__(name)
        if name.startswith("mass"):
            ends, over = self.of.ends(name)
            low, high = (self._mode @ (self.of.sheet.with_scene(end).mass @ self._mode) for end in ends)
            derivative += self._by_mass * (high - low) / over
        return derivative


def _of_shape(
    of: SheetSensitivity, mode: np.ndarray, squared: float, scale: float, third: np.ndarray
) -> Term:
    """Return the term of dμ and of the equilibrium's change dq in the derivative of ω²; third: derivative
    (N,) of φᵀHφ by q."""
    sheet, first = of.sheet, of.sheet.first_director
    directors, turned = sheet.directors(of.shape.q), mode[first:].reshape(-1, 3)
    along = multiplier(directors, sheet.forces(of.shape)[first:].reshape(-1, 3))
    pulled = (of.product(mode) - squared * (sheet.mass @ mode))[first:].reshape(-1, 3) + along[
        :, None
    ] * turned
    held, stiffer = -np.sum(directors * pulled, axis=1), np.zeros_like(mode)
    given = third.copy()
    given[first:] += (2.0 * scale * held[:, None] * turned).ravel()
    stiffer[first:] = (scale * np.sum(turned**2, axis=1)[:, None] * directors).ravel()
    rows = sheet.reduce(of.shape, given - of.product(stiffer))
    moved = -sheet.expand(of.shape, of.factor.solve(rows)) - stiffer
    return of, moved, given + of.product(moved)


def _inertia(of: SheetSensitivity, mode: np.ndarray, values: Values) -> np.ndarray:
    """Return φᵀMφ (m, 9) at the Gauss points of a sheet with the given constants."""
    constants, sheet = constants_with(values), of.sheet
    u, d = (AT_GAUSS[0] @ part for part in np.split(sheet.surface_change(mode), 2, axis=1))
    moved, mixed, turned = (sheet.element.areas * np.sum(a * b, axis=-1) for a, b in ((u, u), (u, d), (d, d)))
    return (
        constants.per_area * moved
        + 2.0 * constants.moment_per_area * mixed
        + constants.rotary_per_area * turned
    )
