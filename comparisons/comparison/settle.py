"""A sheet at rest where its motion ends: it creeps there under a strong drag, and statics go on from there.

    ω² = a/L + E h²/(ρ L⁴)

is the rate of the loads, which give a sheet of shorter side L the acceleration a, and of bending. Under a
drag of CREEPING ω · mass nothing swings, and within LONG/ω a sheet has left its unstable equilibria too.
Inertia and the material's own dampers do not matter then, so that an implicit rule takes long steps.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import partial
from typing import Any

import numpy as np

from comparisons.comparison.branches import shape
from comparisons.models.resolve import Resolved
from comparisons.models.solve import simulate
from comparisons.models.spec import Lattice
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import mass_of
from sheetbench.scenes.meaning.motion import kinks
from sheetbench.scenes.meaning.region import resultant
from sheetbench.scenes.objects.material import UNDAMPED

CREEPING, LONG, SAMPLES = 10.0, 1000.0, 100


def require_settling(models: Iterable[Resolved[Any]]) -> None:
    """Raise BadInput for a model whose statics begin at no shape."""
    for name in (model.spec.model for model in models):
        if name not in (Lattice.NAME, "shell"):
            raise BadInput(f"--settle: {name}: it is not begun near a shape; lattice and shell are")


def settled(model: Resolved[Any]) -> tuple[Any, str]:
    """Return the shape in which a model's sheet comes to rest, as its statics take `near`, and a clause on a
    motion that ended early."""
    scene, lattice = model.scene, isinstance(model.spec, Lattice)
    own = {"integrator": "esdirk"} if lattice and not scene.actuators else {}
    rate = frequency(scene)
    slow = scene.material.replace(**UNDAMPED, damping_rate=CREEPING * rate)
    until = LONG / rate + max(kinks(scene), default=0.0)
    doing = f"letting the {model.spec.model} settle"
    creeping = model.on(scene.replace(material=slow, initial=None))
    found = simulate(creeping, until, doing, every=until / SAMPLES, frames=SAMPLES, **own)
    ended = "" if found.succeeded else f"its motion did not come to rest: {'; '.join(found.complaints())}"
    if lattice:
        return found.extra["frames"][-1], ended
    last = partial(found.extra["sample"], found.extra["frames"][-1])
    return partial(shape, scene, last), ended


def frequency(scene: Scene) -> float:
    """Return ω [rad/s] of a scene's loads and its bending."""
    material, length, mass = scene.material, min(scene.sheet.lengths), mass_of(scene)
    force = sum(float(np.linalg.norm(resultant(scene, load))) for load in scene.loads)
    weight = 0.0 if scene.gravity is None else float(np.linalg.norm(scene.gravity.acceleration))
    bends = material.young * scene.sheet.thickness**2 / (material.density * length**4)
    return float(np.sqrt((force / mass + weight) / length + bends))
