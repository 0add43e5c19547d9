"""docs/stability.md from stability/page.txt and the tables of the full run beside it: `make stability-full`.

The page is prose with named figures in braces; here is what each of them is, of the run's rows.
"""

from __future__ import annotations

import csv
import json
import math
import textwrap
from collections import Counter
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parents[2] / "docs" / "stability"
PAGE = FOLDER.parent / "stability.md"
STUDIES = ("time-step", "stiffness", "slenderness", "grid", "load", "damping", "mass", "curved-edge")
WIDTH = 120

Row = dict[str, str]


def main() -> None:
    """Write the page. Raises SystemExit where its prose says what the rows do not."""
    PAGE.write_text(page(), encoding="utf-8")
    print(PAGE)


def page() -> str:
    """The page's text."""
    rows = {name: _rows(name) for name in STUDIES}
    manifest = json.loads((FOLDER / "manifest.json").read_text(encoding="utf-8"))
    untrue = [promise for promise, holds in promises(rows).items() if not holds]
    if untrue:
        raise SystemExit(f"docs/stability/page.txt says what these rows do not: {'; '.join(untrue)}")
    texts = figures(rows) | run(rows, manifest)
    return (FOLDER / "page.txt").read_text(encoding="utf-8").format_map(texts)


def promises(rows: dict[str, list[Row]]) -> dict[str, bool]:
    """What the prose says without a figure, and whether it is so."""
    every = [row for study in rows.values() for row in study]
    slender, loads = rows["slenderness"], rows["load"]
    foil = [r["single status"] for r in slender if r["single status"] and _number(r, "slenderness") < 2e-5]
    midpoint = [r for r in rows["time-step"] if r["integrator"] == "midpoint" and r["energy drift"]]
    return {
        "no cell failed": not any(row["status"] in ("failed", "lost") for row in every),
        "cells that are off say that the grid decides": all(
            "not unique" in r["message"] for r in _far(slender)
        ),
        "one edge clamped, none is": all(r["clamped"] == "2" for r in _far(slender)),
        "in single precision 1e-5 and 1e-6 are unstable": set(foil) == {"unstable"},
        "pressed, both bend and are stable": all(
            r["status"] == r["reference"] == "converged" for r in loads if r["kind"] == "compression"
        ),
        "midpoint loses no energy": all(abs(_number(r, "energy drift")) < 1e-9 for r in midpoint),
        "uneven masses drift by less than 1e-9": all(
            abs(_number(r, "energy drift")) < 1e-9 for r in rows["mass"] if r["energy drift"]
        ),
    }


def run(rows: dict[str, list[Row]], manifest: dict[str, Any]) -> dict[str, str]:
    """How the cells ended, how long they took, when and on what."""
    every = [row for study in rows.values() for row in study]
    ended = Counter(row["status"] for row in every)
    counts = [f"{n} {s if '-' not in s and s != 'unstable' else f'`{s}`'}" for s, n in ended.most_common()]
    machine, note = manifest["machine"], manifest.get("note")
    return {
        "cells": str(len(every)),
        "minutes": f"{sum(_number(row, 'seconds [s]') for row in every) / 60.0:.0f}",
        "ended": ", ".join(counts),
        "where": f"sheetbench {manifest['sheetbench']}, Python {machine['python']}, {machine['processor']}, "
        f"{manifest['date'][:10]}",
        "note": f"*{textwrap.fill(note, WIDTH, break_on_hyphens=False)}*\n\n" if note else "",
    }


def figures(rows: dict[str, list[Row]]) -> dict[str, str]:
    """The figures of the page's prose, by name; errors in percent."""
    steps, stiff, slender, grids = (rows[name] for name in STUDIES[:4])
    loads, damped, uneven, bent = (rows[name] for name in STUDIES[4:])
    plain = [r for r in slender if not r["poisson"] and _converged(r)]
    single = [r for r in slender if r["single error"] and r["single status"] == "converged"]
    even = [r for r in grids if r["calibration"] and not r["aspect"]]
    folds = [r for r in bent if r["message"].startswith("snapped")]
    distorted = [r for r in grids if r["model"]]

    def at(study: list[Row], column: str = "error", **wanted: str) -> float:
        return _number(next(r for r in study if all(r[k] == v for k, v in wanted.items())), column)

    def thin(limit: Callable[[float], bool]) -> list[Row]:
        return [r for r in single if limit(_number(r, "slenderness"))]

    return {
        "verlet": _within(_worst(r for r in steps if r["integrator"] == "verlet")),
        "load_number": _within(
            _worst(r for r in stiff if r["load number"] and _number(r, "load number") <= 1e3)
        ),
        "one_edge": _within(_worst(r for r in plain if r["clamped"] == "1")),
        "two_edges": _within(_worst(r for r in plain if r["clamped"] == "2")),
        "far": str(len(_far(slender))),
        "poisson": _within(_worst(r for r in slender if r["poisson"])),
        "single": _within(_worst(thin(lambda h: h > 2e-4), "single error"), "single error"),
        "single_thinnest": _within(_worst(thin(lambda h: h < 2e-4), "single error"), "single error"),
        "coarsest": _percent(at(even, clamped="1", masses="2", calibration="consistent")),
        "finest": _percent(at(even, clamped="1", masses="257", calibration="consistent")),
        "factorisations": f"{at(even, 'iterations', masses='257'):.0f}",
        "finest_seconds": f"{at(even, 'seconds [s]', clamped='2', masses='257'):.0f}",
        "uniform_5": _percent(at(even, clamped="2", masses="5", calibration="uniform")),
        "uniform_17": _percent(at(even, clamped="2", masses="17", calibration="uniform")),
        "narrow": _within(_worst(r for r in grids if r["status"] == "unstable")),
        "distorted": f"{math.ceil(10.0 * _times_regular(distorted)) / 10.0:.1f}",
        "heavy": _percent(at(loads, kind="weight", size="100.0")),
        "barely": _percent(at(loads, kind="compression", size="1.2")),
        "pressed": _within(
            _worst(r for r in loads if r["kind"] == "compression" and _number(r, "size") >= 1.5)
        ),
        "pulled": _percent(at(loads, kind="pull", size="0.1")),
        "oscillator": _within(
            _worst(r for r in damped if r["integrator"] in ("generalised-alpha", "midpoint"))
        ),
        "uneven": _within(_worst(uneven)),
        "bent": _within(_worst(r for r in bent if _number(r, "load number") <= 10.0)),
        "folded": _within(_worst(r for r in folds if _number(r, "load number") <= 30.0)),
        "bent_off": str(len(_far(bent))),
        "bent_inverted": str(sum(r["status"] == "inverted" for r in bent)),
    }


def _rows(name: str) -> list[Row]:
    with (FOLDER / f"{name}.csv").open(encoding="utf-8", newline="") as table:
        return list(csv.DictReader(table))


def _number(row: Row, column: str) -> float:
    return float(row[column] or "nan")


def _converged(row: Row) -> bool:
    return row["status"] == "converged" and row["error"] != ""


def _far(rows: list[Row]) -> list[Row]:
    """Those off by more than 5 %."""
    return [row for row in rows if _converged(row) and _number(row, "error") > 0.05]


def _worst(rows: Iterable[Row], column: str = "error") -> Row:
    return max((r for r in rows if r[column]), key=lambda r: abs(_number(r, column)))


def _within(row: Row, column: str = "error") -> str:
    """In percent, rounded up to two digits."""
    value = abs(100.0 * _number(row, column))
    step = 10.0 ** (math.floor(math.log10(value)) - 1)
    return f"{math.ceil(value / step - 1e-9) * step:.6g}"


def _percent(value: float) -> str:
    """In percent, of two digits."""
    return f"{float(f'{100.0 * value:.2g}'):g}"


def _times_regular(rows: list[Row]) -> float:
    """The largest error of a mesh of moved nodes over the regular one's."""
    regular, times = 0.0, 0.0
    for row in rows:
        if _number(row, "distortion") == 0.0:
            regular = _number(row, "error")
        elif _converged(row):
            times = max(times, _number(row, "error") / regular)
    return times


if __name__ == "__main__":
    main()
