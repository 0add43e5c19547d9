"""Sheets and answers shared by several cases."""

from collections.abc import Iterable
from typing import Any

import numpy as np

from fem_reference import solve
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.items import DeadLoad
from fem_reference.discrete.static import Static
from sheetbench.answers.solution import Solution, Status
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import EDGES, Clamped, Gravity, Hinged, Material, Scene, Sheet, Support

E1, E2, NU, G = 25e9, 1e9, 0.25, 0.5e9  # [Pa, -] of Reddy's unidirectional plies
FIBRES = Material.model_validate(
    {"kind": "orthotropic", "young_1": E1, "young_2": E2, "poisson_12": NU, "shear_12": G, "density": 1500.0}
)


def specimen(
    sheet: Sheet, material: Material, supports: Iterable[Support], load: float = 0.0, **more: Any
) -> Scene:
    """Return a sheet under a force per area along +z [Pa]; more: other fields of the scene."""
    if load:
        more["gravity"] = Gravity(acceleration=(0.0, 0.0, load / (material.density * sheet.thickness)))
    return Scene(name="specimen", sheet=sheet, material=material, supports=tuple(supports), **more)


def supports(kind: type[Clamped | Hinged], edges: Iterable[str] = EDGES, **more: Any) -> list[Support]:
    """Return supports of a kind along edges, by default all; more: their keys."""
    return [kind.model_validate({"edge": edge, **more}) for edge in edges]


def u_at(
    scene: Scene, at: tuple[float, float], model: str, elements: int | tuple[int, int], **options: Any
) -> np.ndarray:
    """Return the displacement (3,) [m] of a plan point in a model's answer, nan without an equilibrium."""
    solution = solve(scene, model, elements=elements, **options)
    return solution.displacement(np.array([at]))[0] * valid(solution)


def valid(solution: Solution) -> float:
    """Return 1, or nan for an answer that is no equilibrium."""
    return 1.0 if solution.status is Status.CONVERGED else np.nan


def linear_step(sheet: DiscreteElements, force: np.ndarray) -> np.ndarray:
    """Return q (N,) of the first linear step from the flat sheet under an additional force (N,)."""
    sheet.items.append(DeadLoad(force, None))
    static = Static(sheet)
    rest = static.rest()
    forces = static.forces(rest, 1.0)
    matrix, right = static.linearised(rest, forces, 1.0, mixed=False)
    return static.advance(rest, forces, 1.0, DirectSolver().factor(matrix).solve(right)).q
