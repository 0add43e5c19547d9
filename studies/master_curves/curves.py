"""Strips whose answer depends on one number alone: curves that any code can be laid over (Romero et al. 2021,
ACM Trans. Graph. 40(4), use the first two to judge simulators).

cantilever    under its own weight, by Γ = ρ_A g L³/B, ρ_A the mass per area and B the bending stiffness per
              width (ν = 0 here, B = E h³/12)
on edge       clamped at one end, by Γ* = 12 (1 − ν²) ρ g L³/(E h²): leaves its plane at a Γ* that depends on
              its width over its length, and earlier where it leans
bend-twist    clamped with its plane turned by 45° about its length, by Γ (ν = 0)

Lengths, density and weight are fixed, and Young's modulus makes the number.
"""

from collections.abc import Sequence
from math import cos, pi, sin

import numpy as np

from sheetbench.scenes import Clamped, Gravity, Material, Scene, Sheet

LENGTH, DENSITY, GRAVITY = 0.2, 1000.0, 9.81  # m, kg/m³, m/s²
THICKNESS, SLENDER = 0.005, 0.002  # over length, of cantilevers and of other strips
WIDTH, NARROW = 0.25, 0.1  # over length, of cantilevers and of other strips
POISSON = 0.35  # of strips on edge
TURNED = pi / 4
TIP = "tip"


def cantilever(load: float) -> Scene:
    """Return a cantilever at Γ = load."""
    return _strip("cantilever", load, (WIDTH, THICKNESS), 0.0, 0.0)


def on_edge(load: float, width: float = NARROW, off: float = 0.0) -> Scene:
    """Return a strip on edge at Γ* = load; off: inclination of its plane [rad]."""
    return _strip("on-edge", load, (width, SLENDER), POISSON, pi / 2 - off)


def bend_twist(load: float, width: float = NARROW) -> Scene:
    """Return a strip whose plane is turned by 45°, at Γ = load."""
    return _strip("bend-twist", load, (width, SLENDER), 0.0, TURNED)


def way(scene: Scene, moved: Sequence[float] | np.ndarray) -> tuple[float, float, float]:
    """Return the tip's displacement over the length: along the strip, downwards, and perpendicular to
    both."""
    assert scene.gravity is not None
    _, y, z = (value / GRAVITY for value in scene.gravity.acceleration)
    along, u, v = (float(value) / LENGTH for value in moved)
    return along, u * y + v * z, v * y - u * z


def _strip(name: str, load: float, over: tuple[float, float], poisson: float, turned: float) -> Scene:
    width, thickness = (LENGTH * share for share in over)
    young = 12.0 * (1.0 - poisson**2) * DENSITY * GRAVITY * LENGTH**3 / (load * thickness**2)
    return Scene(
        name=f"{name}-{load:g}",
        sheet=Sheet(length_x=LENGTH, length_y=width, thickness=thickness),
        material=Material(young=young, poisson=poisson, density=DENSITY),
        supports=(Clamped(edge="x0"),),
        gravity=Gravity(acceleration=(0.0, -GRAVITY * sin(turned), -GRAVITY * cos(turned))),
        probes={TIP: (LENGTH, width / 2.0)},
    )
