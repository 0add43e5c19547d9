"""Warnings and log messages of the packages, a line each on standard error."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

shown: list[str] = []  # warnings of the command that runs, each once, for its JSON document


class _Lines(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        """Write the message, beside a spinner too."""
        from comparisons.cli import console  # with rich: help must not wait for it

        console.tell(record.getMessage())


@contextmanager
def in_lines() -> Iterator[None]:
    """Show log messages and warnings of the packages as lines within a block."""
    shown.clear()
    usual = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *where: Any, **more: Any) -> None:
        if category.__module__.split(".")[0] != "sheetbench":
            usual(message, category, *where, **more)
        elif str(message) not in shown:
            from comparisons.cli import console  # with rich: help must not wait for it

            shown.append(str(message))
            console.warn(str(message))

    logger, lines = logging.getLogger("sheetbench"), _Lines()
    level = logger.level
    logger.setLevel(logging.INFO)
    logger.addHandler(lines)
    try:
        with warnings.catch_warnings():
            warnings.showwarning = show
            yield
    finally:
        logger.removeHandler(lines)
        logger.setLevel(level)
