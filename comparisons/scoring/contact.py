"""Scenes of the reference set whose sheets touch something: strips without Poisson's ratio, as the elastica.

Strips of length L = 1 m, width 0.1 m, thickness 5 mm: B/w = 0.01 L³ of the heavy ones, B = 1 N m of the
weightless. Positions of obstacles are half a thickness off, so that the mid-surface touches where it is said.
"""

from __future__ import annotations

from collections.abc import Iterator

from sheetbench.scenes import (
    Clamped,
    Cylinder,
    EdgeLoad,
    Gravity,
    Load,
    Material,
    Plane,
    Pressure,
    Scene,
    Sheet,
)
from sheetbench.scenes.objects.obstacles import AnyObstacle
from sheetbench.scenes.objects.supports import Motion

GRAVITY, DENSITY = 9.81, 1e3
STRIP = Sheet(length_x=1.0, length_y=0.1, thickness=0.005)
HALF = STRIP.thickness / 2
DROPS = (0.05, 0.2)  # m
PROBES = {"P1": (0.2, 0.05), "P2": (0.4, 0.05), "P3": (0.7, 0.05), "P4": (1.0, 0.05)}


def scenes() -> Iterator[tuple[Scene, str]]:
    """Yield every scene, and why it is in the set."""
    yield laid(DROPS[0]), "a heavy strip lies down on a plane: where it lifts off is part of the answer"
    yield laid(DROPS[1]), "the same from four times as high: large rotations, and less of it lies"
    yield over_cylinder(), "a strip bent over a cylinder: the place of contact moves along both"
    yield pressed(), "a plate comes down on a strip that a pressure lifts: between plate and clamp"


def laid(drop: float) -> Scene:
    """A heavy strip, clamped at a height above a plane on which it lies down."""
    return _strip(
        f"laid-{drop:g}",
        Plane(position=(0.0, 0.0, -drop - HALF)),
        young=0.12 * DENSITY * GRAVITY / STRIP.thickness**2,
        gravity=Gravity(acceleration=(0.0, 0.0, -GRAVITY)),
    )


def over_cylinder() -> Scene:
    """A weightless strip whose end is pulled down, 6 B/L², over a cylinder."""
    return _strip(
        "over-cylinder",
        Cylinder(position=(0.4, 0.0, -0.15), axis=(0.0, 1.0, 0.0), radius=0.15 - HALF),
        loads=(EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, -6.0)),),
    )


def pressed() -> Scene:
    """A weightless strip that a pressure lifts from its clamp against a plate, which comes down on it."""
    down = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, -0.15)))
    plate = Plane(position=(0.0, 0.0, 0.3 + HALF), normal=(0.0, 0.0, -1.0), motion=down)
    return _strip("pressed", plate, loads=(Pressure(value=20.0),))


def _strip(
    name: str,
    obstacle: AnyObstacle,
    young: float = 12.0 / STRIP.thickness**3,
    gravity: Gravity | None = None,
    loads: tuple[Load, ...] = (),
) -> Scene:
    return Scene(
        name=name,
        sheet=STRIP,
        material=Material(young=young, poisson=0.0, density=DENSITY),
        gravity=gravity,
        supports=(Clamped(edge="x0"),),
        loads=loads,
        obstacles=(obstacle,),
        probes=PROBES,
    )
