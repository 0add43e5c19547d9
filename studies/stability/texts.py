"""A study's table and text: how its cells ended, and every converged one that is off by more than 5 %."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from comparisons.stability.rows import Row, doubtful, percent
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import Column, Table
from studies.stability.study import Study

_COMMON = (
    Column("status"),
    Column("error", "", "%", 100.0, ".3g"),
    Column("iterations", form="d"),
    Column("seconds", "s", "s", 1.0, ".2f"),
    Column("reference"),
    Column("message", prose=True, detail=True),
)


@dataclass(frozen=True, repr=False)
class StabilityMaps(Answer):
    """The rows of studies: what `sheetbench study stability` shows."""

    studies: Sequence[Study]
    rows: list[Row]

    file_name = "stability"

    def of(self, study: Study) -> list[Row]:
        """The rows of a study."""
        return [row for row in self.rows if row["study"] == study.name]

    @property
    def broken(self) -> list[Row]:
        """Rows without an answer."""
        return [row for row in self.rows if row["status"] in ("failed", "lost")]

    @property
    def succeeded(self) -> bool:
        return not self.broken

    def heading(self) -> tuple[str, str, str]:
        return "Where the solvers hold", "", ""

    def document(self) -> dict[str, Any]:
        return {"rows": self.rows}

    def tables(self) -> list[Table]:
        return [table(study, self.of(study)) for study in self.studies]

    def complaints(self) -> list[str]:
        return [f"{r['study']} {r['cell']}: {r['status']}: {r['message']}" for r in self.broken]

    def figures(self) -> list[Picture]:
        compose = "studies.stability.figure:compose"
        return [Picture(study.name, compose, (study, self.of(study))) for study in self.studies]

    def choices(self) -> dict[str, Any]:
        return {"studies": [study.name for study in self.studies]}


def table(study: Study, rows: list[Row]) -> Table:
    """A row per cell: the cell, how it ended, what it cost."""
    table_rows = []
    for row in rows:
        own = tuple({**row, **row["cell"]}.get(column.name.replace(" ", "_")) for column in study.columns)
        reference = (row.get("reference") or {}).get("status")
        shown = (row["status"], row["error"], row["iterations"], row["seconds"], reference, row["message"])
        table_rows.append(own + shown)
    return Table(study.title, study.columns + _COMMON, tuple(table_rows), study.name, text=text(study, rows))


def text(study: Study, rows: list[Row]) -> str:
    """What a study says, in Markdown: how its cells ended, which did not converge, and which did and are off
    by more than 5 %, with the mechanism."""
    ended = Counter(row["status"] for row in rows)
    counted = ", ".join(f"{count} {status}" for status, count in ended.most_common())
    parts = [f"{study.says}\n", f"{len(rows)} cells: {counted}.\n"]
    ended_early = [row for row in rows if row["status"] not in ("converged", "strain-outside-model")]
    if ended_early:
        parts.append("Not converged:\n")
        parts += [f"- {_named(row['cell'])}: {row['status']}, {row['message']}" for row in ended_early]
        parts.append("")
    off = [row for row in rows if doubtful(row)]
    if off:
        parts.append("Converged, and off by more than 5 %:\n")
        parts += [f"- {_named(row['cell'])}: {percent(row['error'])} %, {_reason(row)}" for row in off]
        parts.append("")
    elif any(row["error"] is not None for row in rows):
        parts.append("No converged cell is off by more than 5 %.\n")
    return "\n".join(parts)


def unexplained(rows: list[Row]) -> list[Row]:
    """Converged rows that are off by more than 5 % and have no mechanism."""
    return [row for row in rows if doubtful(row) and row.get("mechanism", "unknown") == "unknown"]


def _reason(row: Row) -> str:
    sentence = f"{row.get('mechanism', 'unknown')}: {row.get('evidence', 'no test told')}"
    return f"{sentence}; it says: {row['message']}" if row["message"] else sentence


def _named(cell: dict[str, Any]) -> str:
    return ", ".join(f"{k} {v:g}" if isinstance(v, float) else f"{k} {v}" for k, v in cell.items())
