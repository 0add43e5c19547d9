"""A strip held at one end that settles under its own weight, on at t = 0: the elastica in motion.

The values are those of an inextensible, damped elastica with rotary inertia: chains of 16 and 32 rigid links
extrapolated, to 0.4 mm. Settings: ν = 0, Kelvin–Voigt with τ = 10 ms, 0.18 m long. The motion is large, three
quarters of the length at first, and the sheet turns by more than a right angle.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.motion.simulation import simulate
from fem_reference.verification.rows import Row, relatively
from sheetbench.scenes import Clamped, Gravity, Material, Scene, Sheet

TOLERANCE = 6e-3  # of the largest displacement: half is the values' own
EVERY = 0.05
ELEMENTS = (8, 2)
SOURCE = "this project, rigid links"
PUBLISHED = 1e-3 * np.array(
    [  # ux, uz of the tip [mm] every 50 ms
        [-0.756, -13.417], [-13.122, -65.063], [-61.467, -127.148], [-133.009, -160.058],
        [-198.598, -153.861], [-224.831, -136.325], [-205.646, -144.299], [-139.499, -160.936],
        [-69.481, -135.038],
        [-26.215, -88.400], [-5.437, -42.569], [-2.203, -26.967], [-6.202, -45.224], [-25.335, -87.791],
        [-71.488, -134.887], [-135.365, -159.298], [-187.784, -155.716], [-206.000, -146.453],
        [-183.413, -153.295], [-123.745, -157.994], [-65.623, -131.567], [-28.447, -91.991],
        [-10.370, -58.082], [-7.825, -50.697], [-16.194, -71.308], [-41.625, -108.998], [-88.638, -144.590],
        [-143.543, -159.573], [-182.026, -155.935], [-188.370, -152.388],
    ]
)  # fmt: skip


def scene() -> Scene:
    """The strip, its tip the only probe."""
    return Scene(
        name="settling-strip",
        sheet=Sheet(length_x=0.18, length_y=0.09, thickness=0.002),
        material=Material(young=12e6, poisson=0.0, density=1100.0, damping_time=0.01),
        gravity=Gravity(acceleration=(0.0, 0.0, -9.81)),
        supports=(Clamped(edge="x0"),),
        probes={"tip": (0.18, 0.045)},
    )


def rows() -> Iterator[Row]:
    """The tip's largest difference from the values over its largest displacement, of ux and uz."""
    off = differences(1.5, ELEMENTS)
    mesh = f"shell {ELEMENTS[0]} × {ELEMENTS[1]}"
    for component, largest in zip(("ux", "uz"), off.max(axis=0), strict=True):
        quantity = f"{component} of the tip over 1.5 s, largest difference over the peak"
        yield relatively(quantity, mesh, 0.0, SOURCE, float(largest), TOLERANCE, scale=1.0)


def differences(duration: float, elements: tuple[int, int]) -> np.ndarray:
    """Differences (n, 2) of ux and uz of the tip every 50 ms, over the largest published displacement."""
    motion = simulate(scene(), "shell", duration, elements=elements, graded=False, every=EVERY)
    ours = motion.probes["tip"][1:, [0, 2]]
    off: np.ndarray = np.abs(ours - PUBLISHED[: len(ours)]) / np.abs(PUBLISHED).max()
    return off
