"""Require that a measured motion begins where runs do: with the flat sheet at rest."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from sheetbench.answers.measured_history import COMPONENTS
from sheetbench.errors import BadInput

NOISE = 0.1  # of the largest displacement


def require_flat_start(path: Path, time: np.ndarray, displacement: np.ndarray) -> None:
    """Raise BadInput where a sample at time 0 is moved by more than noise.

    time: (n,) [s]; displacement: (n, 3) [m], nan where not measured.
    """
    moved = np.nan_to_num(displacement)
    allowed = NOISE * float(np.abs(moved).max(initial=0.0))
    first = moved[time == 0.0]
    if np.abs(first).max(initial=0.0) > allowed:
        row, axis = np.unravel_index(np.abs(first).argmax(), first.shape)
        raise BadInput(
            f"{path}: {COMPONENTS[axis]} = {first[row, axis]:g} m at time = 0: a run begins with the flat "
            f"sheet at rest; up to {allowed:.2g} m, a tenth of the largest displacement, passes as noise"
        )
