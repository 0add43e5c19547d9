"""Advice as people read it: what was tried, what to solve, what the scene needs and what is left out."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.models.candidate import series
from comparisons.report.report import Report
from comparisons.report.table import Column, Table, number

if TYPE_CHECKING:
    from comparisons.advice.advisor import Advice


def report(advice: Advice) -> Report:
    """What `sheetbench advise` shows."""
    return Report(
        name="advice",
        title=advice.scene.name,
        subtitle=advice.scene.title,
        document=advice.as_dict(),
        tables=(tried(advice),),
        notes=tuple(sentences(advice)),
        complaints=() if advice.met else (advice.reason,),
        scene=advice.scene,
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
        Column("error", "", "%", 100.0, ".2g"),
        Column("choice"),
        Column("status", prose=True),
    )
    return Table("Quick solves; errors are distances from the finest one", columns, tuple(rows), "tried")


def sentences(advice: Advice) -> list[str]:
    """The advice and its reasons, a sentence a line."""
    scales = advice.scales
    said = [
        f"load number q a³/D = {number(scales.load_number, '.3g')}, "
        f"h/a = {number(scales.slenderness, '.3g')}, q a/(E h) = {number(scales.strain, '.2g')}",
        f"needs {', '.join(advice.needs)}",
        *(f"leaves out {left}" for left in advice.left_out),
        f"{advice.reason} (probing took {advice.probing_seconds:.2g} s)",
    ]
    if advice.choice is not None:
        settings = ", ".join(f"{name} = {value}" for name, value in advice.choice.settings.items())
        said.append(f"Solve {advice.choice.model} with {settings}.")
    return said
