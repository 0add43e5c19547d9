"""Advice as people read it: what was tried, what to solve, what the scene needs and what is left out."""

from __future__ import annotations

from shlex import join
from typing import TYPE_CHECKING

from comparisons.models.candidate import series, written
from comparisons.models.grading import read
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table, number, quantity
from sheetbench.choices import CALIBRATION
from sheetbench.scenes.summary import few

if TYPE_CHECKING:
    from comparisons.advice.advisor import Advice


def report(advice: Advice, named: str = "") -> Report:
    """What `sheetbench advise` shows; named: how the scene was asked for, its name unless said."""
    line = command(advice, named)
    return Report(
        name="advice",
        title=advice.scene.name,
        subtitle=advice.scene.title,
        document={**advice.as_dict(), "command": line},
        tables=(tried(advice),),
        notes=(*sentences(advice), *([] if line is None else ["Solve it with:", line])),
        complaints=() if advice.met else (advice.reason,),
        met=advice.met,
    )


def tried(advice: Advice) -> Table:
    """A row per probing solve, the quickest first; the choice is marked."""
    chosen = None if advice.choice is None else (advice.choice.model, advice.choice.settings)
    rows = [
        (
            series(row["model"], row["settings"]),
            "×".join(str(n) for n in row["settings"].get("grid") or row["settings"]["elements"]),
            row["solve_seconds"],
            row["error"],
            "yes" if (row["model"], row["settings"]) == chosen else "",
            row["status"],
        )
        for row in sorted(advice.tried, key=lambda row: float(row["solve_seconds"]))
    ]
    columns = (
        Column("model", prose=True),
        Column("size"),
        Column("solve", "s", "ms", 1e3, ".2f"),
        Column("error", "", "%", 100.0, ".3g"),
        Column("choice"),
        Column("status", prose=True),
    )
    return Table("Quick solves; errors are distances from the finest one", columns, tuple(rows), "tried")


def sentences(advice: Advice) -> list[str]:
    """The advice and its reasons, a sentence a line."""
    scales = advice.scales
    return [
        f"load number q L³/D = {number(scales.span_load_number, '.3g')}, "
        f"L = {quantity(scales.span, 'm', '.4g')} from the edges that hold the sheet",
        f"h/a = {number(scales.slenderness, '.3g')}, q a/(E h) = {number(scales.strain, '.2g')}, "
        "a the shorter side",
        f"needs {', '.join(advice.needs)}",
        *(f"leaves out {left}" for left in advice.left_out),
        *(said for said in (advice.grading, advice.calibration) if said),
        *advice.warnings,
        f"{advice.reason} (probing took {few(advice.probing_seconds)} s)",
    ]


def command(advice: Advice, named: str = "") -> str | None:
    """The command line that solves the choice; None without one."""
    if advice.choice is None:
        return None
    model, settings = advice.choice.model, dict(advice.choice.settings)
    mirrored = ["--symmetry"] if settings.pop("symmetry", False) else []
    graded = settings.pop("grading", 0.0) if model == "lumped" and "linear" not in settings else 0.0
    mirrored += ["--grading", f"{read(graded):g}"] if graded else []
    if model == "lumped" and settings.keys() == {"grid", "calibration"}:
        named_too = settings["calibration"] != CALIBRATION
        springs = ["--calibration", settings["calibration"]] if named_too else []
        options = ["--lumped", "x".join(map(str, settings["grid"])), *springs, *mirrored]
    elif model != "lumped" and settings.keys() == {"elements"}:
        options = ["--reference", model, "--elements", "x".join(map(str, settings["elements"])), *mirrored]
    else:
        options = ["--model", written(advice.choice)]
    return join(["sheetbench", "compare", named or advice.scene.name, *options])
