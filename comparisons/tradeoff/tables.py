"""What a trade-off shows: its rows with their costs and errors, the orders of its families, its picture."""

from __future__ import annotations

from dataclasses import astuple
from typing import TYPE_CHECKING, Any

from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table
from sheetbench.scenes import Status
from sheetbench.scenes.summary import few

if TYPE_CHECKING:
    from comparisons.tradeoff.row import TradeoffRow
    from comparisons.tradeoff.statics import Tradeoff


def report(found: Tradeoff) -> Report:
    """What `sheetbench tradeoff` shows."""
    failed = [row for row in found.rows if row.status != Status.CONVERGED]
    complaints = [f"{row.label}: {row.status}: {row.message}" for row in failed]
    judged = found.uncertainty is not None
    if not judged:
        said = f"the reference, {found.reference.label}: {found.reference.status}"
        complaints.append(f"no errors: {said}")
    pictures = [Picture("tradeoff", "comparisons.tradeoff.figure:compose", (found,))]
    return Report(
        name="tradeoff",
        title=found.scene.name,
        subtitle=found.scene.title,
        document=found.as_dict(),
        tables=(rows(found), orders(found)),
        notes=(*found.reasons, explanation(found), *found.warnings),
        complaints=tuple(complaints),
        pictures=tuple(pictures if any(row.error for row in found.rows) else ()),
        settings={"reference": found.reference.settings},
        met=judged,
    )


def rows(tradeoff: Tradeoff) -> Table:
    """A row per model and setting; those on the front are marked."""
    front = set(tradeoff.front)
    found = tuple(_row(i, row, i in front) for i, row in enumerate(tradeoff.rows))
    columns = (
        Column("row", form="d"),
        Column("model", prose=True),
        Column("size"),
        Column("unknowns", form="d"),
        Column("factorisations", form="d", detail=True),
        Column("set-up", "s", "ms", 1e3, ".1f", detail=True),
        Column("solve", "s", "ms", 1e3, ".2f"),
        Column("from", "s", "ms", 1e3, ".2f", detail=True),
        Column("to", "s", "ms", 1e3, ".2f", detail=True),
        Column("memory", "B", "MB", 1e-6, ".1f"),
        Column("error", "", "%", 100.0, ".3g"),
        Column("own bar", "", "%", 100.0, ".2g", detail=True),
        Column("field error", "", "%", 100.0, ".3g"),
        Column("front"),
        Column("status", detail=True),
    )
    caption = "Cost and error; solve: median of the repeats, from the quickest to the slowest"
    return Table(caption, columns, found, "tradeoff")


def _row(number: int, row: TradeoffRow, on_front: bool) -> tuple[Any, ...]:
    return (
        number,
        row.series,
        row.size,
        row.unknowns,
        row.iterations,
        row.setup_seconds,
        row.seconds,
        min(row.solve_seconds, default=None),
        max(row.solve_seconds, default=None),
        row.peak_memory_bytes,
        row.error,
        row.bar,
        row.field_error,
        "yes" if on_front else "",
        row.status,
    )


def orders(tradeoff: Tradeoff) -> Table:
    """A row per family: observed orders of the errors in h and of the time in the unknowns."""
    found = tuple(astuple(orders) for orders in tradeoff.orders)
    columns = (
        Column("model", prose=True),
        Column("rows", form="d"),
        Column("error order", form="z.2f"),
        Column("field error order", form="z.2f"),
        Column("time order", form="z.2f"),
    )
    caption = "Observed orders: errors in the size of a cell, time in the unknowns"
    return Table(caption, columns, found, "orders")


def explanation(tradeoff: Tradeoff) -> str:
    """What the errors are measured against."""
    reference, uncertainty = tradeoff.reference, tradeoff.uncertainty
    known = "unknown" if uncertainty is None else f"{few(100 * uncertainty)} %"
    return (
        f"errors against {reference.label} ({reference.unknowns} unknowns), whose own uncertainty is "
        f"{known}: the grid convergence index of n, ¾ n and ½ n elements. error: at the probes; field error: "
        "root mean square over the sheet. One thread; times on warm code; memory: growth of the process."
    )
