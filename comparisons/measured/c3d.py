"""Markers of a motion capture: C3D files, read with `ezc3d`, an extra."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numpy as np

from sheetbench.errors import BadInput, foreign
from sheetbench.scenes.units import quantity


class Markers(NamedTuple):
    """labels: (n,); position: (n, frames, 3) [m], nan where a marker was not seen; time: (frames,) [s]."""

    labels: tuple[str, ...]
    position: np.ndarray
    time: np.ndarray


def read_markers(path: Path) -> Markers:
    """Return the markers of a file, in its own axes. Raises BadInput where it cannot be read, or ezc3d is not
    installed."""
    try:
        import ezc3d
    except ModuleNotFoundError:
        raise BadInput(f"{path}: C3D files need ezc3d: pip install 'sheetbench[c3d]'") from None
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    try:
        content = ezc3d.c3d(str(path))
        point = content["parameters"]["POINT"]
        unit, rate = point["UNITS"]["value"][0] or "m", float(point["RATE"]["value"][0])
        labels = tuple(map(str, point["LABELS"]["value"]))
        position = np.asarray(content["data"]["points"][:3], dtype=float).transpose(1, 2, 0)
    except (OSError, RuntimeError, KeyError, IndexError) as error:
        raise BadInput(f"{path}: cannot be read as C3D: {foreign(error)}") from None
    if not (rate > 0.0 and position.size):
        raise BadInput(f"{path}: no markers over time in it")
    scale = quantity(f"1 {unit}", "m")
    return Markers(labels, scale * position, np.arange(position.shape[1]) / rate)
