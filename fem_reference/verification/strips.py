"""Strips held at x = 0: bent far, settling under their weight, with fibres.

A shear force at the end of a strip of 10 × 1 × 0.1, E 1.2e6, ν 0 (section 3.1), and a moment up to 50π/3 that
rolls a strip of 12 × 1 × 0.1 up to a full circle (section 3.2), exact for the inextensible elastica and, with
ν = 0 and except for a stretch of (h/R)²/12, for the shell:

    −u = L − (EI/M) sin(ML/EI),    w = (EI/M) (1 − cos(ML/EI)).

Nothing is singular: rolled into half a circle, so thin that its stretch is below 1e-9, the strip also
measures the order of the shell under large rotations. The tip converges like the energy: order 4, twice the
strains'.

The weight of a strip, the heavy elastica:

    EI θ'' = q (L − s) cos θ,    θ(0) = 0,    θ'(L) = 0

One number, qL³/EI, determines its shape. The values are this project's solution of that equation by
collocation, its five digits checked by a test; a strip of h/L = 0.01 agrees to within 1e-4 (its stretch and
transverse shear). The settling strip, weight on at t = 0, ν 0, Kelvin–Voigt with τ = 10 ms, 0.18 m long, is
compared with an inextensible, damped elastica with rotary inertia: chains of 16 and 32 rigid links
extrapolated, to 0.4 mm. The sheet turns by more than a right angle.

A long strip with fibres at θ, pulled, is as stiff as 1/E_x = c⁴/E₁ + (1/G₁₂ − 2 ν₁₂/E₁) s² c² + s⁴/E₂.
Sources: Sze, Liu & Lo, Popular benchmark problems for geometric nonlinear analysis of shells, Finite Elements
in Analysis and Design 40 (2004) 1551–1569; of the heavy elastica Wang, A critical review, Int. J. Mech. Sci.
28 (1986) 549–559; of fibres Jones, Mechanics of Composite Materials (1999), 2.8.
"""

from collections.abc import Iterator
from itertools import product
from math import cos, pi, sin
from typing import Any

import numpy as np

from fem_reference.motion.simulation import simulate
from fem_reference.verification.rows import EXACT, Row, convergence, curve, relative_row
from fem_reference.verification.specimens import E1, E2, FIBRES, NU, G, specimen, u_at
from sheetbench.scenes import Clamped, EdgeLoad, Gravity, Material, Scene, Sheet

ELEMENTS = 16
MESHES = {model: f"{model} {ELEMENTS} × 1" for model in ("shell", "solid")}
FORCE = 4.0
SHEARED = {0.25: (0.563, 3.015), 0.5: (1.604, 4.933), 0.75: (2.541, 6.031), 1.0: (3.286, 6.698)}
LENGTH, YOUNG, THICKNESS = 12.0, 1.2e6, 0.1
SHARES, ROLLED = (0.25, 0.5, 1.0), 2e-3  # of the moment; tolerance
THIN, HALF_CIRCLE, OF_ORDER = 1e-3, 0.5, (8, 16)  # thickness, share of the moment, elements
LARGEST, ORDER = 5e-5, 4.0  # error on the finest mesh, of the length
HEAVY = {
    0.5: (0.06231, 0.00222),
    1.0: (0.12347, 0.00875),
    2.0: (0.23851, 0.03311),
    5.0: (0.49591, 0.15334),
    10.0: (0.70020, 0.34365),
    20.0: (0.82988, 0.55477),
}
SETTLING, EVERY = 6e-3, 0.05  # tolerance, of the largest displacement: half is the values' own; time [s]
IN_MOTION = (8, 2)  # elements
TIPS = 1e-3 * np.array(
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


def end_shear() -> Iterator[Row]:
    """Yield −u and w of the tip at each share of the force."""
    names = "−u at P = {:g} P_max", "w at P = {:g} P_max"
    yield from curve(names, MESHES, SHEARED, "Sze, Liu & Lo 2004, 3.1", 5e-3, sheared, ELEMENTS)


def roll_up() -> Iterator[Row]:
    """Yield −u and w of the tip at each share of the moment, relative to the length where exactly 0."""
    names, exact = ("−u at M = {:g} M_max", "w at M = {:g} M_max"), {s: closed_form(s) for s in SHARES}
    yield from curve(names, {"shell": MESHES["shell"]}, exact, EXACT, ROLLED, rolled, ELEMENTS, LENGTH)


def order() -> Iterator[Row]:
    """Yield the error of the tip over the length, and its order, of the strip rolled up."""
    exact = closed_form(HALF_CIRCLE)
    errors = [np.abs(rolled("shell", HALF_CIRCLE, n, THIN) - exact).max() / LENGTH for n in OF_ORDER]
    yield from convergence("of the tip", f"shell {OF_ORDER[-1]} × 1", errors, LARGEST, ORDER)


def heavy_elastica() -> Iterator[Row]:
    """Yield drop w/L and shortening u/L of the tip at each load."""
    names = "w/L at qL³/EI = {:g}", "u/L at qL³/EI = {:g}"
    yield from curve(names, MESHES, HEAVY, "this project, collocation", 2e-3, hanging, ELEMENTS)


def settling() -> Iterator[Row]:
    """Yield the tip's largest difference from the values over its largest displacement, of ux and uz."""
    motion = simulate(settling_scene(), "shell", 1.5, elements=IN_MOTION, graded=False, every=EVERY)
    off = np.abs(motion.probes["tip"][1:, [0, 2]] - TIPS).max(axis=0) / np.abs(TIPS).max()
    mesh, source = f"shell {IN_MOTION[0]} × {IN_MOTION[1]}", "this project, rigid links"
    for component, largest in zip(("ux", "uz"), off, strict=True):
        quantity = f"{component} of the tip over 1.5 s, largest difference over the peak"
        yield relative_row(quantity, mesh, 0.0, source, largest, SETTLING, scale=1.0)


def off_axis() -> Iterator[Row]:
    """Yield E_x/E₂ of strips with fibres at 15, 30 and 60°, from the stretch of their middle third."""
    sheet, pull = Sheet(length_x=1.0, length_y=0.04, thickness=1e-3), 1e-6 * E2 * 1e-3
    load = EdgeLoad("x1", force_per_length=(pull, 0.0, 0.0))
    for model, degrees in product(("plate", "shell"), (15, 30, 60)):
        angle = pi * degrees / 180.0
        c, s = cos(angle), sin(angle)
        exact = 1.0 / (c**4 / E1 + (1.0 / G - 2.0 * NU / E1) * s**2 * c**2 + s**4 / E2)
        scene = specimen(sheet, FIBRES.replace(angle=angle), (Clamped("x0"),), loads=(load,))
        low, high = (u_at(scene, (x, 0.02), model, (60, 4))[0] for x in (0.4, 0.7))
        modulus = pull / sheet.thickness * 0.3 / (high - low)
        yield relative_row(f"E_x/E2 at {degrees}°", f"{model} 60 × 4", exact / E2, EXACT, modulus / E2, 5e-3)


def settling_scene() -> Scene:
    """Return the strip that settles, its tip the only probe."""
    sheet, material = Sheet(0.18, 0.09, 0.002), Material(12e6, 0.0, 1100.0, damping_time=0.01)
    weight = Gravity(acceleration=(0.0, 0.0, -9.81))
    return specimen(sheet, material, (Clamped(edge="x0"),), gravity=weight, probes={"tip": (0.18, 0.045)})


def sheared(model: str, share: float, elements: int) -> np.ndarray:
    """Return −u and w (2,) [m] of the tip under a share of the force."""
    load = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, FORCE * share))
    return _tip(Sheet(10.0, 1.0, 0.1), YOUNG, elements, model, loads=(load,))[[0, 2]] * [-1.0, 1.0]


def rolled(model: str, share: float, elements: int, thickness: float = THICKNESS) -> np.ndarray:
    """Return −u and w (2,) [m] of the tip under a share of the full circle's moment (50π/3 as published)."""
    moment = share * 2.0 * np.pi / LENGTH * YOUNG * thickness**3 / 12.0
    load = EdgeLoad(edge="x1", moment_per_length=moment)
    return _tip(Sheet(LENGTH, 1.0, thickness), YOUNG, elements, model, loads=(load,))[[0, 2]] * [-1.0, 1.0]


def closed_form(share: float) -> np.ndarray:
    """Return −u and w (2,) [m] of the strip rolled up, exactly."""
    angle = 2.0 * np.pi * share
    radius = LENGTH / angle
    return np.array([LENGTH - radius * np.sin(angle), radius * (1.0 - np.cos(angle))])


def hanging(model: str, load: float, elements: int) -> np.ndarray:
    """Return drop and shortening (2,) of the tip over the length, at qL³/EI = load; the length is 1 m."""
    young, thickness = 1e7, 0.01
    weight = -load * young * thickness**3 / 12.0
    return -_tip(Sheet(1.0, 0.1, thickness), young, elements, model, weight)[[2, 0]]


def _tip(
    sheet: Sheet, young: float, elements: int, model: str, weight: float = 0.0, **more: Any
) -> np.ndarray:
    """Return the displacement (3,) [m] of the free end's middle, on a number of elements along a strip.
    weight: per area [Pa]; more: other fields of the scene."""
    material = Material(young=young, poisson=0.0, density=1000.0)
    scene = specimen(sheet, material, (Clamped(edge="x0"),), weight, **more)
    # With ν = 0 there are no layers at the ends to grade towards.
    uniform: dict[str, Any] = {"grading": "uniform"} if model == "solid" else {}
    return u_at(scene, (sheet.length_x, 0.5 * sheet.length_y), model, (elements, 1), **uniform)
