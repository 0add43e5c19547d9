"""Statics that start from the end of a strongly damped motion.

    ω² = a/L + E h²/(ρ L⁴)

is a frequency of the loads, which give the sheet of shorter side L the acceleration a, and of its bending. A
drag of CREEPING ω · mass prevents oscillation, and a duration of LONG/ω suffices to leave unstable
equilibria. Inertia and the material's dampers then have no effect on the result, so that an implicit rule can
take long steps.
"""

from collections.abc import Iterable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from comparisons.comparison.branches import Field, shape
from comparisons.models.resolve import Resolved
from comparisons.models.solve import simulate
from comparisons.models.spec import Lattice
from comparisons.sweep.in_process import LocalSolve, solve_in_process
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import mass_of
from sheetbench.scenes.meaning.motion import kinks
from sheetbench.scenes.meaning.region import resultant
from sheetbench.scenes.objects.material import UNDAMPED

CREEPING, LONG, SAMPLES = 10.0, 1000.0, 100  # drag over ω; duration times ω; frames of the motion
LARGEST_CHANGE = 0.1  # change of a displacement from the end of the motion, over the largest one


def require_settling(models: Iterable[Resolved[Any]]) -> None:
    """Raise BadInput for a model whose statics cannot start from a given shape."""
    for name in (model.spec.model for model in models):
        if name not in (Lattice.NAME, "shell"):
            raise BadInput(f"--settle: {name}: it cannot start from a given shape; lattice and shell can")


def solved_from_motion(model: Resolved[Any], name: str) -> LocalSolve:
    """Return the row of a model whose statics start from the end of its damped motion."""
    near, at_rest, fault = shape_after_motion(model)
    row = solve_in_process(model, name, near=near)
    points = model.scene.probe_points()
    shape_at_rest, answer = at_rest(points), row.answer
    difference = np.abs(answer.displacement(points) - shape_at_rest).max(initial=0.0)
    left = bool(difference > LARGEST_CHANGE * np.abs(shape_at_rest).max(initial=0.0))
    remarks = (
        *answer.remarks,
        *filter(None, [fault, "statics left the shape at the end of the motion" * left]),
    )
    return replace(
        row, answer=replace(answer, settings=answer.settings | {"begun": "motion"}, remarks=remarks)
    )


def shape_after_motion(model: Resolved[Any]) -> tuple[Any, Field, str]:
    """Return the final shape of a model's damped motion, for `near` of its statics, the displacement of its
    mid-surface, and a clause on a motion that failed, else ""."""
    scene, is_lattice = model.scene, isinstance(model.spec, Lattice)
    settings = {"integrator": "esdirk"} if is_lattice and not scene.actuators else {}
    rate = frequency(scene)
    material = scene.material.replace(**UNDAMPED, damping_rate=CREEPING * rate)
    duration = LONG / rate + max(kinks(scene), default=0.0)
    doing = f"letting the {model.spec.model} settle"
    damped = model.on(scene.replace(material=material, initial=None))
    motion = simulate(damped, duration, doing, every=duration / SAMPLES, frames=SAMPLES, **settings)
    fault = "" if motion.succeeded else f"its motion did not come to rest: {'; '.join(motion.complaints())}"
    last = motion.extra["frames"][-1]
    at_rest = partial(motion.extra["sample"], last)
    return last if is_lattice else partial(shape, scene, at_rest), at_rest, fault


def frequency(scene: Scene) -> float:
    """Return the frequency ω of a scene's loads and bending [rad/s]."""
    material, length, mass = scene.material, min(scene.sheet.lengths), mass_of(scene)
    force = sum(float(np.linalg.norm(resultant(scene, load))) for load in scene.loads)
    weight = 0.0 if scene.gravity is None else float(np.linalg.norm(scene.gravity.acceleration))
    bending = material.young * scene.sheet.thickness**2 / (material.density * length**4)
    return float(np.sqrt((force / mass + weight) / length + bending))
