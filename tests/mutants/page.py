"""The figures of docs/quality.md: the share of faults noticed, and each survivor with what is known of it.

A fault is noticed where a test of the commit that it was first tried on fails with it; mended where only a
test that was written since does. equivalent.toml says of survivors why no test can tell them from the
original; they leave the count. Written is what stands after the page's heading of the trial.

Usage: python tests/mutants/page.py docs/quality.md
"""

from __future__ import annotations

import datetime
import platform
import sys
import tomllib
from math import sqrt
from pathlib import Path
from typing import Any

from session import COMPILING, DRAWS, ENOUGH, EQUIVALENT, NEAREST, trials

from comparisons.runs.manifest import processor

TITLE = "### Figures\n"
HEAD = """
{size} faults, {kernels} of them in files with compiled kernels, seed {seed}; {day}, Python {python},
{processor}; commits {commits}.
A fault was tried for up to {enough:.0f} seconds of processor time on the {files} nearest files of tests,
for up to {compiled:.0f} where kernels were compiled for it.

| files | package | tried | noticed | mended | equivalent | not caught | noticed of those that can be told \
(95 % interval) | with the new tests |
|---|---|---:|---:|---:|---:|---:|---:|---:|
"""

Trials = list[dict[str, Any]]


def page(tried: dict[str, Trials], reasons: dict[str, str]) -> str:
    """Markdown: a row a draw and package, then the survivors."""
    rows = [row for trials in tried.values() for row in trials]
    text = HEAD.format(
        seed=", ".join(sorted({str(draw.seed) for draw in DRAWS.values()})),
        size=len(tried),
        kernels=sum(trials[0]["draw"] == "kernels" for trials in tried.values()),
        enough=ENOUGH,
        files=NEAREST[-1],
        compiled=ENOUGH + COMPILING,
        day=datetime.date.today().isoformat(),
        python=platform.python_version(),
        processor=processor(),
        commits=", ".join(dict.fromkeys(row["commit"] for row in rows)),
    )
    for name, draw in DRAWS.items():
        for package in draw.shares:
            text += line(f"| {name} | {package} |", tried, reasons, name, f"{package}/")
        text += line(f"| {name} | all |", tried, reasons, name)
    text += line("| all | all |", tried, reasons)
    survivors = {fault: trials[-1] for fault, trials in sorted(tried.items()) if trials[-1]["failed"] is None}
    missing = [entry(row) for fault, row in survivors.items() if fault not in reasons]
    text += "\n### Not caught\n\n" + ("".join(missing) or "None.\n")
    text += "\n### No test can tell\n\nThe answer is the same, or as right.\n\n"
    return text + "".join(
        f"{entry(row)}  {reasons[fault]}\n" for fault, row in survivors.items() if fault in reasons
    )


def line(
    start: str, tried: dict[str, Trials], reasons: dict[str, str], draw: str = "", package: str = ""
) -> str:
    """A row of the table: of a draw and a package, or of all."""
    here = {
        fault: trials
        for fault, trials in tried.items()
        if trials[0]["draw"].startswith(draw) and fault.startswith(package)
    }
    of_first = {
        fault: [t for t in trials if t["commit"] == trials[0]["commit"]] for fault, trials in here.items()
    }
    noticed = sum(any(row["failed"] for row in trials) for trials in of_first.values())
    caught = sum(trials[-1]["failed"] is not None for trials in here.values())
    same = sum(trials[-1]["failed"] is None and fault in reasons for fault, trials in here.items())
    told = len(here) - same
    counts = (len(here), noticed, caught - noticed, same, told - caught)
    shares = (interval(noticed, told), interval(caught, told)) if told else ("–", "–")
    return f"{start} {' | '.join(map(str, (*counts, *shares)))} |\n"


def interval(caught: int, tried: int) -> str:
    """A share and what it tells of all faults: Wilson's interval (1927) at 95 %."""
    share, z = caught / tried, 1.96
    middle, room = share + z**2 / (2 * tried), z * sqrt(share * (1 - share) / tried + (z / (2 * tried)) ** 2)
    low, high = ((middle + side) / (1 + z**2 / tried) for side in (-room, room))
    return f"{100 * share:.0f} % ({100 * low:.0f} to {100 * high:.0f})"


def entry(row: dict[str, Any]) -> str:
    """A fault as an item of a list, with the line that it stands in."""
    where, _, what = row["fault"].partition(": ")
    return f"- {where}: `{what}`, in `{row['code']}`\n"


def main() -> None:
    place = Path(sys.argv[1])
    before, _, _ = place.read_text().partition(TITLE)
    reasons = tomllib.loads(EQUIVALENT.read_text())["equivalent"]
    place.write_text(before + TITLE + page(trials(), reasons))
    print(place)


if __name__ == "__main__":
    main()
