"""What the reference set shows: its cases, and as files scenes, values and a form for answers."""

from __future__ import annotations

import csv
import io
from collections.abc import Mapping, Sequence
from functools import partial
from typing import Any

from comparisons.scoring.answers import HEADERS
from comparisons.scoring.reference import Reference, document, references
from comparisons.scoring.score import Standing, own_models
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Report
from sheetbench.answers.table import Table

CASE = ("name", "suite", "bar", "agreeing", "why")
LICENCE = """\
The values of the reference set (suite.json, values-*.csv) are licensed under the Creative Commons Attribution
4.0 International licence (CC-BY-4.0, https://creativecommons.org/licenses/by/4.0/): use them as you like, and
say that they are the reference set {version} of sheetbench. The program has a licence of its own.
"""


def report(suite: str | None = None) -> Report:
    """What `sheetbench suite` shows of all cases, or those of one suite."""
    known = references(suite)
    whole = document()
    kept = {**whole, "cases": [case for case in whole["cases"] if case["name"] in known]}
    suites = dict.fromkeys(case.suite for case in known.values())
    texts = {
        "LICENCE.txt": LICENCE.format(version=whole["version"]),
        **{f"{name}.toml": _toml(case) for name, case in known.items()},
        **{f"values-{name}.csv": _values(list(references(name).values())) for name in suites},
        **{f"answers-{name}.csv": _form(list(references(name).values())) for name in suites},
    }
    return Report(
        name="suite",
        page="cases",
        title=f"reference set {whole['version']}",
        subtitle=f"{len(known)} cases, {whole['licence']}",
        document=kept,
        tables=(
            Table.of(Reference, known.values(), "Cases of the reference set", "cases", fields=CASE),
            *([standing(known)] if suite in (None, "statics") else []),
        ),
        notes=(
            "bar: what the reference's mesh leaves uncertain, of its largest value; agreeing: codes within "
            "that or 1 %",
            "--out DIR writes scenes, values and forms to fill in; sheetbench score answers-statics.csv",
        ),
        attachments={name: partial(write_text, text=text) for name, text in texts.items()},
        settings={"suite": suite},
    )


def standing(cases: Mapping[str, Reference]) -> Table:
    """How our own models and other programs fare on the statics, the best first."""
    ours = own_models([case for case in cases.values() if case.suite == "statics"])
    rows = sorted(ours, key=lambda one: one.score)
    text = (
        "score: geometric mean of the errors on the statics, 100 % for a case that is refused; worst: of "
        "those answered; time: of a solve, geometric mean, on "
        f"{document()['made_with']['machine'].get('processor', 'the machine that made the set')}"
    )
    fields = ("model", "score", "worst_error", "worst", "refused", "seconds")
    caption = "Our models and other programs on the statics"
    return Table.of(Standing, rows, caption, "standing", fields=fields, text=text)


def _toml(case: Reference) -> str:
    from sheetbench.scenes.toml import to_toml

    return to_toml(case.scene)


def _values(cases: Sequence[Reference]) -> str:
    """Values and bars as CSV."""
    if cases[0].suite == "modes":
        rows: list[list[Any]] = [["case", "mode", "frequency", "bar"]]
        for case in cases:
            rows += [
                [case.name, n + 1, f, by]
                for n, (f, by) in enumerate(zip(case.values, case.bars, strict=True))
            ]
        return _csv(rows)
    moving = cases[0].suite == "settling"
    head = ["ux", "uy", "uz", "bar_x", "bar_y", "bar_z"]
    rows = [["case", *(["time"] if moving else []), "probe", "x", "y", *head]]
    for case in cases:
        for probe, u, by in zip(case.scene.probes.items(), case.values, case.bars, strict=True):
            name, point = probe
            if case.time is None:
                rows.append([case.name, name, *point, *u, *by])
            else:
                rows += [
                    [case.name, time, name, *point, *u[n], *by[n]]
                    for n, time in enumerate(case.time.tolist())
                ]
    return _csv(rows)


def _form(cases: Sequence[Reference]) -> str:
    """A file of answers with the numbers left out."""
    suite = cases[0].suite
    rows: list[list[Any]] = [[*HEADERS[suite], "seconds"]]
    for case in cases:
        if suite == "modes":
            rows += [[case.name, n + 1, "", ""] for n in range(len(case.values))]
        elif case.time is None:
            rows += [[case.name, probe, "", "", "", ""] for probe in case.scene.probes]
        else:
            rows += [
                [case.name, time, probe, "", "", "", ""]
                for probe in case.scene.probes
                for time in case.time.tolist()
            ]
    return _csv(rows)


def _csv(rows: Sequence[Sequence[Any]]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()
