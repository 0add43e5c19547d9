"""A user's answers to a suite, from a CSV file (`comparisons.identification.columns`); SI units.

statics  case,probe,ux,uy,uz[,seconds]; also for curves, natural and contact
motion   case,probe,time,ux,uy,uz[,seconds]: a sample at every time of the reference, without interpolation;
         samples at other times are ignored
modes    case,mode,frequency[,seconds]: modes count from 1, lowest first

The header determines the suite; the first case selects one of the suites at rest. The column `case` may be
missing if one case is requested, as in the history of a simulation. A form may be filled in stages: a case
with a row of empty numbers is open.
"""

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
PLACES = ("case", "probe", "time", "mode")  # columns that identify a row, not values
SAME_TIME = 1e-6  # of the duration


@dataclass(frozen=True, eq=False)
class Answer:
    """An answer to a case; values: in the reference's form; seconds: time of the solve, None if not given."""

    reference: Reference
    values: np.ndarray
    seconds: float | None


def read_answers(
    path: Path, suite: str | None = None, chosen: Sequence[str] = ()
) -> tuple[list[Answer], list[Reference]]:
    """Return the answers to a suite, or to chosen cases of it, and the open cases. suite: by default from the
    header. Raises BadInput naming an unknown case, or a case's missing or repeated row."""
    columns = read_columns(path)
    suite = suite or _suite_of(columns.names, [*chosen, *(row.cells.get("case", "") for row in columns.rows)])
    cases = references(suite)
    requested = [reference(name, suite) for name in dict.fromkeys(chosen)] or list(cases.values())
    header = HEADERS[suite]
    default = {"case": requested[0].name} if len(chosen) == 1 else {}
    if not set(header) <= {*columns.names, *default}:
        raise BadInput(
            f"{path}: the header of {suite} must be {','.join(header)}, and may have seconds; "
            "with one --case, case may be left out"
        )
    rows: dict[str, list[Row]] = {}
    for read in columns.rows:
        row = replace(read, cells=default | read.cells)
        if row.cells["case"] not in cases:
            raise row.refused("case", _unknown(row.cells["case"], suite))
        rows.setdefault(row.cells["case"], []).append(row)
    closed = [
        case
        for case in requested
        if case.name in rows and not any(_open(suite, row) for row in rows[case.name])
    ]
    if not closed:
        names = ", ".join(case.name for case in requested[:4])
        raise BadInput(f"{path}: no answer yet to {names}: fill in the numbers of a case")
    unanswered = [case for case in requested if case not in closed]
    return [_answer(path, case, rows[case.name]) for case in closed], unanswered


def _suite_of(columns: Sequence[str], cases: Sequence[str]) -> str:
    at_rest = next((suite for suite in AT_REST if cases and cases[0] in references(suite)), "statics")
    return "motion" if "time" in columns else "modes" if "mode" in columns else at_rest


def _open(suite: str, row: Row) -> bool:
    """Return whether all numbers of a row are empty."""
    return not any(row.cells[name] for name in HEADERS[suite] if name not in PLACES)


def _unknown(name: str, suite: str) -> str:
    """Return a refusal of an unknown case, with its own suite or a similar name."""
    case = references().get(name)
    if case is not None:
        return f"a case of {case.suite}: score it with --suite {case.suite}"
    close = get_close_matches(name, references(suite), 1)
    return f"{suite} has no such case" + (f"; did you mean {close[0]}?" if close else "")


def _answer(path: Path, reference: Reference, rows: list[Row]) -> Answer:
    times = [row.measured("seconds") for row in rows if "seconds" in row.cells]
    seconds = [value for value in times if value == value]
    read = _frequencies if reference.suite == "modes" else _displacements
    return Answer(reference, read(path, reference, rows), float(np.mean(seconds)) if seconds else None)


def _displacements(path: Path, reference: Reference, rows: list[Row]) -> np.ndarray:
    """Return displacements at every probe and, for motion, at every time of the reference."""
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
        time_text = "" if reference.time is None else f" at {_missing(reference.time, times, missing[1])}"
        raise BadInput(f"{path}: case {reference.name}: probe {probes[missing[0]]} is missing{time_text}")
    return values


def _missing(needed: np.ndarray, given: list[float], sample: int) -> str:
    """Return a refusal: the missing time, the needed times, and the given times."""
    times = f"{len(needed)} times are needed, every {needed[1]:g} s from 0 to {needed[-1]:g} s"
    refusal = (
        f"{needed[sample]:g} s: {times}; given are {len(set(given))} from {min(given):g} to {max(given):g} s"
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
