"""Warnings about a scene: on standard error in a line, each once, and kept for the JSON document."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TextIO

shown: list[str] = []  # of the command that runs


@contextmanager
def in_a_line() -> Iterator[None]:
    """Show the packages' own warnings as a line each; others as Python does."""
    shown.clear()
    usual = warnings.showwarning

    def show(
        message: Warning | str,
        category: type[Warning],
        filename: str,
        lineno: int,
        file: TextIO | None = None,
        line: str | None = None,
    ) -> None:
        if category.__module__.split(".")[0] != "sheetbench":
            usual(message, category, filename, lineno, file, line)
        elif str(message) not in shown:
            from comparisons.cli import console  # with rich: help must not wait for it

            shown.append(str(message))
            console.warn(str(message))

    with warnings.catch_warnings():
        warnings.showwarning = show
        yield
