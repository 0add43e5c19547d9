"""Markers of a motion capture: C3D files, read with `ezc3d`, an extra.

A file may be another person's, and ezc3d does not survive damaged ones: reading is a program of its own
(`c3d_reader`) with limits of time and memory, and its numbers are checked.
"""

from __future__ import annotations

import sys
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np

from comparisons.identification import c3d_reader
from sheetbench.errors import BadInput
from sheetbench.process import ONE_THREAD, run
from sheetbench.scenes.language.units import quantity

SECONDS, PER_MB = 20.0, 2.0  # s that reading may take, and more a megabyte of the file
MEMORY_MB, LARGEST = 4096, 2**28  # of address space; bytes of a file


class Markers(NamedTuple):
    """labels: (n,); position: (n, frames, 3) [m], nan where a marker was not seen; time: (frames,) [s]."""

    labels: tuple[str, ...]
    position: np.ndarray
    time: np.ndarray


def read_markers(path: Path) -> Markers:
    """Return the markers of a file, in its own axes. Raises BadInput where it cannot be read, or ezc3d is not
    installed."""
    if find_spec("ezc3d") is None:
        raise BadInput(f"{path}: C3D files need ezc3d: pip install 'sheetbench[c3d]'")
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    size = path.stat().st_size
    if size > LARGEST:
        raise BadInput(f"{path}: larger than {LARGEST // 2**20} MB: cut the capture")
    # -P: the modules beside the program are not its own
    command = [sys.executable, "-P", c3d_reader.__file__, str(path)]
    seconds = SECONDS + PER_MB * size / 2**20
    ended = run(command, b"", seconds, MEMORY_MB, most=8 * LARGEST, variables=ONE_THREAD)
    if ended.fault:
        refused = ended.code == c3d_reader.REFUSED and not ended.stopped
        raise BadInput(f"{path}: cannot be read as C3D: {ended.complaint if refused else ended.fault}")
    with np.load(BytesIO(ended.answer)) as archive:
        found = dict(archive)
    labels, rate = tuple(map(str, found["labels"])), float(found["rate"])
    position = found["position"].transpose(1, 2, 0)
    if not (0.0 < rate < np.inf and position.size):
        raise BadInput(f"{path}: no markers over time in it")
    if len(labels) != len(position):
        raise BadInput(f"{path}: {len(labels)} labels of {len(position)} markers")
    if np.isinf(position).any():
        raise BadInput(f"{path}: a marker's position is no finite number")
    scale = quantity(f"1 {found['unit']}", "m")
    return Markers(labels, scale * position, np.arange(position.shape[1]) / rate)
