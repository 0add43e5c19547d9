"""Whether what holds a sheet and what loads it are in balance, as an answer has them.

    Σ reactions + Σ loads = 0,    Σ moments = 0 about the origin of the flat sheet's frame

Reactions are those that the answer lists: what it leaves out is missing here. The force of the dead loads is
the scene's own, from density, sides and loads, and not what a model has made of it; followers'
forces, and all moments, depend on the shape and are those on the sheet as it lies (a linear model's on the
flat one). What is left over is compared with what the model's own tolerance and rounding may leave.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from sheetbench.scenes.meaning.composition import carried, mass_of
from sheetbench.scenes.meaning.region import edge_length, resultant
from sheetbench.scenes.objects.actuators import Chain
from sheetbench.scenes.objects.loads import Pressure
from sheetbench.scenes.objects.sheet import EDGES
from sheetbench.scenes.scene import Scene


@dataclass(frozen=True)
class Balance:
    """What an answer's forces leave over: force (3,) [N], moment (3,) [N·m].

    size: of the forces that balance, as the model measures its residual [N]; allowed: force [N] that its
    tolerance and rounding may leave; arm: [m], by which a force of that size may leave a moment.
    objective: whether the model's law keeps moments at all.
    """

    force: np.ndarray
    moment: np.ndarray
    size: float
    allowed: float
    arm: float
    objective: bool = True

    @property
    def left(self) -> float:
        """The larger of the force and of the moment over the arm [N]."""
        moment = math.hypot(*self.moment.tolist()) / self.arm if self.objective else 0.0
        return max(math.hypot(*self.force.tolist()), moment)

    @property
    def relative(self) -> float:
        """`left` over the size of the forces; 0 where there are none."""
        return self.left / self.size if self.size > 0.0 else 0.0

    @property
    def holds(self) -> bool:
        """Whether no more is left than allowed."""
        return self.left <= self.allowed

    def in_words(self) -> str:
        """What is left over, in a clause."""
        force, moment = (float(np.linalg.norm(part)) for part in (self.force, self.moment))
        share = f"{self.relative:.1g} of all"
        return f"forces out of balance by {force:.2g} N, moments by {moment:.2g} N·m ({share})"

    def document(self) -> dict[str, Any]:
        """For JSON: N, N·m, and what is left as a fraction of the forces."""
        return {
            "force": self.force.tolist(),
            "moment": self.moment.tolist(),
            "relative": self.relative,
            "holds": self.holds,
        }


def dead_force(
    scene: Scene, mass: float | None = None, lengths: dict[str, float] | None = None
) -> np.ndarray:
    """The force (3,) [N] of all dead loads, with the last factors of their histories.

    mass [kg] of the sheet and lengths [m] by edge: as a model has them, where its outline or what it is made
    of is not the scene's to the last digit.
    """
    named = {getattr(acting, "edge", None) for acting in (*scene.actuators, *scene.loads)}
    sides = {name: edge_length(scene, name) for name in EDGES if name in named} | (lengths or {})
    total = np.zeros(3)
    if scene.gravity is not None:
        mass = carried(scene) + (mass_of(scene) if mass is None else mass)
        mass += sum(c.line_density * sides[c.edge] for c in scene.actuators if isinstance(c, Chain))
        total += mass * np.array(scene.gravity.last_acceleration)
    for load in scene.loads:
        if not isinstance(load, Pressure):
            total += load.last_factor * resultant(scene, load, sides.get(getattr(load, "edge", "")))
    return total
