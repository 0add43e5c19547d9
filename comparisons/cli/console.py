"""Tables and notes on standard output, progress and warnings on standard error."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from time import monotonic
from typing import TYPE_CHECKING, Any

from rich.console import Console
from rich.text import Text

from sheetbench.answers.escape import terminal

if TYPE_CHECKING:
    from sheetbench.answers.table import Table

out = Console(highlight=False)
err = Console(stderr=True, highlight=False)
_quiet = False
verbose = False  # all notes
QUIET, BETWEEN = 2.0, 10.0  # s before the first line of progress without a terminal, and between lines
REFRESHED = 0.3  # s between changes of the line of progress in a notebook


@contextmanager
def verbosity(quiet: bool = False, all_notes: bool = False) -> Iterator[None]:
    """Suppress progress and notes on standard error, or show all notes of an answer, for a block."""
    global _quiet, verbose
    _quiet, verbose = quiet, all_notes
    try:
        yield
    finally:
        _quiet = verbose = False


@contextmanager
def progress() -> Iterator[Callable[[object], None]]:
    """Yield a function that shows progress: a `Work`, a campaign's progress or a text.

    It is shown by a spinner on a terminal, by one changing line in a notebook, and otherwise by occasional
    lines; progress with `at_once` is printed immediately.
    """
    if _quiet:
        yield lambda what: None
        return
    if err.is_jupyter:
        with _in_notebook() as show_in_notebook:
            yield show_in_notebook
        return
    if not err.is_terminal:
        due = monotonic() + QUIET

        def print_line(work: object) -> None:
            nonlocal due
            if getattr(work, "at_once", False) or monotonic() >= due:
                print_status(str(work))
                due = monotonic() + BETWEEN

        yield print_line
        return
    with err.status("", spinner="line") as spinner:
        yield lambda what: spinner.update(Text(terminal(str(what))))


@contextmanager
def _in_notebook() -> Iterator[Callable[[object], None]]:
    """Yield a function that shows a text in one line of a notebook's cell, cleared at the end."""
    from IPython.display import display

    handle, due = None, monotonic() + REFRESHED

    def change(work: object) -> None:
        nonlocal handle, due
        if monotonic() >= due:
            text, due = Text(terminal(str(work)), style="dim"), monotonic() + REFRESHED
            if handle is None:
                handle = display(text, display_id=True)
            else:
                handle.update(text)

    try:
        yield change
    finally:
        if handle is not None:
            handle.update({"text/plain": "", "text/html": ""}, raw=True)


def print_status(text: str) -> None:
    """Print a line on standard error, unless quiet."""
    if not _quiet:
        err.print(Text(terminal(text)), soft_wrap=True)


def document(content: Mapping[str, Any]) -> None:
    """Print one JSON document; characters that the encoding lacks are escaped."""
    from sheetbench.answers.files import to_json

    print(to_json(content, escaped=not out.encoding.startswith("utf")), end="")


def heading(title: str, subtitle: str = "") -> None:
    """Print the title, bold, and the subtitle."""
    shown, bold = terminal(title), len(terminal(title))
    for i, line in enumerate(_fitted(f"{shown}  {terminal(subtitle)}" if subtitle else shown)):
        text = Text(line)
        text.stylize("bold", 0, bold if i == 0 else 0)
        out.print(text, soft_wrap=True)


def show(table: Table) -> None:
    """Print an empty line and a table, folded to a terminal's width, unfolded without a terminal."""
    from sheetbench.answers.layout import blocks

    blank()
    for line in _fitted(terminal(table.caption)):
        out.print(Text(line, style="bold"), soft_wrap=True)
    for i, block in enumerate(blocks(table, out.width if out.is_terminal else None)):
        if i > 0:
            blank()
        for line in block.head:
            out.print(Text(line, style="bold"), soft_wrap=True)
        for line in [terminal(block.rule), *block.rows]:
            out.print(Text(line), soft_wrap=True)


def is_interactive() -> bool:
    """Return whether input and output are a terminal, for questions to the user."""
    return out.is_terminal and sys.stdin is not None and sys.stdin.isatty()


def blank() -> None:
    """Print an empty line."""
    out.print()


def note(text: str) -> None:
    """Print a note under the tables, broken between words, further lines indented; a command to copy stays on
    one line."""
    for line in terminal(text, keep="\n").split("\n"):
        for part in [line] if line.startswith("sheetbench ") else _fitted(line, indent="  "):
            out.print(Text(part, style="dim"), soft_wrap=True)


def _fitted(line: str, console: Console = out, indent: str = "") -> list[str]:
    """Wrap a line between words, with an indent on further lines; long paths are not broken."""
    from textwrap import TextWrapper

    wrapper = TextWrapper(
        console.width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False
    )
    return wrapper.wrap(line) or [""]


def warn(text: str) -> None:
    """Print a warning on standard error: one line, on a terminal broken between words."""
    shown = terminal(text)
    for line in _fitted(shown, err) if err.is_terminal else [shown]:
        err.print(Text(line, style="yellow"), soft_wrap=True)
