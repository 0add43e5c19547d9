"""Running somebody else's program: in a folder of its own, within a time limit, its failure in one line."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from comparisons.models import running

ONE_THREAD = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "MKL_NUM_THREADS": "1"}


class Failed(Exception):
    """The program has no answer; the message says in a clause what happened."""


def run(command: Sequence[str], folder: Path, limit: float, fine: Collection[int] = (0,)) -> str:
    """What the program printed, on one thread. Raises Failed where it takes longer than `limit` [s], cannot
    be started, or ends with an exit status that is not `fine`, with the last line that speaks of an error."""
    try:
        ended = running.run(command, b"", limit, folder=folder, variables=ONE_THREAD)
    except OSError as error:
        raise Failed(f"cannot be started: {error.strerror}") from None
    said = f"{ended.answer.decode('utf-8', errors='replace')}\n{ended.complaint}"
    if ended.stopped:
        raise Failed(f"stopped: {ended.stopped}{_error_in(said)}")
    if ended.code < 0:
        raise Failed(f"ended by signal {-ended.code}{_error_in(said)}")
    if ended.code not in fine:
        raise Failed(f"left with exit status {ended.code}{_error_in(said)}")
    return said


def _error_in(said: str) -> str:
    """The last line that speaks of an error, if any, after a colon."""
    lines = [" ".join(line.split()) for line in said.splitlines() if "error" in line.lower()]
    return f": {lines[-1][:200]}" if lines else ""
