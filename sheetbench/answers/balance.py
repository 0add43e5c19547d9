"""Balance of the reactions and loads of an answer.

    Σ reactions + Σ loads = 0,    Σ moments = 0 about the origin of the flat sheet's frame

The sum contains the reactions that the answer lists, so that a missing one shows. The force of the dead loads
is computed from the scene, by density, sides and loads, not from a model. Followers' forces and all moments
depend on the shape: they are computed on the deformed sheet, for a linear model on the flat one. The residual
is compared with the model's tolerance and rounding.
"""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from sheetbench.scenes.meaning.composition import mass_of, payload_mass
from sheetbench.scenes.meaning.region import edge_length, resultant
from sheetbench.scenes.objects.actuators import Chain
from sheetbench.scenes.objects.loads import Pressure
from sheetbench.scenes.objects.sheet import EDGES
from sheetbench.scenes.scene import Scene


@dataclass(frozen=True)
class Balance:
    """Residual of an answer's forces (3,) [N] and moments (3,) [N·m].

    size: size of the forces in balance [N], in the measure of the model's residual. allowed: residual [N] due
    to the model's tolerance and rounding. arm: [m], the allowed moment over the allowed force. objective:
    whether the model's law preserves moments.
    """

    force: np.ndarray
    moment: np.ndarray
    size: float
    allowed: float
    arm: float
    objective: bool = True

    @property
    def residual(self) -> float:
        """Return the larger of the force and of the moment over the arm [N]."""
        moment = math.hypot(*self.moment.tolist()) / self.arm if self.objective else 0.0
        return max(math.hypot(*self.force.tolist()), moment)

    @property
    def relative(self) -> float:
        """Return `residual` over the size of the forces; 0 without forces."""
        return self.residual / self.size if self.size > 0.0 else 0.0

    @property
    def holds(self) -> bool:
        """Return whether the residual is within the allowed one."""
        return self.residual <= self.allowed

    def in_words(self) -> str:
        """Return a clause on the residual."""
        force, moment = (float(np.linalg.norm(part)) for part in (self.force, self.moment))
        share = f"{self.relative:.1g} of all"
        return f"forces out of balance by {force:.2g} N, moments by {moment:.2g} N·m ({share})"

    def document(self) -> dict[str, Any]:
        """Return the residual for JSON: N, N·m, and as a fraction of the forces."""
        residual = {"force": self.force.tolist(), "moment": self.moment.tolist()}
        return {**residual, "relative": self.relative, "holds": self.holds}


def dead_force(
    scene: Scene, mass: float | None = None, lengths: dict[str, float] | None = None
) -> np.ndarray:
    """Return the force (3,) [N] of all dead loads, with the last factors of their histories.

    mass: the sheet's mass [kg] in a model, and lengths: its edges' lengths [m], if a model's outline or
    composition differs from the scene's.
    """
    named = {getattr(acting, "edge", None) for acting in (*scene.actuators, *scene.loads)}
    sides = {name: edge_length(scene, name) for name in EDGES if name in named} | (lengths or {})
    total = np.zeros(3)
    if scene.gravity is not None:
        mass = payload_mass(scene) + (mass_of(scene) if mass is None else mass)
        mass += sum(c.line_density * sides[c.edge] for c in scene.actuators if isinstance(c, Chain))
        total += mass * np.array(scene.gravity.last_acceleration)
    for load in scene.loads:
        if not isinstance(load, Pressure):
            total += load.last_factor * resultant(scene, load, sides.get(getattr(load, "edge", "")))
    return total
