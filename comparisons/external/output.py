"""Output of another program that runs in a folder of its own, or the reason for its failure."""

from collections.abc import Collection, Sequence
from pathlib import Path

from sheetbench.errors import foreign
from sheetbench.process import ONE_THREAD, run


class Failed(Exception):
    """The program has no answer; the message is the reason as a clause."""


def output_of(command: Sequence[str], folder: Path, limit: float, fine: Collection[int] = (0,)) -> str:
    """Run a program in a folder on one thread and return its output.

    Raises Failed if it takes longer than `limit` [s], cannot be started, or ends with an exit status that
    is not in `fine`; the message quotes the last output line that contains "error".
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
