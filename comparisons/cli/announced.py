"""Log messages of the packages (that kernels are compiled first) as lines on standard error."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager


class _Lines(logging.Handler):
    """Writes a record as a line."""

    def emit(self, record: logging.LogRecord) -> None:
        """Write the message, beside a spinner too."""
        from comparisons.cli import console  # with rich: help must not wait for it

        console.tell(record.getMessage())


@contextmanager
def in_a_line() -> Iterator[None]:
    """Show log messages of the packages as lines."""
    logger, lines = logging.getLogger("sheetbench"), _Lines()
    level = logger.level
    logger.setLevel(logging.INFO)
    logger.addHandler(lines)
    try:
        yield
    finally:
        logger.removeHandler(lines)
        logger.setLevel(level)
