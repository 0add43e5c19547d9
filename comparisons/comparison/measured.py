"""Read measured histories of probes.

A measured history is a CSV with the columns time,probe,ux,uy,uz: seconds, a probe's name, metres; a
component may be left empty (`comparisons.identification.columns`).
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from comparisons.identification.columns import read_columns
from comparisons.identification.measurements import require_flat_start
from sheetbench.answers.history import COMPONENTS, History, Measured
from sheetbench.errors import BadInput

HEADER = ("time", "probe", *COMPONENTS)


def read_measured(path: Path, probes: list[str]) -> dict[str, Measured]:
    """Measured histories by probe. Raises BadInput naming file and line."""
    columns = read_columns(path)
    if not set(HEADER) <= set(columns.names):
        raise BadInput(f"{path}: the header must be {','.join(HEADER)}")
    rows: dict[str, list[list[float]]] = {}
    for row in columns.rows:
        if row.cells["probe"] not in probes:
            raise row.refused("probe", f"the scene has {', '.join(probes)}")
        numbers = [row.number("time"), *(row.measured(name) for name in COMPONENTS)]
        rows.setdefault(row.cells["probe"], []).append(numbers)
    every = np.array([values for of in rows.values() for values in of]).reshape(-1, 4)
    require_flat_start(path, every[:, 0], every[:, 1:])
    tables = {probe: np.array(sorted(values)) for probe, values in rows.items()}
    return {probe: Measured(table[:, 0], table[:, 1:]) for probe, table in tables.items()}


def require_within(measured: Mapping[str, Measured], duration: float, file: Path) -> None:
    """Raise BadInput where no measured time lies within a run of `duration` [s]."""
    first = min((float(one.time[0]) for one in measured.values()), default=0.0)
    last = max((float(one.time[-1]) for one in measured.values()), default=0.0)
    if not any(one.within(0.0, duration).any() for one in measured.values()):
        raise BadInput(
            f"--measured = '{file}': no time within the run of {duration:g} s (--duration), "
            f"but from {first:g} to {last:g} s"
        )


def left_out(history: History, measured: Mapping[str, Measured]) -> list[str]:
    """A sentence for every probe with measurements outside the time of the run."""
    start, end = float(history.time[0]), float(history.time[-1])
    sentences = []
    for probe, one in measured.items():
        if outside := int(np.sum(~one.within(start, end))):
            of = f"{outside} of {len(one.time)} measured times"
            sentences.append(f"{probe}: {of} left out, for the run is from {start:g} to {end:g} s")
    return sentences
