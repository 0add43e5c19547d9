"""The runs of the transfer study, each carried out in a process of its own: plain data in and out.

Displacements [m] are taken at 5 × 5 points evenly over the sheet, edges included, which every grid of 4 n + 1
masses a side has among its masses; frequencies in Hz.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

import fem_reference
from comparisons.identification.surface import plan_grid, plan_points
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench.scenes import Scene, Sheet

POINTS = 5  # along each side
FREQUENCIES = 3
FINE = 4097  # masses a side of the grid whose moduli stand for those of cells → 0


def points(sheet: Sheet) -> np.ndarray:
    """Where models are compared, (25, 2) [m]."""
    return plan_points(plan_grid(sheet.lengths, (POINTS, POINTS)))


def lattice(
    scene: dict[str, Any],
    method: str,
    grid: Sequence[int],
    training: Sequence[dict[str, Any]] | None = None,
    grading: float | str = 0.0,
) -> dict[str, Any]:
    """Displacement of a lattice at the points. training: scenes of a fitted method, its own unless given."""
    import lumped

    parsed = Scene.model_validate(scene)
    solution = lumped.solve(parsed, _springs(parsed, method, grid, training, grading))
    return _answer(solution, parsed)


def reference(scene: dict[str, Any], model: str, elements: int) -> dict[str, Any]:
    """Displacement of a finite-element model at the points."""
    parsed = Scene.model_validate(scene)
    return _answer(fem_reference.solve(parsed, model, elements=elements), parsed)


def homogenised(
    scene: dict[str, Any], model: str, elements: int, method: str, grid: Sequence[int]
) -> dict[str, Any]:
    """Displacement at the points of the finite-element model whose section is the lattice's on a grid."""
    from fem_reference.surface.materials import Section
    from lumped import homogenised

    parsed = Scene.model_validate(scene)
    springs = _springs(parsed, method, grid, None)
    got = homogenised(parsed.sheet, springs.grid, springs.springs)
    section = Section(got.membrane, got.bending, np.diag(got.shear))
    return _answer(fem_reference.solve(parsed, model, elements=elements, section=section), parsed)


def lattice_frequencies(
    scene: dict[str, Any],
    method: str,
    grid: Sequence[int],
    masses: str,
    training: Sequence[dict[str, Any]] | None = None,
) -> dict[str, Any]:
    """Lowest natural frequencies of a lattice with its mass shared out in one of `lumped.masses`' ways."""
    import lumped

    parsed = Scene.model_validate(scene)
    springs = _springs(parsed, method, grid, training)
    return {"frequencies": lumped.modes(parsed, springs, FREQUENCIES, masses).frequencies}  # type: ignore[arg-type]


def reference_frequencies(scene: dict[str, Any], elements: int) -> dict[str, Any]:
    """Lowest natural frequencies of the shell."""
    import fem_reference

    parsed = Scene.model_validate(scene)
    modes = fem_reference.modes(parsed, model="shell", elements=elements, count=FREQUENCIES)
    return {"frequencies": modes.frequencies}


def _springs(
    scene: Scene,
    method: str,
    grid: Sequence[int],
    training: Sequence[dict[str, Any]] | None,
    grading: float | str = 0.0,
) -> Any:
    chosen = None if training is None else [Scene.model_validate(data) for data in training]
    return resolve(scene, Lattice(tuple(grid), method, grading=grading), "springs").calibrated(chosen)


def _answer(solution: Any, scene: Scene) -> dict[str, Any]:
    return {
        "status": str(solution.status),
        "message": solution.message,
        "load_factor": solution.load_factor,
        "displacement": solution.displacement(points(scene.sheet)),
    }
