"""Scenes of the reference set whose sheets are not flat at rest: natural strain and curvature.

A strip of natural curvature k that nothing else loads is an arc of a circle, whose points are, with s along
it, at x = sin(k s)/k and z = (1 − cos(k s))/k: a state of zero energy (`quarter_turn`).
"""

from __future__ import annotations

from collections.abc import Iterator
from math import pi

import numpy as np

from sheetbench.scenes import Clamped, Gravity, Material, Patch, Scene, Sheet, load
from sheetbench.scenes.objects.natural import Natural
from sheetbench.scenes.objects.shapes import Rectangle, Shape

STRIP = Sheet(length_x=0.18, length_y=0.06, thickness=0.003)
RUBBER = Material(young=20e6, poisson=0.48, density=1100.0)
BAND, CURL = (0.06, 0.12), 20.0  # m, along the strip; 1/m
TURN = 0.5 * pi / STRIP.length_x  # 1/m


def scenes() -> Iterator[tuple[Scene, str]]:
    """Yield every scene, and why it is in the set."""
    yield load("bimetal-strip"), "two layers, one of which expands: large rotations by temperature"
    yield muscle_band(), "a band across a strip curls up and lifts its end against the weight"
    yield load("heated-plate"), "heated to three times where it buckles; its weight says which way"
    yield quarter_turn(), "natural curvature alone turns a strip by a quarter: an arc, in closed form"


def muscle_band() -> Scene:
    """A strip whose middle third has a natural curvature, under its weight."""
    band = Rectangle(x=BAND, y=(0.0, STRIP.length_y))
    return Scene(
        name="muscle-band",
        sheet=STRIP,
        material=RUBBER,
        gravity=Gravity(acceleration=(0.0, 0.0, -9.81)),
        supports=(Clamped(edge="x0"),),
        patches=(Patch(shape=Shape(rectangle=band), natural=Natural(curvature=(CURL, 0.0, 0.0))),),
    )


def quarter_turn() -> Scene:
    """A weightless strip that its natural curvature bends to a quarter of a circle."""
    return Scene(
        name="quarter-turn",
        sheet=STRIP,
        material=RUBBER,
        supports=(Clamped(edge="x0"),),
        natural=Natural(curvature=(TURN, 0.0, 0.0)),
    )


def arc(points: np.ndarray, curvature: float = TURN) -> np.ndarray:
    """Return displacements (n, 3) [m] of plan points (n, 2) [m] of a strip bent to an arc [1/m]."""
    along = points[:, 0]
    across = np.zeros_like(along)
    angle = curvature * along
    return np.column_stack([np.sin(angle) / curvature - along, across, (1.0 - np.cos(angle)) / curvature])
