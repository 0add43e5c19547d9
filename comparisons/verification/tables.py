"""The references against published values: the table and the JSON document of `sheetbench verify`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, replace
from itertools import groupby
from typing import Any

from fem_reference.verification import CASES, Row, strain_laws
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table, number
from sheetbench.choices import STRAIN_LAWS

COLUMNS = (
    Column("case"),
    Column("quantity", prose=True),
    Column("mesh"),
    Column("computed", form=".5g"),
    Column("ok"),
    Column("expected", form=".5g"),
    Column("off by", "", "%", 100.0, ".2f"),
    Column("held to"),
    Column("whose", prose=True),
)


def report(rows: Sequence[Row], locking: bool = False, laws: bool = False) -> Report:
    """What `sheetbench verify` shows of rows; locking: that they are the locking sweeps', with a picture;
    laws: those of the laws of strain, with a table of them."""
    more = (law_table(),) if laws else ()
    failed = [row for row in rows if not row.passed]
    return Report(
        name="verification",
        title="verify",
        subtitle="the references against what is expected of them",
        document=as_dict(rows),
        tables=(table(rows), *more),
        printed=(*by_case(rows), *more),
        notes=(f"{len(rows) - len(failed)} of {len(rows)} rows pass",),
        complaints=tuple(
            f"{row.case}: {row.quantity}: {number(row.computed)} instead of {number(row.published)}"
            for row in failed
        ),
        pictures=(Picture("locking", "comparisons.verification.locking:compose", (rows,), formats=("png",)),)
        if locking
        else (),
        met=not failed,
    )


def table(rows: Sequence[Row]) -> Table:
    """A row per expected value. A tolerance is in per cent where it is relative, else as it is."""
    shown = tuple(
        (
            row.case,
            row.quantity,
            row.mesh,
            row.computed,
            "yes" if row.passed else "NO",
            row.published,
            row.relative,
            f"± {number(row.tolerance)}" if row.relative is None else f"{number(100.0 * row.tolerance)} %",
            row.source,
        )
        for row in rows
    )
    return Table("References against what is expected of them", COLUMNS, shown, "verification")


def by_case(rows: Sequence[Row]) -> Iterator[Table]:
    """A table for every case and mesh, with what it is."""
    for (case, mesh), some in groupby(rows, key=lambda row: (row.case, row.mesh)):
        title = f"{case}: {CASES[case].title}; {mesh}"
        columns = tuple(replace(column, detail=column.name in ("case", "mesh")) for column in COLUMNS)
        yield replace(table(list(some)), caption=title, columns=columns)


def law_table() -> Table:
    """Force of every law over that of Hooke's, pulled one way and both ways."""
    poisson = strain_laws.MATERIAL.poisson
    hooke = {"one way": 1.0, "both ways": 1.0 / (1.0 - poisson)}
    rows = tuple(
        (way, strain, *(strain_laws.stress(law, way, strain) / (strain * hooke[way]) for law in STRAIN_LAWS))
        for way in strain_laws.WAYS
        for strain in (0.001, 0.003, 0.01, 0.03, 0.1)
    )
    of_laws = (Column(law, "", "", 1.0, ".4f") for law in STRAIN_LAWS)
    columns = (Column("pulled"), Column("stretch", "", "%", 100.0, "g"), *of_laws)
    caption = f"Force at a stretch over that of Hooke's law, ν = {poisson:g}"
    return Table(caption, columns, rows, "laws", grouped=True)


def as_dict(rows: Sequence[Row]) -> dict[str, Any]:
    """{"rows": [{case, quantity, mesh, published, source, computed, relative, tolerance, passed, at}]}."""
    return {"rows": [asdict(row) for row in rows]}
