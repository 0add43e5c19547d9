"""Strips of ν = 0 clamped at x = 0 under loads that bend them far.

A shear force at the end of one of 10 × 1 × 0.1, E 1.2e6 (section 3.1), and a moment up to 50π/3 that rolls
one of 12 × 1 × 0.1 up to a full circle (section 3.2), exact for the inextensible elastica and, with ν = 0 and
but for a stretch of (h/R)²/12, for the shell:

    −u = L − (EI/M) sin(ML/EI),    w = (EI/M) (1 − cos(ML/EI)).

Nothing is singular: rolled into half a circle, so thin that its stretch is below 1e-9, it also tells the
order of the shell under large rotations. The tip is as good as the energy: order 4, twice the strains'.

The weight of a strip, the heavy elastica:

    EI θ'' = q (L − s) cos θ,    θ(0) = 0,    θ'(L) = 0

One number, qL³/EI, says how far it hangs. The values are this project's solution of that equation by
collocation, its five digits checked by a test; a strip of h/L = 0.01 is one to within 1e-4 (its stretch and
transverse shear). Sources: Sze, Liu & Lo, Popular benchmark problems for geometric nonlinear analysis of
shells, Finite Elements in Analysis and Design 40 (2004) 1551–1569; of the last equation Wang, A critical
review of the heavy elastica, Int. J. Mech. Sci. 28 (1986) 549–559.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import Any

import numpy as np

from fem_reference.verification.rows import EXACT, Row, convergence, curve
from fem_reference.verification.specimens import moved, specimen
from sheetbench.scenes import Clamped, EdgeLoad, Material, Sheet

ELEMENTS = 16
FORCE = 4.0
SHEARED = {0.25: (0.563, 3.015), 0.5: (1.604, 4.933), 0.75: (2.541, 6.031), 1.0: (3.286, 6.698)}
LENGTH, YOUNG, THICKNESS = 12.0, 1.2e6, 0.1
SHARES, ROLLED = (0.25, 0.5, 1.0), 2e-3  # of the moment; tolerance
ORDER = 4.0
THIN, HALF_CIRCLE, OF_ORDER = 1e-3, 0.5, (8, 16)  # thickness, share of the moment, elements
LARGEST = 5e-5  # error on the finest mesh, of the length
HEAVY = {
    0.5: (0.06231, 0.00222),
    1.0: (0.12347, 0.00875),
    2.0: (0.23851, 0.03311),
    5.0: (0.49591, 0.15334),
    10.0: (0.70020, 0.34365),
    20.0: (0.82988, 0.55477),
}


def end_shear() -> Iterator[Row]:
    """−u and w of the tip at each share of the force."""
    for model in ("shell", "solid"):
        mesh, names = f"{model} {ELEMENTS} × 1", ("−u at P = {:g} P_max", "w at P = {:g} P_max")
        answer = partial(sheared, model=model)
        yield from curve(names, mesh, SHEARED, "Sze, Liu & Lo 2004, 3.1", 5e-3, answer, ELEMENTS)


def roll_up() -> Iterator[Row]:
    """−u and w of the tip at each share of the moment; where the exact value is 0, relative to the length."""
    names = "−u at M = {:g} M_max", "w at M = {:g} M_max"
    exact = {share: closed_form(share) for share in SHARES}
    yield from curve(names, f"shell {ELEMENTS} × 1", exact, EXACT, ROLLED, rolled, ELEMENTS, LENGTH)


def order() -> Iterator[Row]:
    """Error of the tip over the length, and its order, of the strip rolled up."""
    exact = closed_form(HALF_CIRCLE)
    errors = [np.abs(rolled(HALF_CIRCLE, n, THIN) - exact).max() / LENGTH for n in OF_ORDER]
    yield from convergence("of the tip", f"shell {OF_ORDER[-1]} × 1", errors, LARGEST, ORDER)


def heavy_elastica() -> Iterator[Row]:
    """Drop w/L and shortening u/L of the tip at each load."""
    for model in ("shell", "solid"):
        mesh, names = f"{model} {ELEMENTS} × 1", ("w/L at qL³/EI = {:g}", "u/L at qL³/EI = {:g}")
        answer = partial(hanging, model=model)
        yield from curve(names, mesh, HEAVY, "this project, collocation", 2e-3, answer, ELEMENTS)


def sheared(share: float, elements: int, model: str) -> np.ndarray:
    """−u and w (2,) [m] of the tip under a share of the force."""
    load = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, FORCE * share))
    return _tip(Sheet(10.0, 1.0, 0.1), YOUNG, elements, model, loads=(load,))[[0, 2]] * [-1.0, 1.0]


def rolled(share: float, elements: int, thickness: float = THICKNESS) -> np.ndarray:
    """−u and w (2,) [m] of the tip under a share of the full circle's moment, 50π/3 at the published h."""
    moment = share * 2.0 * np.pi / LENGTH * YOUNG * thickness**3 / 12.0
    load = EdgeLoad(edge="x1", moment_per_length=moment)
    return _tip(Sheet(LENGTH, 1.0, thickness), YOUNG, elements, loads=(load,))[[0, 2]] * [-1.0, 1.0]


def closed_form(share: float) -> np.ndarray:
    """−u and w (2,) [m] of the strip rolled up, exactly."""
    angle = 2.0 * np.pi * share
    radius = LENGTH / angle
    return np.array([LENGTH - radius * np.sin(angle), radius * (1.0 - np.cos(angle))])


def hanging(load: float, elements: int, model: str) -> np.ndarray:
    """Drop and shortening (2,) of the tip over the length, at qL³/EI = load; the length is 1 m."""
    young, thickness = 1e7, 0.01
    weight = -load * young * thickness**3 / 12.0
    return -_tip(Sheet(1.0, 0.1, thickness), young, elements, model, weight)[[2, 0]]


def _tip(
    sheet: Sheet, young: float, elements: int, model: str = "shell", weight: float = 0.0, **more: Any
) -> np.ndarray:
    """Displacement (3,) [m] of the free end's middle on that many elements along a strip, under its weight
    per area [Pa] and what more a scene has."""
    material = Material(young=young, poisson=0.0, density=1000.0)
    scene = specimen(sheet, material, (Clamped(edge="x0"),), weight, **more)
    # With ν = 0 there are no layers at the ends to grade towards.
    uniform: dict[str, Any] = {"grading": "uniform"} if model == "solid" else {}
    return moved(scene, (sheet.length_x, 0.5 * sheet.length_y), model, (elements, 1), **uniform)
