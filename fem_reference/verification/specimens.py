"""Sheets, meshes and answers that several cases share."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import Any

import numpy as np
from skfem import MeshQuad, MeshQuad2

from fem_reference import solve
from sheetbench.answers.solution import Status
from sheetbench.scenes import EDGES, Clamped, Gravity, Hinged, Material, Scene, Sheet, Support


def specimen(
    sheet: Sheet, material: Material, supports: Iterable[Support], load: float = 0.0, **more: Any
) -> Scene:
    """A sheet under a force per area along +z [Pa], and what more a scene has."""
    if load:
        more["gravity"] = Gravity(acceleration=(0.0, 0.0, load / (material.density * sheet.thickness)))
    return Scene(name="specimen", sheet=sheet, material=material, supports=tuple(supports), **more)


def around(kind: type[Clamped | Hinged], edges: Iterable[str] = EDGES) -> list[Support]:
    """Supports of a kind along edges, all unless given."""
    return [kind.model_validate({"edge": edge}) for edge in edges]


def moved(
    scene: Scene, at: tuple[float, float], model: str, elements: int | tuple[int, int], **options: Any
) -> np.ndarray:
    """Displacement (3,) [m] of a plan point in a model's answer; not a number where no equilibrium was
    reached. options: as of `solve`."""
    solution = solve(scene, model, elements=elements, **options)
    if solution.status is not Status.CONVERGED:
        return np.full(3, np.nan)
    return solution.displacement(np.array([at]))[0]


def mapped(
    first: np.ndarray,
    second: np.ndarray,
    place: Callable[[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]],
    sides: dict[str, tuple[int, float]],
) -> MeshQuad2:
    """The mesh with lines at two coordinates, whose nodes lie where `place` puts them [m]; sides: name → the
    coordinate that is constant there, and its value."""
    plan = MeshQuad.init_tensor(first, second)
    mesh = MeshQuad2.from_mesh(plan)
    bent = replace(mesh, doflocs=np.array(place(*mesh.doflocs)))
    on = {
        name: plan.facets_satisfying(lambda x, axis=axis, at=at: np.isclose(x[axis], at))
        for name, (axis, at) in sides.items()
    }
    return bent.with_boundaries(on)
