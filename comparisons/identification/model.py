"""The model that is fitted: its settings, and the predictor of any measurements of its scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from comparisons.identification import surface
from comparisons.identification.measurements import Displacements, Measured
from comparisons.identification.prediction import Predictor, lattice, motion, reference
from comparisons.models.grids import Elements
from comparisons.models.springs import LatticeSpec, resolve
from comparisons.report.work import Progress, silent
from sheetbench.scenes import Scene
from sheetbench.scenes.grading import as_settings
from sheetbench.scenes.grid import near_square


@dataclass(frozen=True)
class Model:
    """settings: of the model; axes: the plan grid on which it gives its whole surface; predictor: of it at
    the rows of some measurements."""

    settings: dict[str, Any]
    axes: tuple[np.ndarray, np.ndarray]
    predictor: Callable[[Measured], Predictor]


def lattice_model(scene: Scene, asked: LatticeSpec) -> Model:
    """The lattice asked for, what it leaves open chosen by the scene's own values."""
    chosen = resolve(scene, asked, own=False)
    settings = {**chosen.settings, **as_settings(chosen.grading or 0.0)}

    def predictor(measured: Measured) -> Predictor:
        if isinstance(measured, Displacements) and measured.time is not None:
            return motion(scene, chosen.springs, measured.time)
        return lattice(scene, chosen.springs)

    return Model(settings, surface.plan_grid(scene.sheet.lengths, chosen.grid[:2]), predictor)


def reference_model(
    scene: Scene, model: str, elements: Elements, progress: Progress = silent, **options: Any
) -> Model:
    """A finite-element reference with its own options; progress: told of every solve."""
    along_x, along_y = near_square(scene.sheet, elements) if isinstance(elements, int) else elements
    axes = surface.plan_grid(scene.sheet.lengths, (2 * along_x + 1, 2 * along_y + 1))
    predict = reference(scene, model, elements, progress, **options)
    return Model({"elements": [along_x, along_y], **options}, axes, lambda measured: predict)
