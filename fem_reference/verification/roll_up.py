"""Cantilever rolled up to a full circle by an end moment: E 1.2e6, ν 0, 12 × 1 × 0.1, M up to 50π/3.

Exact for the inextensible elastica and, with ν = 0 and but for a stretch of (h/R)²/12, for the shell:

    −u = L − (EI/M) sin(ML/EI),    w = (EI/M) (1 − cos(ML/EI)).

Nothing is singular: rolled into half a circle, so thin that its stretch is below 1e-9, the strip also tells
the order of the shell under large rotations. The tip is as good as the energy: order 4, twice the strains'.

Source: Sze, Liu & Lo, Finite Elements in Analysis and Design 40 (2004) 1551–1569, section 3.2.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.verification.rows import EXACT, THEORY, Row, absolutely, mesh_change, relatively
from fem_reference.verification.strip import strip, tip
from sheetbench.scenes import EdgeLoad

TOLERANCE = 2e-3
ELEMENTS = 16
LENGTH, YOUNG, THICKNESS = 12.0, 1.2e6, 0.1
SHARES = (0.25, 0.5, 1.0)
ORDER, SLACK = 4.0, 0.15
THIN, HALF_CIRCLE, OF_ORDER = 1e-3, 0.5, (8, 16)  # thickness, share of the moment, elements
LARGEST = 5e-5  # error on the finest mesh, of the length


def rows(case: str) -> Iterator[Row]:
    """−u and w of the tip at each share of the moment; where the exact value is 0, relative to the length."""
    mesh = f"shell {ELEMENTS} × 1"
    for share in SHARES:
        found, exact = rolled(share, ELEMENTS), closed_form(share)
        for name, published, computed in zip(("−u", "w"), exact, found, strict=True):
            scale = LENGTH if abs(published) < 1e-9 * LENGTH else None
            quantity = f"{name} at M = {share:g} M_max"
            yield relatively(case, quantity, mesh, published, EXACT, computed, TOLERANCE, scale)
    yield mesh_change(case, mesh, rolled(1.0, ELEMENTS // 2), rolled(1.0, ELEMENTS), TOLERANCE)


def order(case: str) -> Iterator[Row]:
    """Error of the tip on the finest mesh, and the order of the last refinement."""
    exact = closed_form(HALF_CIRCLE)
    coarse, fine = (np.abs(rolled(HALF_CIRCLE, n, THIN) - exact).max() / LENGTH for n in OF_ORDER)
    mesh = f"shell {OF_ORDER[-1]} × 1"
    yield absolutely(case, "error of the tip over the length", mesh, 0.0, EXACT, fine, LARGEST)
    yield absolutely(case, "order of the tip", mesh, ORDER, THEORY, np.log2(coarse / fine), SLACK)


def rolled(share: float, elements: int, thickness: float = THICKNESS) -> np.ndarray:
    """−u and w (2,) [m] of the tip under a share of the full circle's moment, 50π/3 at the published h."""
    moment = share * 2.0 * np.pi / LENGTH * YOUNG * thickness**3 / 12.0
    load = EdgeLoad(edge="x1", moment_per_length=moment)
    displacement = tip(strip(LENGTH, 1.0, thickness, YOUNG, loads=(load,)), elements)
    return displacement[[0, 2]] * [-1.0, 1.0]


def closed_form(share: float) -> np.ndarray:
    """−u and w (2,) [m], exactly."""
    angle = 2.0 * np.pi * share
    radius = LENGTH / angle
    return np.array([LENGTH - radius * np.sin(angle), radius * (1.0 - np.cos(angle))])
