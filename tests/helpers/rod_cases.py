"""Scenes of elastic rods on sheets, for the tests of the references' actuators."""

from typing import Any

import numpy as np
from cases import GRAVITY, RUBBER, SHEET

import fem_reference
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Chain, Clamped, Gravity, Material, Scene, Sheet

STRIP = Sheet(length_x=0.02, length_y=1.0, thickness=0.0005)
FLOPPY = Material(young=1e2, poisson=0.0, density=1e-3)  # a sheet that the rod does not feel


def chain(**settings: Any) -> Chain:
    values = {"edge": "x1", "segments": 24, "bending_stiffness": 0.2, "line_density": 0.05, "radius": 1.5e-3}
    return Chain(**{**values, **settings})


def free_rod(gravity: Gravity | None = None, sheet: Sheet = STRIP, **settings: Any) -> Scene:
    """Return a rod of length 1, EI = 1 and 1 kg/m along a floppy strip."""
    values = {"edge": "x0", "segments": 16, "bending_stiffness": 1.0, "line_density": 1.0, "radius": 1e-3}
    only = Chain(**{**values, "base": "middle", **settings})
    return Scene(name="rod", sheet=sheet, material=FLOPPY, gravity=gravity, actuators=(only,))


def driven(*actuators: Any, gravity: Gravity | None = GRAVITY) -> Scene:
    supports = (Clamped(edge="x0"),)
    return Scene(
        name="s", sheet=SHEET, material=RUBBER, gravity=gravity, supports=supports, actuators=actuators
    )


def shell(scene: Scene, elements: int | tuple[int, int] = 8) -> Solution:
    return fem_reference.solve(scene, model="shell", elements=elements)


CHAINS = {
    "normal": {"curvature": 4.0},
    "top": {"curvature": 4.0, "face": "top"},
    "bottom": {"curvature": -3.0, "face": "bottom"},
    "spatial": {"curvature": 4.0, "plane": "spatial"},
    "inplane": {"curvature": 0.05, "plane": "inplane", "bending_stiffness": 20.0},
    "list": {"curvature": tuple(np.linspace(-5.0, 8.0, 23))},
}
