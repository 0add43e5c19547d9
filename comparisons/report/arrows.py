"""How long the arrows of point loads are, in pictures and in views."""

from __future__ import annotations

import numpy as np

POINT = 0.16  # length of the largest, of the sheet's longer side
SHORTEST = 0.4  # of any other, of the largest


def point_arrows(forces: np.ndarray) -> np.ndarray:
    """Arrows (n, 3) of forces (n, 3), in units of the sheet's longer side: in proportion to the forces, but
    long enough to be seen."""
    sizes = np.linalg.norm(forces, axis=1, keepdims=True)
    largest = float(sizes.max(initial=0.0))
    if not largest:
        return np.zeros_like(forces)
    lengths = POINT * np.maximum(sizes / largest, SHORTEST)
    arrows: np.ndarray = lengths * forces / np.where(sizes > 0.0, sizes, 1.0)
    return arrows
