"""The reference set as an answer: its cases, and as files scenes, values and a form for answers."""

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np

from comparisons.scoring.answers import HEADERS, PLACES
from comparisons.scoring.reference import Reference, document, references
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Table
from sheetbench.scenes.language.toml import to_toml

CASE = ("name", "suite", "bar", "agreeing", "why")
LICENCE = """\
The values of the reference set (suite.json, values-*.csv) are licensed under the Creative Commons Attribution
4.0 International licence (CC-BY-4.0, https://creativecommons.org/licenses/by/4.0/): use them as you like, and
say that they are the reference set {version} of sheetbench. The program has a licence of its own.
"""


class Suite(Answer):
    """The cases of the reference set, or of one suite, as `sheetbench score` lists them."""

    file_name = "suite"
    page_name = "cases"

    def __init__(self, suite: str | None = None) -> None:
        self.suite = suite
        self.cases = references(suite)
        self._document = document()

    def heading(self) -> tuple[str, str, str]:
        subtitle = f"{len(self.cases)} cases, {self._document['licence']}"
        return f"reference set {self._document['version']}", subtitle, ""

    def document(self) -> dict[str, Any]:
        cases = [case for case in self._document["cases"] if case["name"] in self.cases]
        return {**self._document, "cases": cases}

    def tables(self) -> list[Table]:
        caption = "Cases of the reference set"
        return [Table.of(Reference, self.cases.values(), caption, "cases", fields=CASE)]

    def notes(self) -> tuple[str, ...]:
        return (
            "bar: uncertainty due to the reference's mesh and steps, over its largest value; agreeing: "
            "models within the bar or 1 %",
            "--out DIR writes scenes, values and forms for answers; sheetbench score "
            f"answers-{self.suite or 'statics'}.csv scores a filled one",
        )

    def files(self) -> dict[str, Write]:
        by_suite = {case.suite: list(references(case.suite).values()) for case in self.cases.values()}
        texts = {
            "LICENCE.txt": LICENCE.format(version=self._document["version"]),
            **{f"{name}.toml": to_toml(case.scene) for name, case in self.cases.items()},
            **{f"values-{name}.csv": _values(cases) for name, cases in by_suite.items()},
            **{f"answers-{name}.csv": _form(cases) for name, cases in by_suite.items()},
        }
        return {name: partial(write_text, text=text) for name, text in texts.items()}

    def choices(self) -> dict[str, Any]:
        return {"suite": self.suite}


def _places(case: Reference) -> Iterator[tuple[list[Any], np.ndarray, np.ndarray, Sequence[float]]]:
    """Yield of every row of a case its key columns, values, their bars, and the probe's position [m]."""
    if case.suite == "modes":
        for number, (value, bar) in enumerate(zip(case.values[:, None], case.bars[:, None], strict=True), 1):
            yield [number], value, bar, ()
        return
    for (name, at), u, bar in zip(case.scene.probes.items(), case.values, case.bars, strict=True):
        if case.time is None:
            yield [name], u, bar, at
        else:
            yield from (([name, time], u[n], bar[n], at) for n, time in enumerate(case.time.tolist()))


def _values(cases: Sequence[Reference]) -> str:
    """Return values and bars as CSV; x, y [m]: position of the probe."""
    names, numbers = _columns(cases[0].suite)
    places, bars = (("x", "y"), ("bar_x", "bar_y", "bar_z")) if len(numbers) == 3 else ((), ("bar",))
    rows = ([case.name, *keys, *at, *u, *bar] for case in cases for keys, u, bar, at in _places(case))
    return Table.listed("", [*names, *places, *numbers, *bars], rows).to_csv()


def _form(cases: Sequence[Reference]) -> str:
    """Return a form for answers as CSV, with empty numbers."""
    names, numbers = _columns(cases[0].suite)
    places = ("x", "y") if len(numbers) == 3 else ()
    rows = ([case.name, *keys, *[""] * len(u), "", *at] for case in cases for keys, u, _, at in _places(case))
    return Table.listed("", [*names, *numbers, "seconds", *places], rows).to_csv()


def _columns(suite: str) -> tuple[list[str], list[str]]:
    """Return the key columns of a suite's rows, and the columns of numbers."""
    keys = [name for name in HEADERS[suite] if name in PLACES]
    return keys, [name for name in HEADERS[suite] if name not in PLACES]
