"""Histories of dynamic runs: documents, tables, measured histories beside them.

A measured history is a CSV with the columns time,probe,ux,uy,uz: seconds, a probe's name, metres; a
component may be left empty (`comparisons.measured.columns`). Its error at a probe is the largest
|component of (simulated − measured)| over its times within the run, divided by the largest |measured
component|, the simulation interpolated linearly.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.measured.columns import read_columns
from sheetbench.answers.table import Column, Table
from sheetbench.errors import BadInput
from sheetbench.scenes import History

COMPONENTS = ("ux", "uy", "uz")
HEADER = ("time", "probe", *COMPONENTS)


@dataclass(frozen=True)
class Measured:
    """One probe's measured history: time (n,) [s], displacement (n, 3) [m], nan where not measured."""

    time: np.ndarray
    displacement: np.ndarray


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
    found = {}
    for probe, values in rows.items():
        table = np.array(sorted(values))
        found[probe] = Measured(table[:, 0], table[:, 1:])
    return found


def require_within(measured: Mapping[str, Measured], duration: float, file: Path) -> None:
    """Raise BadInput where no measured time lies within a run of `duration` [s]."""
    first = min((float(one.time[0]) for one in measured.values()), default=0.0)
    last = max((float(one.time[-1]) for one in measured.values()), default=0.0)
    if not any(_inside(one, 0.0, duration).any() for one in measured.values()):
        raise BadInput(
            f"--measured = '{file}': no time within the run of {duration:g} s (--duration), "
            f"but from {first:g} to {last:g} s"
        )


def left_out(history: History, measured: Mapping[str, Measured]) -> list[str]:
    """A sentence for every probe with measurements outside the time of the run."""
    start, end = float(history.time[0]), float(history.time[-1])
    said = []
    for probe, one in measured.items():
        if outside := int(np.sum(~_inside(one, start, end))):
            of = f"{outside} of {len(one.time)} measured times"
            said.append(f"{probe}: {of} left out, for the run is from {start:g} to {end:g} s")
    return said


def _inside(measured: Measured, start: float, end: float) -> np.ndarray:
    found: np.ndarray = (measured.time >= start) & (measured.time <= end)
    return found


def error(history: History, probe: str, measured: Measured) -> float | None:
    """The error of a simulated probe against its measured history, as the module defines it."""
    inside = _inside(measured, history.time[0], history.time[-1])
    truth = measured.displacement[inside]
    if not np.isfinite(truth).any() or np.nanmax(np.abs(truth)) == 0.0:
        return None
    simulated = np.column_stack(
        [np.interp(measured.time[inside], history.time, history.probes[probe][:, i]) for i in range(3)]
    )
    return float(np.nanmax(np.abs(simulated - truth)) / np.nanmax(np.abs(truth)))


def as_dict(history: History, measured: dict[str, Measured]) -> dict[str, Any]:
    """The JSON document of `sheetbench simulate`: seconds, metres, joules, newtons."""
    document: dict[str, Any] = {
        "time": history.time,
        "probes": history.probes,
        "energy": history.balance,
        "status": str(history.status),
        "steps": history.steps,
        "solve_seconds": history.solve_seconds,
        "setup_seconds": history.setup_seconds,
        "message": history.message,
        "integrator": history.integrator,
        "label": history.label,
        "settings": history.settings,
        "resumed_from": history.resumed_from,
        "energies": history.energies,
        "reactions": history.reactions,
        "actuators": history.actuators,
    }
    if measured:
        document["measured_errors"] = {name: error(history, name, m) for name, m in measured.items()}
    return document


def series(history: History) -> Table:
    """A row per sample: time, probes, energies, reactions and the actuators' total force."""
    columns, values = [Column("time", "s")], [history.time]
    for name, u in history.probes.items():
        columns += [Column(f"{name}.{component}", "m") for component in COMPONENTS]
        values += list(u.T)
    for name, energy in [*history.energies.items(), ("balance", history.balance)]:
        columns.append(Column(name, "J"))
        values.append(energy)
    for name, force in history.reactions.items():
        columns += [Column(f"{name}.F{axis}", "N") for axis in "xyz"]
        values += list(force.T)
    for name, wrench in history.actuators.items():
        for segment in range(wrench.shape[1]):
            columns += [Column(f"{name}.{segment}.F{axis}", "N") for axis in "xyz"]
            columns += [Column(f"{name}.{segment}.M{axis}", "N·m") for axis in "xyz"]
            values += list(wrench[:, segment].T)
    return Table("History", tuple(columns), tuple(zip(*(v.tolist() for v in values), strict=True)))


def summary(history: History, measured: dict[str, Measured]) -> Table:
    """A row per probe: the displacement at the end, its largest excursion and, if measured, the error."""
    rows = []
    for name, u in history.probes.items():
        off = error(history, name, measured[name]) if name in measured else None
        rows.append((name, *(float(x) for x in u[-1]), float(np.abs(u).max()), off))
    millimetres = [Column(name, "m", "mm", 1e3, "z.3f") for name in (*COMPONENTS, "largest")]
    columns = (Column("probe"), *millimetres, Column("off by", "", "%", 100.0, "z.2f"))
    caption = f"Displacement at {history.time[-1]:g} s, and largest component on the way"
    return Table(caption, columns, tuple(rows), "probes")
