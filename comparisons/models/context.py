"""Settings of everything that runs inside a call: progress, and whether large models are let through.

`with running(large=True, progress=print):` holds for all that is solved in the block, in this thread. Verbs
have `large` and `progress` (`comparisons.cli.verb`), and nothing below them passes them on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import Any

from comparisons.pictures.work import Progress, silent
from sheetbench.answers.solution import Solution


@dataclass(frozen=True)
class Context:
    """large: solve even what takes more memory than there is; progress: called with what is being done, and
    with every iteration; solved: called with every answer of a comparison as soon as it is there."""

    large: bool = False
    progress: Progress = silent
    solved: Callable[[Solution], None] = silent


_CONTEXT = ContextVar("context", default=Context())  # noqa: B039  # frozen


def context() -> Context:
    """Return the settings that hold here."""
    return _CONTEXT.get()


@contextmanager
def running(**wanted: Any) -> Iterator[None]:
    """Hold other values of a `Context` within a block."""
    before = _CONTEXT.set(replace(_CONTEXT.get(), **wanted))
    try:
        yield
    finally:
        _CONTEXT.reset(before)
