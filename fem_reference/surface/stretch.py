"""How much a surface of nine-node elements is stretched, for the question whether its material law holds."""

from __future__ import annotations

import numpy as np

from fem_reference.surface.biquadratic import GAUSS, GAUSS_WEIGHTS, shape


def largest_stretch(rest: np.ndarray, now: np.ndarray) -> float:
    """The largest change of length along the sides of an element, √(1 + 2 E) − 1 of the mean of Green's
    strain E over it; rest, now: places (m, 9, 3) [m] of the elements' nodes."""
    _, slope = shape(*GAUSS)
    before, after = (np.sum(np.einsum("agi,eic->aegc", slope, at) ** 2, axis=3) for at in (rest, now))
    mean = (after / before - 1.0) @ GAUSS_WEIGHTS / GAUSS_WEIGHTS.sum()  # 2 E, of both sides of every element
    return float(np.max(np.abs(np.sqrt(np.maximum(1.0 + mean, 0.0)) - 1.0)))
