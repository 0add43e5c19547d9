"""Settings of all solves within a call: the progress function, and whether models larger than the free memory
are allowed.

`with running(large=True, progress=print):` holds for every solve of the block in this thread. Verbs have the
options `large` and `progress` (`comparisons.cli.verb`); functions below do not pass them on.
"""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from typing import Any

from comparisons.pictures.work import Progress, silent
from sheetbench.answers.solution import Solution


@dataclass(frozen=True)
class Context:
    """The settings of solves. large: allow models that need more memory than is free; progress: called with
    the current work at its start and at every iteration; solved: called with every answer of a comparison as
    soon as it exists."""

    large: bool = False
    progress: Progress = silent
    solved: Callable[[Solution], None] = silent


_CONTEXT = ContextVar("context", default=Context())  # noqa: B039  # frozen


def context() -> Context:
    """Return the settings of the enclosing `running` block."""
    return _CONTEXT.get()


@contextmanager
def running(**settings: Any) -> Iterator[None]:
    """Set other values of a `Context` for a block."""
    token = _CONTEXT.set(replace(_CONTEXT.get(), **settings))
    try:
        yield
    finally:
        _CONTEXT.reset(token)
