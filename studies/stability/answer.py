"""A study's map, table and text: how its cells ended, and which converged ones are off by more than 5 %."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib
from matplotlib.figure import Figure

from comparisons.stability.rows import Row, broken, doubtful, percent
from comparisons.stability.tiles import MAP_STYLE
from sheetbench.answers.answer import Answer
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.report import Picture
from sheetbench.answers.table import PERCENT, SECONDS, Column, Table
from studies.stability.survey import Study, columns, in_words

_COMMON = columns(
    status="",
    error=PERCENT(".3g"),
    iterations="d",
    seconds=SECONDS(".2f"),
    reference="",
    message=Column(prose=True, detail=True),
)


@dataclass(frozen=True, repr=False)
class StabilityMaps(Answer):
    """The rows of studies: what `sheetbench study stability` shows."""

    studies: Sequence[Study]
    rows: list[Row]

    file_name = "stability"

    def heading(self) -> tuple[str, str, str]:
        return "Where the solvers hold", "", ""

    def document(self) -> dict[str, Any]:
        return {"rows": self.rows}

    def _of(self, study: Study) -> list[Row]:
        return [row for row in self.rows if row["study"] == study.name]

    def tables(self) -> list[Table]:
        return [table(study, self._of(study)) for study in self.studies]

    def figures(self) -> list[Picture]:
        compose = "studies.stability.answer:compose"
        return [Picture(study.name, compose, (study, self._of(study))) for study in self.studies]

    def complaints(self) -> list[str]:
        return broken(self.rows)

    def choices(self) -> dict[str, Any]:
        return {"studies": [study.name for study in self.studies]}

    @property
    def succeeded(self) -> bool:
        return not self.complaints()


def compose(study: Study, rows: list[Row], style: FigureStyle = PLAIN) -> Figure:
    """Return a study's map of its rows."""
    with matplotlib.rc_context(MAP_STYLE):
        figure = Figure(figsize=study.size, layout="constrained")
        study.draw(figure, rows)
        if style.titled:
            figure.suptitle(study.title, x=0.01, ha="left", fontsize=9, fontweight="bold")
    return figure


def table(study: Study, rows: list[Row]) -> Table:
    """Return a row per cell: the cell, how it ended, what it cost."""
    shown = study.columns | _COMMON
    cells = ({**row, **row["cell"], "reference": (row.get("reference") or {}).get("status")} for row in rows)
    values = tuple(tuple(cell.get(key) for key in shown) for cell in cells)
    return Table(study.title, tuple(shown.values()), values, study.name, text=text(study, rows))


def text(study: Study, rows: list[Row]) -> str:
    """Return what a study says, in Markdown: how its cells ended, which did not converge, and which did and
    are off by more than 5 %, with the mechanism."""
    ended = Counter(row["status"] for row in rows)
    counted = ", ".join(f"{count} {status}" for status, count in ended.most_common())
    parts = [f"{study.says}\n", f"{len(rows)} cells: {counted}.\n"]
    ended_early = [row for row in rows if row["status"] not in ("converged", "strain-outside-model")]
    if ended_early:
        parts.append("Not converged:\n")
        parts += [f"- {in_words(row['cell'])}: {row['status']}, {row['message']}" for row in ended_early]
        parts.append("")
    off = [row for row in rows if doubtful(row)]
    if off:
        parts.append("Converged, and off by more than 5 %:\n")
        parts += [f"- {in_words(row['cell'])}: {percent(row['error'])} %, {_reason(row)}" for row in off]
        parts.append("")
    elif any(row["error"] is not None for row in rows):
        parts.append("No converged cell is off by more than 5 %.\n")
    return "\n".join(parts)


def _reason(row: Row) -> str:
    sentence = f"{row.get('mechanism', 'unknown')}: {row.get('evidence', 'no test showed one')}"
    return f"{sentence}; it says: {row['message']}" if row["message"] else sentence
