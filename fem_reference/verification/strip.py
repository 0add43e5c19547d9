"""A strip clamped at x = 0, the sheet that three benchmarks of large deflection share; ν = 0."""

from __future__ import annotations

from typing import Any

import numpy as np

from fem_reference import solve
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, Material, Scene, Sheet


def strip(length: float, width: float, thickness: float, young: float, **requested: Any) -> Scene:
    """Length, width and thickness [m], E [Pa], density 1000 kg/m³; loads or gravity as given."""
    return Scene(
        name="strip",
        sheet=Sheet(length_x=length, length_y=width, thickness=thickness),
        material=Material(young=young, poisson=0.0, density=1000.0),
        supports=(Clamped(edge="x0"),),
        **requested,
    )


def tip(scene: Scene, elements: int, model: str = "shell") -> np.ndarray:
    """Displacement (3,) [m] of the free end's middle on that many elements along the strip.

    Not a number where no equilibrium was reached.
    """
    # With ν = 0 there are no layers at the ends to grade towards.
    uniform: dict[str, Any] = {"grading": "uniform"} if model == "solid" else {}
    solution = solve(scene, model, elements=(elements, 1), **uniform)
    if solution.status is not Status.CONVERGED:
        return np.full(3, np.nan)
    return solution.displacement(np.array([[scene.sheet.length_x, scene.sheet.length_y / 2.0]]))[0]
