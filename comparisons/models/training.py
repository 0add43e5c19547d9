"""Targets of fitted calibrations: the shell's displacements and frequencies on training scenes.

The default scenes are the sheet under its own weight with one edge and with two adjacent edges clamped, both
easy to measure. fit-static uses displacements at 8 × 8 plan points off the edges x0 and y0, fit-modal the
first four natural frequencies of each scene: higher modes have too few masses per wavelength on 9 × 9 and
spoil the fit.
"""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

import fem_reference
import lumped
from comparisons.models.context import context
from comparisons.models.sizes import size
from comparisons.models.spec import Elements, Lattice
from comparisons.pictures.work import Work
from lumped import Calibration, ModalTarget, StaticTarget
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, Gravity, Material, Scene, Sheet
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import Grid

POINTS = 8  # along each side
FREQUENCIES = 4
ELEMENTS = 16  # of the shell along the shorter side
WEIGHT = Gravity(acceleration=(0.0, 0.0, -9.81))


def training_scenes(sheet: Sheet, material: Material) -> tuple[Scene, ...]:
    """Return the sheet under its own weight, clamped at one edge and at two adjacent edges."""
    supports = {
        "one-edge-clamped": (Clamped(edge="x0"),),
        "two-edges-clamped": (Clamped(edge="x0"), Clamped(edge="y0")),
    }
    return tuple(
        Scene(name=name, sheet=sheet, material=material, gravity=WEIGHT, supports=held)
        for name, held in supports.items()
    )


def fitted(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    method: str,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    training: Sequence[Scene] | None = None,
) -> Calibration:
    """Return springs fitted to the shell on training scenes of this sheet and material; computed once per
    process. Raises BadInput for a training scene without a usable static answer."""
    scenes = training_scenes(sheet, material) if training is None else training
    texts = tuple(scene.model_dump_json(by_alias=True, exclude_none=True) for scene in scenes)
    for scene, text in zip(scenes, texts, strict=True):
        shell = size(scene, Elements("shell", ELEMENTS))
        context().progress(Work(f"training on {scene.name}: the shell", shell))
        _target(text, method == "fit-modal")  # cached for `_fitted`
    context().progress(Work("fitting springs", size(scenes[0], Lattice(grid))))
    return _fitted(texts, grid, method, layer_distance, grading)


@lru_cache(maxsize=64)
def _fitted(
    texts: tuple[str, ...], grid: Grid, method: str, layer_distance: float | None, grading: Graded
) -> Calibration:
    targets = [_target(text, method == "fit-modal") for text in texts]
    sheet, material = targets[0].scene.sheet, targets[0].scene.material
    options: dict[str, Any] = {"layer_distance": layer_distance, "grading": grading}
    return lumped.calibrate(sheet, material, grid, method, targets=targets, **options)


def training_points(scene: Scene) -> np.ndarray:
    """Return evenly spaced plan points (n, 2) [m] of a sheet, none on its edges x0 and y0."""
    x, y = (np.linspace(length / POINTS, length, POINTS) for length in scene.sheet.lengths)
    return np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)


@lru_cache(maxsize=64)
def _target(text: str, modal: bool) -> StaticTarget | ModalTarget:
    scene = Scene.model_validate_json(text)
    if modal:
        modes = fem_reference.modes(scene, model="shell", elements=ELEMENTS, count=FREQUENCIES)
        return ModalTarget(scene, modes.frequencies)
    solution, points = fem_reference.solve(scene, model="shell", elements=ELEMENTS), training_points(scene)
    if solution.status is not Status.CONVERGED:
        raise BadInput(f"scene '{scene.name}': nothing to train on, the shell's answer is {solution.status}")
    displacement = solution.displacement(points)
    if not displacement.any():
        raise BadInput(f"scene '{scene.name}': nothing to train on, nothing moves; give it a load or weight")
    return StaticTarget(scene, points, displacement)
