"""What can be sought in a scene: its parameters by name, where they sit, and how they are varied.

Each is varied through a dimensionless x, 0 at the scene's own value: parameters above zero by their
logarithm, value = start·eˣ; Poisson's ratio and a clamp's tilt by x = value − start; a curvature by
x = (value − start) · longer side.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, inf, log
from typing import Any

from sheetbench.scenes import Chain, Clamped, Curved, Scene
from sheetbench.scenes.corners import conflict
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.supports import LARGEST_TILT, contradiction

_MATERIAL = {"young": "Pa", "poisson": "", "density": "kg/m³", "damping_time": "s", "damping_rate": "1/s"}
DAMPING = ("damping_time", "damping_rate")
NAMES = (*_MATERIAL, "thickness", "curvature_EDGE", "tilt_EDGE")
FARTHEST = 1e6  # times the scene's own value, up or down, that a parameter above zero is sought
_POISSON = (-0.99, 0.4999)


@dataclass(frozen=True)
class Unknown:
    """A parameter of a scene: its name and unit, the value the scene gives it, bounds, and the unit of x."""

    name: str
    unit: str
    start: float
    low: float
    high: float
    step: float | None = None

    def value(self, x: float) -> float:
        """The parameter at x."""
        return self.start * exp(float(x)) if self.step is None else self.start + self.step * float(x)

    def slope(self, x: float) -> float:
        """d(value)/dx."""
        return self.value(x) if self.step is None else self.step

    @property
    def turns(self) -> bool:
        """Whether another value may turn the deflection over: of supports, not of the sheet."""
        return self.name.startswith(("curvature_", "tilt_"))

    def bounds(self) -> tuple[float, float]:
        """Of x."""
        if self.step is None:
            return -log(FARTHEST), log(FARTHEST)
        return (self.low - self.start) / self.step, (self.high - self.start) / self.step

    def interval(self, x: float, half_width: float) -> tuple[float, float]:
        """Values at x ± half_width, within the bounds."""
        least, most = self.bounds()
        return (
            self.value(x - half_width) if x - half_width > least else self.low,
            self.value(x + half_width) if x + half_width < most else self.high,
        )


def unknown(scene: Scene, name: str) -> Unknown:
    """A parameter of this scene. Raises BadInput where there is none of that name, or it has no value yet."""
    if name == "poisson":
        return Unknown(name, "", scene.material.poisson, *_POISSON, step=1.0)
    if name in _MATERIAL:
        return _positive(scene, name, _MATERIAL[name], getattr(scene.material, name))
    if name == "thickness":
        return _positive(scene, name, "m", scene.sheet.thickness)
    if name.startswith("curvature_"):
        edge = name.removeprefix("curvature_")
        bent = [h for h in (*scene.supports, *scene.actuators) if isinstance(h, Curved | Chain)]
        values = [h.curvature for h in bent if h.edge == edge and isinstance(h.curvature, int | float)]
        if values:
            return Unknown(name, "1/m", values[0], -inf, inf, 1.0 / max(scene.sheet.lengths))
        raise BadInput(f"unknown = '{name}': edge '{edge}' has no support or actuator of one curvature")
    if name.startswith("tilt_"):
        return _tilt(scene, name, name.removeprefix("tilt_"))
    raise BadInput(f"unknown = '{name}': cannot be sought; choose from {', '.join(NAMES)}")


def _positive(scene: Scene, name: str, unit: str, value: float) -> Unknown:
    if value == 0.0:
        raise BadInput(
            f"unknown = '{name}': scene '{scene.name}' has it at 0; give a first guess above 0 there"
        )
    return Unknown(name, unit, value, 0.0, inf)


def _tilt(scene: Scene, name: str, edge: str) -> Unknown:
    for clamp in scene.supports:
        if isinstance(clamp, Clamped) and clamp.edge == edge:
            turned = put(scene, name, clamp.tilt or LARGEST_TILT)
            said = contradiction(turned.supports)
            if said := said or conflict(scene.actuators, turned.supports, scene.sheet):
                raise BadInput(f"unknown = '{name}': supports and actuators allow no tilt there: {said}")
            return Unknown(name, "rad", clamp.tilt, -LARGEST_TILT, LARGEST_TILT, step=1.0)
    raise BadInput(f"unknown = '{name}': edge '{edge}' has no clamp")


def put(scene: Scene, name: str, value: float) -> Scene:
    """The scene with the parameter at another value."""
    if name in _MATERIAL:
        return scene.model_copy(update={"material": scene.material.model_copy(update={name: value})})
    if name == "thickness":
        return scene.model_copy(update={"sheet": scene.sheet.model_copy(update={name: value})})
    if name.startswith("tilt_"):
        edge = name.removeprefix("tilt_")
        supports = tuple(
            s.model_copy(update={"tilt": value}) if s.edge == edge and isinstance(s, Clamped) else s
            for s in scene.supports
        )
        return scene.model_copy(update={"supports": supports})
    edge = name.removeprefix("curvature_")

    def bent(holders: tuple[Any, ...]) -> tuple[Any, ...]:
        return tuple(
            h.model_copy(update={"curvature": value})
            if h.edge == edge and isinstance(h, Curved | Chain)
            else h
            for h in holders
        )

    return scene.model_copy(update={"supports": bent(scene.supports), "actuators": bent(scene.actuators)})
