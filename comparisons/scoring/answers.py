"""Somebody's answers to a suite, from a CSV file (`comparisons.measured.columns`); SI units.

statics   case,probe,ux,uy,uz[,seconds]
settling  case,time,probe,ux,uy,uz[,seconds]: at the times of the reference, which are interpolated to
modes     case,mode,frequency[,seconds]: modes count from 1, lowest first

A form may be filled in stages: a row whose numbers are all empty is open, and so is its case.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from comparisons.measured.columns import Row, read_columns
from comparisons.scoring.reference import Reference, reference, references
from sheetbench.errors import BadInput

HEADERS = {
    "statics": ("case", "probe", "ux", "uy", "uz"),
    "settling": ("case", "time", "probe", "ux", "uy", "uz"),
    "modes": ("case", "mode", "frequency"),
}


@dataclass(frozen=True, eq=False)
class Answer:
    """values: as in the reference; seconds: of the solve, None where it is not given."""

    reference: Reference
    values: np.ndarray
    seconds: float | None


def read_answers(path: Path, suite: str, chosen: Sequence[str] = ()) -> tuple[list[Answer], list[Reference]]:
    """The answers to a suite, or to the chosen cases of it, and the cases that are open.

    Raises BadInput naming a case that there is not, what is missing of one, or is there twice.
    """
    known = references(suite)
    wanted = [reference(name, suite) for name in dict.fromkeys(chosen)] or list(known.values())
    columns = read_columns(path)
    header = HEADERS[suite]
    if not set(header) <= set(columns.names):
        raise BadInput(f"{path}: the header of {suite} must be {','.join(header)}, and may have seconds")
    rows: dict[str, list[Row]] = {}
    for row in columns.rows:
        if row.cells["case"] not in known:
            raise row.refused("case", _unknown(row.cells["case"], suite))
        rows.setdefault(row.cells["case"], []).append(row)
    closed = [
        one for one in wanted if one.name in rows and not any(_open(suite, row) for row in rows[one.name])
    ]
    if not closed:
        names = ", ".join(one.name for one in wanted[:4])
        raise BadInput(f"{path}: no answer yet to {names}: fill in the numbers of a case")
    unanswered = [one for one in wanted if one not in closed]
    return [_answer(path, one, rows[one.name]) for one in closed], unanswered


def _open(suite: str, row: Row) -> bool:
    """Whether none of the numbers of a row is filled in."""
    names = HEADERS[suite][2:] if suite != "settling" else HEADERS[suite][3:]
    return not any(row.cells[name] for name in names if name != "probe")


def _unknown(name: str, suite: str) -> str:
    """Why there is no such case, and which is likely meant."""
    elsewhere = references().get(name)
    if elsewhere is not None:
        return f"a case of {elsewhere.suite}: score it with --suite {elsewhere.suite}"
    close = get_close_matches(name, references(suite), 1)
    return f"{suite} has no such case" + (f"; did you mean {close[0]}?" if close else "")


def _answer(path: Path, reference: Reference, rows: list[Row]) -> Answer:
    timed = [row.measured("seconds") for row in rows if "seconds" in row.cells]
    seconds = [value for value in timed if value == value]
    read = {"statics": _probes, "settling": _histories, "modes": _frequencies}[reference.suite]
    return Answer(reference, read(path, reference, rows), float(np.mean(seconds)) if seconds else None)


def _probes(path: Path, reference: Reference, rows: list[Row]) -> np.ndarray:
    return np.array(
        [_only(path, reference, name, of_probe)[1:] for name, of_probe in _by_probe(reference, rows)]
    )


def _histories(path: Path, reference: Reference, rows: list[Row]) -> np.ndarray:
    assert reference.time is not None
    values = []
    for name, of_probe in _by_probe(reference, rows):
        if not of_probe:
            raise BadInput(f"{path}: case {reference.name}: probe {name} is missing")
        table = np.array(sorted([row.number("time"), *_vector(row)] for row in of_probe))
        if table[0, 0] > reference.time[0] or table[-1, 0] < reference.time[-1]:
            raise BadInput(
                f"{path}: case {reference.name}: probe {name} from {table[0, 0]:g} to {table[-1, 0]:g} s; "
                f"the reference is from {reference.time[0]:g} to {reference.time[-1]:g} s"
            )
        values.append(
            np.column_stack([np.interp(reference.time, table[:, 0], table[:, i]) for i in (1, 2, 3)])
        )
    return np.array(values)


def _frequencies(path: Path, reference: Reference, rows: list[Row]) -> np.ndarray:
    frequencies = {int(row.number("mode")): row.number("frequency") for row in rows}
    missing = [n for n in range(1, len(reference.values) + 1) if n not in frequencies]
    if missing:
        raise BadInput(f"{path}: case {reference.name}: mode {missing[0]} is missing")
    return np.array([frequencies[n] for n in range(1, len(reference.values) + 1)])


def _by_probe(reference: Reference, rows: list[Row]) -> list[tuple[str, list[Row]]]:
    """The rows of every probe. Raises BadInput for a probe that there is not."""
    for row in rows:
        if row.cells["probe"] not in reference.scene.probes:
            raise row.refused("probe", f"{reference.name} has {', '.join(reference.scene.probes)}")
    return [(name, [row for row in rows if row.cells["probe"] == name]) for name in reference.scene.probes]


def _only(path: Path, reference: Reference, name: str, rows: list[Row]) -> list[float]:
    if len(rows) != 1:
        often = "is missing" if not rows else f"is there {len(rows)} times"
        raise BadInput(f"{path}: case {reference.name}: probe {name} {often}")
    return [0.0, *_vector(rows[0])]


def _vector(row: Row) -> list[float]:
    return [row.number(name) for name in ("ux", "uy", "uz")]
