"""The references against published values: the table and the JSON document of `sheetbench verify`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from itertools import groupby
from typing import Any

from comparisons.report.table import Column, Table
from fem_reference.verification import CASES, Row

COLUMNS = (
    Column("case"),
    Column("quantity", prose=True),
    Column("mesh"),
    Column("expected", form=".5g"),
    Column("whose", prose=True),
    Column("computed", form=".5g"),
    Column("off by", "", "%", 100.0, ".2f"),
    Column("held to"),
    Column("ok"),
)


def table(rows: Sequence[Row]) -> Table:
    """A row per expected value. A tolerance is in per cent where it is relative, else as it is."""
    shown = tuple(
        (
            row.case,
            row.quantity,
            row.mesh,
            row.published,
            row.source,
            row.computed,
            row.relative,
            f"± {row.tolerance:g}" if row.relative is None else f"{100.0 * row.tolerance:g} %",
            "yes" if row.passed else "NO",
        )
        for row in rows
    )
    return Table("References against what is expected of them", COLUMNS, shown)


def by_case(rows: Sequence[Row]) -> Iterator[Table]:
    """A table for every case and mesh, with what it is."""
    for (case, mesh), some in groupby(rows, key=lambda row: (row.case, row.mesh)):
        title = f"{case}: {CASES[case].title}; {mesh}"
        yield replace(table(list(some)), caption=title)


def as_dict(rows: Sequence[Row]) -> dict[str, Any]:
    """{"rows": [{case, quantity, mesh, published, source, computed, relative, tolerance, passed, at}]}."""
    return {"rows": [asdict(row) for row in rows]}
