"""The error to expect of a lattice's frequencies, from those of the same lattice on a finer grid.

Modes are paired by shape. With f on the grid asked for and g on one with `ratio` times as many cells in plan,
an error that falls with the square of the cells is (f/g − 1)/(1 − 1/ratio), of every mode whose shape is
found again; which lattices have it, and the finer grid: `comparisons.models.expected_error`.
"""

from __future__ import annotations

import numpy as np

from comparisons.modes.pairing import assurance, matched

Modes = tuple[np.ndarray, np.ndarray]  # frequencies (count,) and shapes (count, n, 3) on equal plan cells


def expected_errors(coarse: Modes, fine: Modes, ratio: float) -> list[float | None]:
    """Return the relative error to expect of every frequency of the coarser lattice, None without a
    counterpart."""
    of, shapes = coarse
    against, others = fine
    pairs = matched(assurance(shapes, others, against))
    return [
        None if match is None else float(of[i] / against[match] - 1.0) / (1.0 - 1.0 / ratio)
        for i, match in enumerate(pairs)
    ]
