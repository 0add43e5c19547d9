"""Derivatives of a natural frequency of a lattice by numbers of its scene and fields over its cells.

A mode φ has K φ = ω² M φ and φᵀ M φ = 1, with the tangent K at an equilibrium u, and

    dω² = φᵀ (∂K/∂θ − ω² ∂M/∂θ) φ + (∂/∂u φᵀ K φ) · du.

Derivatives of an energy are symmetric: φᵀ ∂K/∂θ φ and ∂/∂u φᵀ K φ are the derivatives of −φ·∂R/∂θ and K φ
along φ, differences between both sides of u. du is the equilibrium's own (`lumped.gradient`); about the flat
sheet there is none. Source: Fox and Kapoor, AIAA Journal 6 (1968) 2426, for a constant K.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from lumped.cell_fields import DENSITY, FIELD, THICKNESS
from lumped.gradient import FORCES, Equilibrium, Gradient
from sheetbench.errors import BadInput
from sheetbench.numerics.threads import one_blas_thread

SMALL = 2e-4  # of the thickness, that a mode moves the sheet for a difference
INERT = (DENSITY, THICKNESS, FORCES)


class ModeGradient(Mapping[str, Any]):
    """df/dθ [Hz per unit] by name, of the mode (m,) of an equilibrium; squared: ω² [1/s²]; inertia: function
    from a problem and its springs to Tᵀ M T (m, m). A shape under load changes too."""

    def __init__(self, of: Equilibrium, mode: np.ndarray, squared: float, inertia: Callable[..., Any]):
        problem, u, shape, none = of.problem, of.u, of.problem.expand(mode), np.zeros_like(of.u)
        step = SMALL * problem.scene.sheet.thickness / np.abs(shape).max()
        ends = [(u + end * shape, 0.5 / end) for end in (step, -step)]
        states = [(Equilibrium(of.base, at, share=of.share), by) for at, by in ends]
        self._terms = [(Gradient(state, none, mode), -by) for state, by in states]
        if of.share:
            with one_blas_thread():
                third = sum(by * problem.system.apply(problem.tangent(at, 1.0), shape) for at, by in ends)
            self._terms.append((of.pullback(np.asarray(third)).at_rest(), 1.0))
        self._of, self._mode, self._squared, self._inertia = of.base, mode, squared, inertia

    def __getitem__(self, name: str) -> Any:
        if name in INERT:
            raise BadInput(f"{name}: frequencies have no derivative by it; take density or thickness")
        found = sum(by * term[name] for term, by in self._terms)
        if not (name.startswith(FIELD) or name in self._of.calibration.constants.names()):
            sides, over = self._of.sides(name)
            each = (self._inertia(side.problem, side.calibration) for side in sides)
            low, high = (self._mode @ (inertia @ self._mode) for inertia in each)
            found -= self._squared * (high - low) / over
        return found / (4.0 * np.pi * np.sqrt(self._squared))

    def __iter__(self) -> Iterator[str]:
        return (name for name in self._of.names() if name not in INERT)

    def __len__(self) -> int:
        return sum(1 for _ in self)
