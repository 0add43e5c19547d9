"""Display of answers in a notebook: tables and the picture in HTML, the picture alone as PNG.

A notebook shows the richest form alone, so the HTML contains the picture; both are of one drawing.
"""

from __future__ import annotations

from base64 import b64encode
from io import BytesIO
from typing import TYPE_CHECKING, Any

from sheetbench.answers.escape import html

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from sheetbench.answers.report import Picture, Report
    from sheetbench.answers.table import Table

DPI, ROWS = 110, 40  # of a picture; of a table
ALIGNED = {True: ' style="text-align: right"', False: ' style="text-align: left"'}


def png(figure: Figure) -> bytes:
    """Return a figure as PNG."""
    from matplotlib import rc_context

    from sheetbench.answers.style import STYLE

    written = BytesIO()
    with rc_context(STYLE):
        figure.savefig(written, format="png", dpi=DPI, facecolor="white")
    return written.getvalue()


def first_png(pictures: tuple[Picture, ...]) -> bytes | None:
    """Return the first figure of the pictures as PNG, or None if there is none or it cannot be drawn."""
    return next((picture._repr_png_() for picture in pictures if not picture.moves), None)


def table_html(table: Table, details: bool = True, most: int | None = None) -> str:
    """Return a table; details: with the columns that a terminal leaves out; most: number of rows shown."""
    numbers = [i for i, column in enumerate(table.columns) if details or not column.detail]
    aligned = [ALIGNED[table.columns[i].numeric] for i in numbers]
    shown = [[row[i] for i in numbers] for row in table.shown_rows()]
    rows = [[table.columns[i].header(shown=True) for i in numbers], *shown[:most]]
    lines = [
        "<tr>" + "".join(f"<{tag}{at}>{html(text)}</{tag}>" for at, text in zip(aligned, row, strict=True))
        for tag, row in zip(["th", *["td"] * len(rows)], rows, strict=False)
    ]
    more = len(shown) - len(rows) + 1
    rest = f"<p>… and {more} more rows</p>" if more else ""
    return f"<p><b>{html(table.caption)}</b></p><table>{''.join(lines)}</table>{rest}"


def report_html(report: Report, picture: bytes | None) -> str:
    """Return title, tables, first notes, complaints and the picture."""
    parts = [f"<h4>{html(report.title)}</h4>"] if report.title else []
    parts += [f"<p>{html(line)}</p>" for line in (report.subtitle, report.lead) if line]
    parts += [table_html(table, False, ROWS) for table in report.shown]
    notes = (*report.notes[: report.notes_shown], *report.complaints)
    parts += [f"<p>{html(line)}</p>" for line in notes]
    if picture is not None:
        parts.append(f'<img src="data:image/png;base64,{b64encode(picture).decode("ascii")}">')
    return "\n".join(parts)


def bundle(report: Report) -> dict[str, Any]:
    """Return a report by the kinds of content that a notebook takes."""
    picture = first_png(report.pictures)
    content: dict[str, Any] = {"text/html": report_html(report, picture)}
    return content if picture is None else {**content, "image/png": picture}
