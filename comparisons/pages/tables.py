"""Tables of a study for a page: values with all their digits to sort by, shown as everywhere else.

The manifest has the columns with their units and formats, the CSV file the values in SI units. Other CSV
files, as of samples over time, are listed among the files.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from functools import partial
from pathlib import Path
from typing import Any

from comparisons.pages.studies import Study
from sheetbench.answers.table import Column, Table, TableUnit, unit

MOST, LONG = 500, 15  # rows of a table on a page, and from which on it is folded


@dataclass(frozen=True, repr=False)
class PageTable(Table):
    """A table for a page. note: what is left out; aside: shown when requested only."""

    note: str = ""
    aside: bool = False

    @property
    def cells(self) -> list[list[tuple[Column, str, Any]]]:
        """Column, text and value of every cell, by rows."""
        both = zip(self.shown_rows(), self.rows, strict=True)
        return [list(zip(self.columns, texts, values, strict=True)) for texts, values in both]


def tables(study: Study) -> list[PageTable]:
    """Return every table that a study's manifest tells of."""
    found = []
    for words in study.words.get("tables", ()):
        name, rows = f"{words.get('name')}.csv", words.get("rows")
        if rows is None and name in study.files:
            rows = (study.read(name, _rows) or [])[1:] or None
        made = study.attempt(name, partial(_described, words, rows)) if rows is not None else None
        if made:
            found.append(made)
    return found


def _rows(path: Path) -> list[list[str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return [[_plain(cell) for cell in row] for row in csv.reader(file, strict=True) if row]


def _plain(cell: str) -> str:
    """Return the cell without the apostrophe that keeps a spreadsheet from taking it for a formula."""
    return cell[1:] if cell[:1] == "'" and cell[1:2] in ("=", "+", "-", "@", "\t", "\r") else cell


def _value(text: Any) -> float | None:
    try:
        return float(text)
    except (TypeError, ValueError):
        return None


def _described(words: Mapping[str, Any], rows: Sequence[Sequence[Any]]) -> PageTable:
    known = {one.name for one in fields(Column)}
    columns = [Column(**{k: v for k, v in column.items() if k in known}) for column in words["columns"]]
    units = [bool(column.get("units")) for column in words["columns"]]
    values = [
        tuple(_cell(c, u, v) for c, u, v in zip(columns, units, row, strict=True)) for row in rows[:MOST]
    ]
    caption, text = words.get("caption", ""), words.get("text", "")
    return PageTable(
        caption, tuple(columns), tuple(values), text=text, note=_left_out(rows), aside=len(rows) > LONG
    )


def _cell(column: Column, of_units: bool, value: Any) -> Any:
    """Return a value as the table had it: a number, a row's unit, text, or nothing."""
    if value in ("", None):
        return None
    if of_units:
        return TableUnit(*value) if isinstance(value, list) else unit(str(value))
    if not column.numeric:
        return str(value)
    found = _value(value)
    return int(found) if found is not None and column.form.endswith("d") and found == found else found


def _left_out(rows: Sequence[Any]) -> str:
    return f"The first {MOST} of {len(rows)} rows; the file has all." if len(rows) > MOST else ""
