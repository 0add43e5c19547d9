"""The unbalanced force on the free unknowns and the size of the forces that it is relative to, compiled."""

from __future__ import annotations

import numpy as np
from numba import njit

from sheetbench.numerics.maps import Rows, transposed_product


@njit(cache=True, nogil=True)
def unbalanced_force(
    internal: np.ndarray, external: np.ndarray, held: np.ndarray, free: Rows, n: int
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return external less internal force r (k, 3) [N], Tᵀ r (n,), its norm and the forces' `scale`."""
    out = external - internal
    reduced = transposed_product(free, out.ravel(), n)
    total = 0.0
    for value in reduced:
        total += value * value
    return out, reduced, np.sqrt(total), scale(internal, external, held)


@njit(cache=True, nogil=True)
def scale(internal: np.ndarray, external: np.ndarray, held: np.ndarray) -> float:
    """Return the norm of the external forces plus that of the supports' [N]; held: (k, 3) bool."""
    loads = supports = 0.0
    for i in range(len(internal)):
        for q in range(3):
            loads += external[i, q] ** 2
            if held[i, q]:
                supports += internal[i, q] ** 2
    return np.sqrt(loads) + np.sqrt(supports)
