"""Somebody's answers to a suite, from a CSV file (`comparisons.identification.columns`); SI units.

statics  case,probe,ux,uy,uz[,seconds]; so have curves, natural and contact
motion   case,probe,time,ux,uy,uz[,seconds]: a sample at every time of the reference, for nothing is
         interpolated; those at other times are passed over
modes    case,mode,frequency[,seconds]: modes count from 1, lowest first

The header tells the suite, and the first case the suites at rest apart. Where one case is requested the
column `case` may be left out, as in the history that a run writes. A form may be filled in stages: a row
whose numbers are all empty is open, and so is its case.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from comparisons.identification.columns import Row, read_columns
from comparisons.scoring.reference import AT_REST, Reference, reference, references
from sheetbench.errors import BadInput

HEADERS = {
    **dict.fromkeys(AT_REST, ("case", "probe", "ux", "uy", "uz")),
    "motion": ("case", "probe", "time", "ux", "uy", "uz"),
    "modes": ("case", "mode", "frequency"),
}
PLACES = ("case", "probe", "time", "mode")  # columns that say where, not what
SAME_TIME = 1e-6  # of the duration


@dataclass(frozen=True, eq=False)
class Answer:
    """values: as in the reference; seconds: of the solve, None where it is not given."""

    reference: Reference
    values: np.ndarray
    seconds: float | None


def read_answers(
    path: Path, suite: str | None = None, chosen: Sequence[str] = ()
) -> tuple[list[Answer], list[Reference]]:
    """The answers to a suite, or to the chosen cases of it, and the cases that are open.

    suite: the one that the header is of unless given. Raises BadInput naming a case that there is not, what
    is missing of one, or is there twice.
    """
    columns = read_columns(path)
    suite = suite or _suite_of(columns.names, [*chosen, *(row.cells.get("case", "") for row in columns.rows)])
    known = references(suite)
    wanted = [reference(name, suite) for name in dict.fromkeys(chosen)] or list(known.values())
    header = HEADERS[suite]
    only = {"case": wanted[0].name} if len(chosen) == 1 else {}
    if not set(header) <= {*columns.names, *only}:
        raise BadInput(
            f"{path}: the header of {suite} must be {','.join(header)}, and may have seconds; "
            "with one --case, case may be left out"
        )
    rows: dict[str, list[Row]] = {}
    for read in columns.rows:
        row = replace(read, cells=only | read.cells)
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


def _suite_of(columns: Sequence[str], cases: Sequence[str]) -> str:
    of_first = (suite for suite in AT_REST if cases and cases[0] in references(suite))
    at_rest = next(of_first, "statics")
    return "motion" if "time" in columns else "modes" if "mode" in columns else at_rest


def _open(suite: str, row: Row) -> bool:
    """Whether none of the numbers of a row is filled in."""
    return not any(row.cells[name] for name in HEADERS[suite] if name not in PLACES)


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
    read = _frequencies if reference.suite == "modes" else _displacements
    return Answer(reference, read(path, reference, rows), float(np.mean(seconds)) if seconds else None)


def _displacements(path: Path, reference: Reference, rows: list[Row]) -> np.ndarray:
    """At every probe and, of a motion, every time of the reference."""
    probes = list(reference.scene.probes)
    values = np.full(reference.values.shape, np.nan)
    times: list[float] = []
    for row in rows:
        if row.cells["probe"] not in probes:
            raise row.refused("probe", f"{reference.name} has {', '.join(probes)}")
        at: tuple[int, ...] = (probes.index(row.cells["probe"]),)
        if reference.time is not None:
            time = row.number("time")
            times.append(time)
            sample = int(np.abs(reference.time - time).argmin())
            if abs(reference.time[sample] - time) > SAME_TIME * reference.time[-1]:
                continue
            at += (sample,)
        if not np.isnan(values[at][0]):
            raise row.refused("probe", "is there twice" if reference.time is None else "has this time twice")
        values[at] = [row.number(name) for name in ("ux", "uy", "uz")]
    for missing in np.argwhere(np.isnan(values[..., 0])):
        without = "" if reference.time is None else f" at {_missing(reference.time, times, missing[1])}"
        raise BadInput(f"{path}: case {reference.name}: probe {probes[missing[0]]} is missing{without}")
    return values


def _missing(needed: np.ndarray, given: list[float], sample: int) -> str:
    """The first time that is needed and not given, which all are needed, and what is given instead."""
    every = f"{len(needed)} times are needed, every {needed[1]:g} s from 0 to {needed[-1]:g} s"
    refusal = (
        f"{needed[sample]:g} s: {every}; given are {len(set(given))} from {min(given):g} to {max(given):g} s"
    )
    if max(given) > 30.0 * needed[-1]:
        refusal += ", as in ms: name the column time [ms]"
    return refusal


def _frequencies(path: Path, reference: Reference, rows: list[Row]) -> np.ndarray:
    frequencies = {int(row.number("mode")): row.number("frequency") for row in rows}
    missing = [n for n in range(1, len(reference.values) + 1) if n not in frequencies]
    if missing:
        raise BadInput(f"{path}: case {reference.name}: mode {missing[0]} is missing")
    return np.array([frequencies[n] for n in range(1, len(reference.values) + 1)])
