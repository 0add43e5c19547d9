"""Cantilever under a shear force at its end: E 1.2e6, ν 0, 10 × 1 × 0.1, force up to 4.

Source: Sze, Liu & Lo, Popular benchmark problems for geometric nonlinear analysis of shells, Finite Elements
in Analysis and Design 40 (2004) 1551–1569, section 3.1.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.verification.rows import Row, mesh_change, relatively
from fem_reference.verification.strip import strip, tip
from sheetbench.scenes import EdgeLoad

TOLERANCE = 5e-3
ELEMENTS = {"shell": 16, "solid": 16}
FORCE = 4.0
SOURCE = "Sze, Liu & Lo 2004, 3.1"
PUBLISHED = {0.25: (0.563, 3.015), 0.5: (1.604, 4.933), 0.75: (2.541, 6.031), 1.0: (3.286, 6.698)}


def rows(case: str) -> Iterator[Row]:
    """−u and w of the tip at each share of the force."""
    for model, elements in ELEMENTS.items():
        mesh = f"{model} {elements} × 1"
        for share, values in PUBLISHED.items():
            displacement = _tip(share, elements, model)
            found = (-displacement[0], displacement[2])
            for name, published, computed in zip(("−u", "w"), values, found, strict=True):
                yield relatively(
                    case, f"{name} at P = {share:g} P_max", mesh, published, SOURCE, computed, TOLERANCE
                )
        coarse, fine = (_tip(1.0, n, model) for n in (elements // 2, elements))
        yield mesh_change(case, mesh, coarse, fine, TOLERANCE)


def _tip(share: float, elements: int, model: str) -> np.ndarray:
    load = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, FORCE * share))
    return tip(strip(10.0, 1.0, 0.1, 1.2e6, loads=(load,)), elements, model)
