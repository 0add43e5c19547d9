"""Runs of the transfer study, each carried out in a process of its own: plain data in and out.

Displacements [m] are taken at 5 × 5 points evenly over the sheet, edges included, which are masses of every
grid of 4 n + 1 masses a side; frequencies in Hz.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

import fem_reference
import lumped
from comparisons.identification.surface import plan_grid, plan_points
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from fem_reference.surface.materials import Section
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene, Sheet

POINTS = 5  # along each side
FREQUENCIES = 3
FINEST = 4097  # masses a side of the grid whose moduli stand for cells → 0


def points(sheet: Sheet) -> np.ndarray:
    """Return the points at which models are compared, (25, 2) [m]."""
    return plan_points(plan_grid(sheet.lengths, (POINTS, POINTS)))


def fitted(scene: dict[str, Any], **lattice: Any) -> dict[str, Any]:
    """Return the displacement at the points of a lattice whose springs are fitted to other scenes."""
    parsed = Scene.model_validate(scene)
    return _displacement(lumped.solve(parsed, _springs(parsed, **lattice)), parsed)


def homogenised(scene: dict[str, Any], elements: int, **lattice: Any) -> dict[str, Any]:
    """Return the displacement at the points of the shell with the lattice's section."""
    parsed = Scene.model_validate(scene)
    springs = _springs(parsed, **lattice)
    sides = np.divide(parsed.sheet.lengths, np.subtract(springs.grid[:2], 1))
    moduli = lumped.moduli.of_springs(springs.springs, (*sides, springs.layer_distance), springs.grid[2])
    section = Section(moduli.membrane, moduli.bending, np.diag(moduli.shear))
    return _displacement(fem_reference.solve(parsed, "shell", elements=elements, section=section), parsed)


def lattice_frequencies(scene: dict[str, Any], masses: Any, **lattice: Any) -> dict[str, Any]:
    """Return the lowest natural frequencies of a lattice; masses: one of `lumped.masses`' distributions."""
    parsed = Scene.model_validate(scene)
    modes = lumped.modes(parsed, _springs(parsed, **lattice), FREQUENCIES, masses)
    return {"found": modes.frequencies}


def reference_frequencies(scene: dict[str, Any], elements: int) -> dict[str, Any]:
    """Return the lowest natural frequencies of the shell."""
    parsed = Scene.model_validate(scene)
    modes = fem_reference.modes(parsed, model="shell", elements=elements, count=FREQUENCIES)
    return {"found": modes.frequencies}


def _springs(
    scene: Scene,
    method: str,
    grid: Sequence[int],
    training: Sequence[dict[str, Any]] | None = None,
    grading: float | str = 0.0,
) -> lumped.Calibration:
    """Return a lattice's springs. training: scenes of a fitted method, by default its own."""
    training_scenes = None if training is None else [Scene.model_validate(data) for data in training]
    return resolve(scene, Lattice(tuple(grid), method, grading=grading), "springs").calibrated(
        training_scenes
    )


def _displacement(solution: Solution, scene: Scene) -> dict[str, Any]:
    return {
        "status": str(solution.status),
        "message": solution.message,
        "load_factor": solution.load_factor,
        "found": solution.displacement(points(scene.sheet)),
    }
