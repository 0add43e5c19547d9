"""A clock that stops while kernels are compiled or loaded.

A machine compiles kernels once and a process loads them once: neither belongs to the time of a set-up or of a
solve. The calling thread compiles, so that each thread has a clock of its own.
"""

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from time import perf_counter

_total = [0.0]  # s, compiled in this process


class _Pauses(threading.local):
    """Total time of the clock's pauses [s], depth of nested ones, start of the present one [s]."""

    seconds, depth, since = 0.0, 0, 0.0


_pauses = _Pauses()


def now() -> float:
    """Return the time [s] since an arbitrary origin, without pauses for compiling."""
    running = _pauses.since if _pauses.depth else perf_counter()
    return running - _pauses.seconds


def compiled() -> float:
    """Return the seconds that this process has spent on compiling and loading kernels."""
    return _total[0]


def stop() -> None:
    """Stop the clock; calls may be nested."""
    if _pauses.depth == 0:
        _pauses.since = perf_counter()
    _pauses.depth += 1


def start() -> None:
    """Start the clock again after a call for each call of `stop`."""
    _pauses.depth -= 1
    if _pauses.depth == 0:
        spent = perf_counter() - _pauses.since
        _pauses.seconds += spent
        _total[0] += spent


@contextmanager
def stopped() -> Iterator[None]:
    """Stop the clock within the block."""
    stop()
    try:
        yield
    finally:
        start()
