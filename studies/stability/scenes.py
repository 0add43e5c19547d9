"""Scenes of the study: three published ones, a strip pressed along its length, sheets on bent clamps.

The Euler load of the clamped-free strip is π² E h³/48a² per width; a slight weight chooses its side. A clamp
bent to curvature κ stands out like a tape spring, which its weight folds where L/2 = (1 ± ν)|κ a|, with
L = ρ g h a³/D (Wüst 1954, Seffen and Pellegrino 1999): κ > 0 lifts the ends of the edge, the weight acts
along −z.
"""

from typing import Any

import numpy as np

from sheetbench.scenes import Clamped, Curved, EdgeLoad, Gravity, Material, Scene, Sheet, load
from sheetbench.scenes.objects.sheet import EdgeName

PUBLISHED = ("two-edges-clamped", "one-edge-clamped", "curved-edge")
SIDE, GRAVITY, POISSON = 0.188, 9.81, 0.48  # of Habibi et al.'s sheet, of the Earth
TURNS = (-1.0, -0.5, -0.25, -0.1, 0.1, 0.25, 0.5, 1.0)  # of the clamp's ends, of a full circle


def sheet(
    slenderness: float,
    load_number: float,
    edges: tuple[EdgeName, ...] = ("x0",),
    young: float = 1e7,
    poisson: float = POISSON,
    **more: Any,
) -> Scene:
    """Return a square sheet clamped at `edges` under its own weight, by thickness/side and ρ g h a³/D."""
    thickness = slenderness * SIDE
    rigidity = young * thickness**3 / 12.0 / (1.0 - poisson**2)
    density = abs(load_number) * rigidity / (GRAVITY * thickness * SIDE**3)
    return Scene(
        name="-and-".join(edges) + "-clamped",
        sheet=Sheet(length_x=SIDE, length_y=SIDE, thickness=thickness),
        material=Material(young=young, poisson=poisson, density=density or 1.0),
        gravity=Gravity(acceleration=(0.0, 0.0, -np.sign(load_number) * GRAVITY)),
        **{"supports": tuple(Clamped(edge=edge) for edge in edges), **more},
    )


def published() -> list[Scene]:
    """Return the three published scenes."""
    return [load(name) for name in PUBLISHED]


def pressed() -> Scene:
    """Return a strip under its Euler load and a weight of 0.02 of its load number."""
    scene = sheet(0.016, 0.02)
    euler = np.pi**2 * scene.material.young * scene.sheet.thickness**3 / 48.0 / SIDE**2
    return scene.replace(
        name="pressed", loads=(EdgeLoad(edge="x1", force_per_length=(-float(euler), 0.0, 0.0)),)
    )


def bent(turn: float) -> Scene:
    """Return a sheet on a clamp bent to a share of a full circle, load number 0.1."""
    scene = sheet(0.008, 0.1, supports=(Curved(edge="x0", curvature=2.0 * np.pi * turn / SIDE),))
    return scene.replace(name=f"bent-{'up' if turn > 0.0 else 'down'}-{abs(turn):g}")
