"""The kinds of obstacle, rigid bodies that the sheet touches: a plane, a sphere, a cylinder, a box.

Positions are of the obstacle's own surface: with φ(x) the distance of a point of the mid-surface from it, the
sheet touches where φ = h/2. A plane that the flat sheet lies on is at z = −h/2.
"""

import math
from collections.abc import Iterator
from typing import Annotated, ClassVar, Literal

import numpy as np
from pydantic import Field

from sheetbench.scenes.objects.quantities import Frozen, Length, NonNegative, Unit, Vector3
from sheetbench.scenes.objects.supports import Motion

SLIP_SPEED = 1e-3  # m/s, v₀ of the friction −μ p v/√(v² + v₀²)
CREEPS = f"friction is regularised below {1e3 * SLIP_SPEED:g} mm/s, so that sticking points creep"
TOUCH = 1e-9  # δ₀, of the thickness: how far off a sheet touches, or an obstacle would not hold one that lies


class _Obstacle(Frozen):
    position: Annotated[Vector3, Unit("m")]
    """A point of the plane, the sphere's or box's centre, a point of the cylinder's axis."""
    motion: Motion | None = Field(default=None, kw_only=True)
    """How the obstacle moves over time; at rest it stands where its motion ends."""
    friction: NonNegative = Field(default=0.0, kw_only=True)
    """Coefficient of friction, in motion only."""
    contact_damping: Annotated[NonNegative, Unit("s/m")] = Field(default=0.0, kw_only=True)
    """Time τ, in motion only: the pressure is k d (1 + τ ḋ) at a depth d; a part of the sheet that meets the
    obstacle at a speed v ≪ 1/τ leaves it at about (1 − 2 τ v/3) v."""

    def _faults(self) -> Iterator[object]:
        for key, vector in self:
            yield key in ("normal", "axis") and not any(vector) and f"{key}: needs a direction, not [0, 0, 0]"

    @property
    def direction(self) -> np.ndarray:
        """Unit vector (3,) along a plane's normal or a cylinder's axis; zero for a sphere and a box."""
        along = np.array(getattr(self, "normal", getattr(self, "axis", (0.0, 0.0, 0.0))))
        return np.asarray(along / (np.linalg.norm(along) or 1.0))

    @property
    def core(self) -> np.ndarray:
        """Half-lengths (3,) [m] of a box without its rounding; zero for other kinds."""
        return np.zeros(3)

    def place(self, load_factor: float = 1.0, time: float | None = None) -> np.ndarray:
        """Return the obstacle's position (3,) [m] after a share `load_factor` of its displacement at a time
        [s], by default the last."""
        moved = np.zeros(3) if self.motion is None else self.motion.course.at(time)
        return np.asarray(self.position + load_factor * moved)

    def velocity(self, time: float | None) -> np.ndarray:
        """Return the obstacle's velocity (3,) [m/s] at a time [s], zero for None."""
        return np.zeros(3) if self.motion is None or time is None else self.motion.course.slope(time)


class Plane(_Obstacle):
    """A half space below a plane."""

    kind: Literal["plane"] = Field(default="plane", kw_only=True)
    normal: Vector3 = (0.0, 0.0, 1.0)
    """Direction out of the obstacle, towards the sheet, of any length."""

    radius: ClassVar[float] = math.inf


class Sphere(_Obstacle):
    """A ball."""

    kind: Literal["sphere"] = Field(default="sphere", kw_only=True)
    radius: Length
    """Radius of the ball."""


class Cylinder(_Obstacle):
    """A round bar without ends."""

    kind: Literal["cylinder"] = Field(default="cylinder", kw_only=True)
    axis: Vector3
    """Direction along the bar, of any length."""
    radius: Length
    """Radius of the bar."""


class Box(_Obstacle):
    """A box with sides along the axes, its edges and corners rounded."""

    kind: Literal["box"] = Field(default="box", kw_only=True)
    size: Annotated[tuple[Length, Length, Length], Unit("m")]
    """Sides along x, y and z."""
    radius: Length
    """Radius of the edges, at most half the shortest side."""

    def _faults(self) -> Iterator[object]:
        yield 2.0 * self.radius > min(self.size) and f"radius: {self.radius:g} is more than half a side"

    @property
    def core(self) -> np.ndarray:
        return np.asarray(0.5 * np.array(self.size) - self.radius)


AnyObstacle = Plane | Sphere | Cylinder | Box
Obstacle = Annotated[AnyObstacle, Field(discriminator="kind")]
