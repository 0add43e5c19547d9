"""What the equilibrium equation leaves over, r = f − f_int, as compiled loops."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from sheetbench.numerics.maps import Rows, transposed_product


class Residual(NamedTuple):
    """What the equilibrium equation leaves: the unbalanced force (n, 3) [N], the part of it on the free
    unknowns (m,) and that one's norm [N]; scale: the norm [N] of the external forces plus the supports'."""

    force: np.ndarray
    reduced: np.ndarray
    norm: float
    scale: float

    @property
    def relative(self) -> float:
        """The norm over the scale of the forces."""
        return self.norm / self.scale if self.scale > 0.0 else self.norm


@njit(cache=True, nogil=True)
def unbalanced_force(
    internal: np.ndarray, external: np.ndarray, held: np.ndarray, free: Rows, n: int
) -> tuple[np.ndarray, np.ndarray, float, float]:
    """Return external less internal force r (k, 3) [N], Tᵀ r (n,), its norm and the forces' `size_of`."""
    out = np.empty_like(internal)
    for i in range(len(out)):
        for q in range(3):
            out[i, q] = external[i, q] - internal[i, q]
    reduced = transposed_product(free, out.ravel(), n)
    total = 0.0
    for value in reduced:
        total += value * value
    return out, reduced, np.sqrt(total), size_of(internal, external, held)


@njit(cache=True, nogil=True)
def size_of(internal: np.ndarray, external: np.ndarray, held: np.ndarray) -> float:
    """Return the norm of the external forces plus that of the supports' [N]; held: (k, 3) bool."""
    loads = supports = 0.0
    for i in range(len(internal)):
        for q in range(3):
            loads += external[i, q] ** 2
            if held[i, q]:
                supports += internal[i, q] ** 2
    return np.sqrt(loads) + np.sqrt(supports)
