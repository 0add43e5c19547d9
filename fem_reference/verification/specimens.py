"""Sheets and answers that several cases share."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from fem_reference import solve
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.items import Dead
from fem_reference.discrete.static import Static
from sheetbench.answers.solution import Solution, Status
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import EDGES, Clamped, Gravity, Hinged, Material, Scene, Sheet, Support

E1, E2, NU, G = 25e9, 1e9, 0.25, 0.5e9  # Reddy's, of unidirectional plies, in one of his sizes
FIBRES = Material.model_validate(
    {"kind": "orthotropic", "young_1": E1, "young_2": E2, "poisson_12": NU, "shear_12": G, "density": 1500.0}
)


def specimen(
    sheet: Sheet, material: Material, supports: Iterable[Support], load: float = 0.0, **more: Any
) -> Scene:
    """A sheet under a force per area along +z [Pa], and what more a scene has."""
    if load:
        more["gravity"] = Gravity(acceleration=(0.0, 0.0, load / (material.density * sheet.thickness)))
    return Scene(name="specimen", sheet=sheet, material=material, supports=tuple(supports), **more)


def around(kind: type[Clamped | Hinged], edges: Iterable[str] = EDGES, **more: Any) -> list[Support]:
    """Supports of a kind along edges, all unless given; more: of their keys."""
    return [kind.model_validate({"edge": edge, **more}) for edge in edges]


def moved(
    scene: Scene, at: tuple[float, float], model: str, elements: int | tuple[int, int], **options: Any
) -> np.ndarray:
    """Displacement (3,) [m] of a plan point in a model's answer; not a number where no equilibrium was
    reached. options: as of `solve`."""
    solution = solve(scene, model, elements=elements, **options)
    return solution.displacement(np.array([at]))[0] * valid(solution)


def valid(solution: Solution) -> float:
    """1, or not a number of an answer that is no equilibrium."""
    return 1.0 if solution.status is Status.CONVERGED else np.nan


def linear_step(sheet: DiscreteElements, force: np.ndarray) -> np.ndarray:
    """q (N,) of the first linear step from the flat sheet under a force (N,) more."""
    sheet.items.append(Dead(force, None))
    static = Static(sheet)
    rest = static.rest()
    forces = static.forces(rest, 1.0)
    matrix, right = static.linearised(rest, forces, 1.0, mixed=False)
    return static.advance(rest, forces, 1.0, DirectSolver().factor(matrix).solve(right)).q
