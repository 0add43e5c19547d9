"""What another code prints, run in a folder of its own; why it has no answer in a clause."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path

from sheetbench.errors import foreign
from sheetbench.process import ONE_THREAD, run


class Failed(Exception):
    """The program has no answer; the message says in a clause what happened."""


def output_of(command: Sequence[str], folder: Path, limit: float, fine: Collection[int] = (0,)) -> str:
    """Return what a program prints, run in a folder on one thread.

    Raises Failed where it takes longer than `limit` [s], cannot be started, or ends with an exit status that
    is not `fine`, with the last line that speaks of an error.
    """
    try:
        ended = run(command, b"", limit, folder=folder, variables=ONE_THREAD)
    except OSError as error:
        raise Failed(f"cannot be started: {error.strerror}") from None
    output = f"{ended.answer.decode('utf-8', errors='replace')}\n{ended.complaint}"
    if not ended.stopped and ended.code in fine:
        return output
    lines = [line for line in output.splitlines() if "error" in line.lower()]
    raise Failed(f"{ended.reason}: {foreign(lines[-1])}" if lines else ended.reason)
