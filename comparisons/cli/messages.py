"""Warnings and log messages of the packages as lines on standard error."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

shown: list[str] = []  # warnings of the running command, without repetitions, for its JSON document


class _Lines(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        """Print the message, also while a spinner runs."""
        from comparisons.cli import console  # imports rich, slow for help

        console.print_status(record.getMessage())


@contextmanager
def in_lines() -> Iterator[None]:
    """Show log messages and warnings of the packages as lines within a block."""
    shown.clear()
    default = warnings.showwarning

    def show(message: Warning | str, category: type[Warning], *place: Any, **keywords: Any) -> None:
        if category.__module__.split(".")[0] != "sheetbench":
            default(message, category, *place, **keywords)
        elif str(message) not in shown:
            from comparisons.cli import console  # imports rich, slow for help

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
