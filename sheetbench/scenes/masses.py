"""A payload on the sheet: a body at a point, or a mass spread evenly over a part of it.

It has weight under gravity and inertia in motion, and no stiffness. A body with the principal moments of
inertia I about its point is, moving with the sheet, what its second moments P are on the position φ:

    T = ½ m |φ̇|² + ½ (Pxx |φ̇,x|² + Pyy |φ̇,y|² + Pzz |ḋ|²),    Pxx = ½ (Iyy + Izz − Ixx), …

with the director d: a point X, Y, Z of the body is at φ + X φ,x + Y φ,y + Z d. All of it is linear in the
coordinates, so that the mass matrix is constant however far the sheet turns. Source: the kinetic energy of a
rigid body by its second moments; e.g. Wittenburg, Dynamics of Multibody Systems, 2008, 3.3.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import Field, model_validator

from sheetbench.scenes.loads import AreaLoad, PointLoad
from sheetbench.scenes.quantities import Frozen, NonNegative, PlanPoint, Positive, Unit
from sheetbench.scenes.region import area_in
from sheetbench.scenes.shapes import Shape

if TYPE_CHECKING:
    from sheetbench.scenes.scene import Scene

ROUNDING = 1e-9  # of the largest moment of inertia


class Mass(Frozen):
    """A payload: a body at a point of the mid-surface, or a mass spread evenly over a part of it."""

    at: Annotated[PlanPoint, Unit("m")] | None = None
    """Plan point [x, y] of the undeformed sheet where it is; or `where`."""
    mass: Annotated[Positive, Unit("kg")]
    """Of the whole payload; it weighs under gravity and is inert in motion."""
    where: Shape | None = None
    """In place of `at`: the part of the sheet over which it is spread evenly, in the mid-surface."""
    inertia: Annotated[tuple[NonNegative, NonNegative, NonNegative], Unit("kg·m²")] | None = Field(
        default=None, kw_only=True
    )
    """Moments of inertia about x, y and z through the point `at`, of a body that turns with the sheet there;
    without them it is a point."""

    @model_validator(mode="after")
    def _consistent(self) -> Mass:
        if (self.at is None) == (self.where is None):
            raise ValueError("give one of at, a point [x, y], and where, a part of the sheet")
        if self.inertia is None:
            return self
        if self.at is None:
            raise ValueError("inertia: is of a body at a point; with where leave it out")
        if min(self._unrounded) < -ROUNDING * max(self.inertia):
            given = f"inertia = {list(self.inertia)} kg·m²"
            raise ValueError(f"{given}: no body has these; none is more than the sum of the two others")
        return self

    @property
    def second_moments(self) -> tuple[float, float, float]:
        """∫ X², ∫ Y² and ∫ Z² dm [kg m²] about the point."""
        x, y, z = (max(0.0, moment) for moment in self._unrounded)
        return x, y, z

    @property
    def _unrounded(self) -> tuple[float, float, float]:
        x, y, z = self.inertia or (0.0, 0.0, 0.0)
        return 0.5 * (y + z - x), 0.5 * (x + z - y), 0.5 * (x + y - z)


def carried(scene: Scene) -> float:
    """Return the mass [kg] of all payloads."""
    return sum(payload.mass for payload in scene.masses)


def weights(scene: Scene) -> tuple[PointLoad | AreaLoad, ...]:
    """Return the payloads' weight as loads, with gravity's history; none without gravity."""
    if scene.gravity is None:
        return ()
    found: list[PointLoad | AreaLoad] = []
    for payload in scene.masses:
        x, y, z = (payload.mass * np.array(scene.gravity.acceleration)).tolist()
        if payload.at is not None:
            found.append(PointLoad(at=payload.at, force=(x, y, z), history=scene.gravity.history))
            continue
        area = area_in(scene, payload.where)
        spread = AreaLoad(force_per_area=(x / area, y / area, z / area), where=payload.where)
        found.append(spread.replace(history=scene.gravity.history))
    return tuple(found)


def weighed(scene: Scene) -> Scene:
    """Return the scene with its payloads' weight in place of them, which at rest is the same: for programs
    that know loads and no payloads."""
    return scene.replace(masses=(), loads=(*scene.loads, *weights(scene))) if scene.masses else scene
