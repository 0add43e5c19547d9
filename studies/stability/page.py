"""docs/stability.md from stability/page.txt and the tables of the full run beside it: `make stability-full`.

The page is a Jinja template: prose with its figures as questions of the rows, by the functions here.
"""

from __future__ import annotations

import csv
import json
import math
import textwrap
from collections import Counter
from fnmatch import fnmatchcase
from functools import cache
from pathlib import Path
from typing import Any

from jinja2 import Environment, StrictUndefined

FOLDER = Path(__file__).parents[2] / "docs" / "stability"
PAGE = FOLDER.parent / "stability.md"
STUDIES = ("time-step", "stiffness", "slenderness", "grid", "load", "damping", "mass", "curved-edge")
WIDTH = 120

Row = dict[str, Any]  # numbers as such, "" where there is none


def main() -> None:
    """Write the page. Raises SystemExit where its prose says what the rows do not."""
    PAGE.write_text(page(), encoding="utf-8")
    print(PAGE)


def page() -> str:
    """The page's text."""
    untrue = [promise for promise, holds in promises().items() if not holds]
    if untrue:
        raise SystemExit(f"docs/stability/page.txt says what these rows do not: {'; '.join(untrue)}")
    template = (FOLDER / "page.txt").read_text(encoding="utf-8")
    made = Environment(undefined=StrictUndefined, keep_trailing_newline=True).from_string(template)
    asked = {"rows": rows, "within": within, "percent": percent, "far": far, "times_regular": times_regular}
    return made.render(**asked, **run())


def promises() -> dict[str, bool]:
    """What the prose says without a figure, and whether it is so."""
    off, drifts = far("slenderness"), [*rows("time-step", integrator="midpoint"), *rows("mass")]
    return {
        "no cell failed": not any(row["status"] in ("failed", "lost") for row in _every()),
        "cells that are off say that the grid decides": all("not unique" in r["message"] for r in off),
        "one edge clamped, none is": all(r["clamped"] == 2 for r in off),
        "in single precision 1e-5 and 1e-6 are unstable": {
            r["single status"] for r in rows("slenderness", slenderness=(0, 2e-5), single_status="?*")
        }
        == {"unstable"},
        "pressed, both bend and are stable": all(
            r["status"] == r["reference"] == "converged" for r in rows("load", kind="compression")
        ),
        "midpoint drifts by less than 1e-9": all(abs(r["energy drift"] or 0.0) < 1e-9 for r in drifts),
    }


def run() -> dict[str, Any]:
    """How the cells ended, how long they took, when and on what."""
    manifest = json.loads((FOLDER / "manifest.json").read_text(encoding="utf-8"))
    ended = Counter(row["status"] for row in _every())
    counts = [f"{n} {s if '-' not in s and s != 'unstable' else f'`{s}`'}" for s, n in ended.most_common()]
    machine, note = manifest["machine"], manifest.get("note")
    return {
        "cells": ended.total(),
        "minutes": f"{sum(row['seconds [s]'] for row in _every()) / 60.0:.0f}",
        "ended": ", ".join(counts),
        "where": f"sheetbench {manifest['sheetbench']}, Python {machine['python']}, {machine['processor']}, "
        f"{manifest['date'][:10]}",
        "note": f"*{textwrap.fill(note, WIDTH, break_on_hyphens=False)}*\n\n" if note else "",
    }


def rows(study: str, **wanted: Any) -> list[Row]:
    """The rows of a study whose columns are as wanted: a number, one from low to high, or a text with * and
    ?."""
    return [r for r in _table(study) if all(_is(r[k.replace("_", " ")], v) for k, v in wanted.items())]


def _is(value: Any, wanted: Any) -> bool:
    if isinstance(wanted, tuple):
        return value != "" and wanted[0] <= value <= wanted[1]
    return fnmatchcase(str(value), wanted) if isinstance(wanted, str) else bool(value == wanted)


@cache
def _table(study: str) -> list[Row]:
    with (FOLDER / f"{study}.csv").open(encoding="utf-8", newline="") as table:
        return [{key: _number(text) for key, text in row.items()} for row in csv.DictReader(table)]


def _number(text: str) -> Any:
    try:
        return float(text)
    except ValueError:
        return text


def _every() -> list[Row]:
    return [row for study in STUDIES for row in _table(study)]


def far(study: str) -> list[Row]:
    """Those off by more than 5 %."""
    return rows(study, status="converged", error=(0.05, math.inf))


def within(of: list[Row], column: str = "error") -> str:
    """The largest of a column in percent, rounded up to two digits."""
    value = max(abs(100.0 * row[column]) for row in of if row[column] != "")
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return f"{math.ceil(value / step - 1e-9) * step:.6g}"


def percent(of: list[Row]) -> str:
    """The first row's error in percent, of two digits."""
    return f"{float(format(100.0 * of[0]['error'], '.2g')):g}"


def times_regular(of: list[Row]) -> str:
    """The largest error of a mesh of moved nodes over the regular one's, rounded up."""
    regular, times = 0.0, 0.0
    for row in of:
        if row["distortion"] == 0.0:
            regular = row["error"]
        elif row["status"] == "converged" and row["error"] != "":
            times = max(times, row["error"] / regular)
    return f"{math.ceil(10.0 * times) / 10.0:.1f}"


if __name__ == "__main__":
    main()
