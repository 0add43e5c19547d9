"""The model that is fitted: its settings, and the predictor of any measurements of its scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.identification import surface
from comparisons.identification.measurements import Displacements, Measured
from comparisons.identification.prediction import Predictor, lattice, motion, reference
from comparisons.models.grading import fixed, lines_on_shapes
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.spec import Elements, Lattice
from sheetbench.answers.history import History
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grading import as_settings

if TYPE_CHECKING:
    from lumped import Calibration

MOTION_ERROR = (
    1e-7  # of a lattice's step: adaptive steps change with the unknowns, differences must not see it
)
STEPS_PER_PERIOD = 100  # of a reference, fixed: frequencies within (2π/100)²/12, E within twice that, 0.07 %


@dataclass(frozen=True)
class Model:
    """settings: of the model; axes: the plan grid on which it gives its whole surface; predictor: of it at
    the rows of some measurements."""

    settings: dict[str, Any]
    axes: tuple[np.ndarray, np.ndarray]
    predictor: Callable[[Measured], Predictor]


def lattice_model(scene: Scene, requested: Lattice) -> Model:
    """Return the lattice requested, what it leaves open chosen by the scene's own values."""
    chosen = resolve(scene, requested, own=False)
    grading = fixed(chosen.spec.grading) or lines_on_shapes(scene, chosen.grid, chosen.spec)
    settings = {**chosen.settings, **as_settings(grading)}

    def springs(here: Scene) -> Calibration:
        return chosen.on(here).springs

    def run(here: Scene, end: float) -> History:
        import lumped

        return lumped.simulate(here, springs(here), end, error=MOTION_ERROR)

    def predictor(measured: Measured) -> Predictor:
        if isinstance(measured, Displacements) and measured.time is not None:
            return motion(scene, run, measured.time)
        return lattice(scene, springs)

    return Model(settings, surface.plan_grid(scene.sheet.lengths, chosen.grid[:2]), predictor)


def reference_model(model: Resolved[Elements]) -> Model:
    """Return a finite-element reference."""
    import fem_reference

    along_x, along_y = model.spec.counts(model.scene)[:2]
    axes = surface.plan_grid(model.scene.sheet.lengths, (2 * along_x + 1, 2 * along_y + 1))
    predict, options = reference(model), model.spec.options

    @cache
    def step() -> float:
        lowest = fem_reference.modes(model.scene, "plate", elements=2, count=1).frequencies[0]
        return float(1.0 / (STEPS_PER_PERIOD * lowest))

    def run(here: Scene, end: float) -> History:
        steps = {"step": step(), "every": step()}
        return fem_reference.simulate(
            here, model.spec.model, end, elements=(along_x, along_y), **steps, **options
        )

    def predictor(measured: Measured) -> Predictor:
        if isinstance(measured, Displacements) and measured.time is not None:
            return motion(model.scene, run, measured.time)
        return predict

    return Model({"elements": [along_x, along_y], **options}, axes, predictor)
