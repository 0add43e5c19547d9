"""A strip clamped at one end and bent by its own weight: the heavy elastica.

    EI θ'' = q (L − s) cos θ,    θ(0) = 0,    θ'(L) = 0

One number, qL³/EI, says how far it hangs. The values are this project's solution of that equation by
collocation, its five digits checked by a test; a strip with ν = 0 and h/L = 0.01 is one to within 1e-4 (its
stretch and transverse shear).
Source of the equation: Wang, A critical review of the heavy elastica, Int. J. Mech. Sci. 28 (1986) 549–559.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.verification.rows import Row, mesh_change, relatively
from fem_reference.verification.strip import strip, tip
from sheetbench.scenes import Gravity

TOLERANCE = 2e-3
ELEMENTS = {"shell": 16, "solid": 16}
YOUNG, THICKNESS, DENSITY = 1e7, 0.01, 1000.0
SOURCE = "this project, collocation"
PUBLISHED = {
    0.5: (0.06231, 0.00222),
    1.0: (0.12347, 0.00875),
    2.0: (0.23851, 0.03311),
    5.0: (0.49591, 0.15334),
    10.0: (0.70020, 0.34365),
    20.0: (0.82988, 0.55477),
}


def rows(case: str) -> Iterator[Row]:
    """Drop w/L and shortening u/L of the tip at each load."""
    for model, elements in ELEMENTS.items():
        mesh = f"{model} {elements} × 1"
        for load, values in PUBLISHED.items():
            found = hanging(load, elements, model)
            for name, published, computed in zip(("w/L", "u/L"), values, found, strict=True):
                yield relatively(
                    case, f"{name} at qL³/EI = {load:g}", mesh, published, SOURCE, computed, TOLERANCE
                )
        coarse, fine = (hanging(max(PUBLISHED), n, model) for n in (elements // 2, elements))
        yield mesh_change(case, mesh, coarse, fine, TOLERANCE)


def hanging(load: float, elements: int, model: str) -> np.ndarray:
    """Drop and shortening (2,) of the tip over the length, at qL³/EI = load; the length is 1 m."""
    acceleration = load * YOUNG * THICKNESS**2 / 12.0 / DENSITY
    scene = strip(1.0, 0.1, THICKNESS, YOUNG, gravity=Gravity(acceleration=(0.0, 0.0, -acceleration)))
    return -tip(scene, elements, model)[[2, 0]]
