"""Limits of strain beyond which a linear law of stress and strain, and so a linear spring, is not valid.

weight   ρ g a/E, the strain of a sheet of longer side a that hangs by its own weight: above 0.05; ρ/E is its
         mass over its membrane stiffness, the means of layers, patches and tapers
stretch  the largest elongation in a model's answer, at the places that the model evaluates: above one half

The rule holds for every model.
"""

import math

from sheetbench.scenes.meaning.composition import mass_over_stiffness
from sheetbench.scenes.objects.fields import SceneFields

WEIGHT_LIMIT = 0.05
STRETCH_LIMIT = 0.5


def weight_strain(scene: SceneFields) -> float:
    """Return ρ g a/E under the last factor of the weight."""
    if scene.gravity is None:
        return 0.0
    pull = math.hypot(*scene.gravity.last_acceleration) * max(scene.sheet.lengths)
    return mass_over_stiffness(scene) * pull


def outside_model(scene: SceneFields, stretch: float, what: str = "the mid-surface stretched by") -> str:
    """Return a clause on strains beyond the limits, "" within them; what: the words before the stretch."""
    weight = weight_strain(scene)
    if weight <= WEIGHT_LIMIT and stretch <= STRETCH_LIMIT:
        return ""
    return f"ρ g a/E = {weight:.3g}, {what} {stretch:.3g}"
