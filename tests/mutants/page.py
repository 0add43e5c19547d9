"""The page of what the tests notice: the share of faults caught, and each survivor with what is known of it.

equivalent.toml says of survivors why no test can tell them from the original; they leave the count.

Usage: python tests/mutants/page.py FOLDER/tried.jsonl docs/quality.md
"""

from __future__ import annotations

import argparse
import datetime
import json
import platform
import tomllib
from collections.abc import Sequence
from math import sqrt
from pathlib import Path
from typing import Any

from reach import PACKAGES
from session import COMPILING, ENOUGH, EQUIVALENT

from comparisons.runs.manifest import processor

HEAD = """\
# What the tests notice

Faults put into the packages one at a time, and the tests run against each until one fails. A fault is one
comparison, operator, number, index, condition or sign written otherwise, or one statement left out; as many
of each package are drawn, every one as likely as another. It is tried on the tests that
run the faulty function, the quick ones first, and on those that are near: that import the module, that speak
of it or of its function; kernels before they are compiled, and after. What has not been noticed after
{enough:.0f} seconds of processor time, or {compiled:.0f} where kernels are compiled, has survived, though
the whole suite might catch it; one that a test was then written for is tried again, and counts as caught.

Written by `make mutants` on {day}, of the {size} faults tried so far (it goes on where it stopped): Python
{python}, {processor}; commits {commits}. In the mean a fault took {mean:.0f} seconds of processor time.

| package | tried | caught | equivalent | caught of those that can be told (95 % interval) |
|---|---:|---:|---:|---:|
"""


def page(rows: Sequence[dict[str, Any]], reasons: dict[str, str]) -> str:
    """Markdown: a row a package, then the survivors."""
    times = [row["seconds"] for row in rows if row["seconds"] is not None]
    text = HEAD.format(
        enough=ENOUGH,
        compiled=ENOUGH + COMPILING,
        size=len(rows),
        day=datetime.date.today().isoformat(),
        python=platform.python_version(),
        processor=processor(),
        commits=", ".join(dict.fromkeys(row["commit"] for row in rows)),
        mean=sum(times) / len(times),
    )
    for package in PACKAGES:
        here = [row for row in rows if row["fault"].startswith(f"{package}/")]
        caught = sum(row["failed"] is not None for row in here)
        same = sum(row["failed"] is None and row["fault"] in reasons for row in here)
        share = interval(caught, len(here) - same) if len(here) > same else "–"
        text += f"| {package} | {len(here)} | {caught} | {same} | {share} |\n"
    survivors = sorted((row for row in rows if row["failed"] is None), key=lambda row: row["fault"])
    missing = [row for row in survivors if row["fault"] not in reasons]
    text += "\n## Not caught\n\n" + ("".join(map(entry, missing)) or "None.\n")
    text += "\n## No test can tell\n\nThe answer is the same, or as right.\n\n"
    return text + "".join(
        f"{entry(row).rstrip()}\n  {reasons[row['fault']]}\n" for row in survivors if row["fault"] in reasons
    )


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
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("tried", type=Path)
    asked.add_argument("page", type=Path)
    options = asked.parse_args()
    rows = {row["fault"]: row for row in map(json.loads, options.tried.read_text().splitlines())}
    reasons = tomllib.loads(EQUIVALENT.read_text())["equivalent"]
    options.page.write_text(page(list(rows.values()), reasons))
    print(options.page)


if __name__ == "__main__":
    main()
