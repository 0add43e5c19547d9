"""A clock that stands still while kernels are compiled or loaded.

A machine compiles them once and a process loads them once: neither is time to set up or to solve.
Compiling happens on the thread that calls, so each thread has a clock of its own.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

_total = [0.0]  # s, compiled in this process


class _Stopped(threading.local):
    """Seconds for which the clock stood still, how deep kernels that call kernels are nested, since when."""

    seconds, depth, since = 0.0, 0, 0.0


_stopped = _Stopped()


def now() -> float:
    """Return the time [s] from some moment on, without what went to compiling."""
    running = _stopped.since if _stopped.depth else perf_counter()
    return running - _stopped.seconds


def compiled() -> float:
    """Return the seconds that this process has spent on compiling and loading kernels."""
    return _total[0]


def stop() -> None:
    """Stand still; may be nested."""
    if _stopped.depth == 0:
        _stopped.since = perf_counter()
    _stopped.depth += 1


def start() -> None:
    """Go on, after as many calls as `stop` had."""
    _stopped.depth -= 1
    if _stopped.depth == 0:
        spent = perf_counter() - _stopped.since
        _stopped.seconds += spent
        _total[0] += spent


@contextmanager
def stopped() -> Iterator[None]:
    """Stand still within the block."""
    stop()
    try:
        yield
    finally:
        start()
