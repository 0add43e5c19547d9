"""What people read: tables and notes on standard output, progress and warnings on standard error."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich import box
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

if TYPE_CHECKING:
    from comparisons.report.table import Table
    from comparisons.runs.campaign import Progress

out = Console(highlight=False)
err = Console(stderr=True, highlight=False)


@contextmanager
def progress() -> Iterator[Callable[[str], None]]:
    """A function that says on standard error what is being done: a spinner on a terminal, else lines."""
    if not err.is_terminal:
        yield lambda text: err.print(text, markup=False)
        return
    with err.status("") as spinner:
        yield lambda text: spinner.update(Text(text))


@contextmanager
def campaign_progress() -> Iterator[Callable[[Progress], None]]:
    """A function that shows how far a campaign is: a bar with the time left on a terminal, else lines."""
    if not err.is_terminal:
        yield lambda progress: err.print(_progress_line(progress), markup=False, soft_wrap=True)
        return
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import Progress as Bar

    columns = (MofNCompleteColumn(), BarColumn(), TextColumn("{task.description}", markup=False))
    with Bar(*columns, console=err, transient=True) as bar:
        task = bar.add_task("starting …", total=None)

        def show(progress: Progress) -> None:
            left = "" if progress.seconds_left is None else f"{_duration(progress.seconds_left)} left"
            bar.update(
                task, completed=progress.done, total=progress.total, description=f"{left}  {progress.label}"
            )

        yield show


def _progress_line(progress: Progress) -> str:
    left = "" if progress.seconds_left is None else f", {_duration(progress.seconds_left)} left"
    return f"{progress.done}/{progress.total} {progress.label}: {progress.status}{left}"


def _duration(seconds: float) -> str:
    """A duration as people say it."""
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def heading(name: str, title: str) -> None:
    """What the output is about."""
    out.print(Text.assemble((name, "bold"), f"  {title}" if title else ""))


def show(table: Table, group_by: int | None = None, leave_out: tuple[str, ...] = ()) -> None:
    """Print a table without the columns named in `leave_out`.

    Where `group_by` is a column, a repeated value is printed once and the groups are ruled off.
    """
    printed = RichTable(
        title=table.caption,
        title_justify="left",
        title_style="bold",
        box=box.SIMPLE_HEAD,
        show_edge=False,
        padding=(0, 1, 0, 0),
    )
    kept = [i for i, column in enumerate(table.columns) if column.name not in leave_out]
    any_unit = any(table.columns[i].shown_unit for i in kept)
    for column in (table.columns[i] for i in kept):
        lines = (column.name, f"[{column.shown_unit}]") if column.shown_unit else ("", column.name)
        header = Text("\n".join(lines) if any_unit else column.name)
        printed.add_column(
            header, justify="right" if column.numeric else "left", no_wrap=not column.prose, overflow="fold"
        )
    previous = None
    for row in table.shown_rows():
        key = row[group_by] if group_by is not None else None
        if group_by is not None and key == previous:
            row[group_by] = ""
        elif previous is not None:
            printed.add_section()
        previous = key
        printed.add_row(*(Text(row[i]) for i in kept))
    out.print()
    out.print(printed)
    out.print()


def note(text: str) -> None:
    """A remark under the tables."""
    out.print(Text(text, style="dim"))


def warn(text: str) -> None:
    """A warning in one line, on standard error."""
    err.print(Text(text, style="yellow"), soft_wrap=True)
