"""Settings of everything that runs inside a call: progress, and whether large models are let through.

`with running(large=True, progress=print):` holds for all that is solved in the block, in this thread. Public
functions take `large` and `progress` as keywords by `in_context`; nothing below them passes them on.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, replace
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from comparisons.pictures.work import Progress, silent
from sheetbench.answers.solution import Solution

Parameters = ParamSpec("Parameters")
Result = TypeVar("Result")


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


def in_context(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Return the function; its keywords `large` and `progress`, where given, hold for all that it does."""
    return _held(function, "large", "progress")


def large_in_context(function: Callable[Parameters, Result]) -> Callable[Parameters, Result]:
    """Like `in_context`, for `large` alone, where the progress is a campaign's."""
    return _held(function, "large")


def _held(function: Callable[Parameters, Result], *names: str) -> Callable[Parameters, Result]:
    @wraps(function)
    def run(*values: Parameters.args, **named: Parameters.kwargs) -> Result:
        with running(**{name: named[name] for name in names if name in named}):
            return function(*values, **named)

    return run
