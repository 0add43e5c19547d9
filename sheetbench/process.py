"""Run a program within limits of time, memory and output; its failure is one line.

The program leads a process group of its own, which is killed at the end. What has left that group lives on,
and may hold the ends of the pipes: so pipes are read until the program has ended, and not to their own end.
"""

from __future__ import annotations

import os
import selectors
import signal
import subprocess
import tempfile
from collections.abc import Collection, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from sheetbench.errors import foreign

ONE_THREAD = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "NUMBA_NUM_THREADS",
        "RAYON_NUM_THREADS",
    ),
    "1",
)
MOST = 2**24  # bytes of standard output
TAIL = 2000  # bytes of standard error that are kept
LATE = "late"
DRAIN = 1.0  # s for reading what is in the pipes at its end; others may go on to fill them
POLL = 0.05  # s between checks whether it has ended, where nothing is written
BLOCK = 2**16  # bytes read at once


@dataclass(frozen=True)
class Ended:
    """How a program ended: its exit status, negative for a signal, its output, why it was stopped."""

    code: int
    answer: bytes
    complaint: str
    stopped: str
    seconds: float

    @property
    def fault(self) -> str:
        """What went wrong in a phrase, with its last words; nothing where nothing did."""
        reason = self.stopped or (f"exit status {self.code}" if self.code else "")
        if self.code < 0 and not self.stopped:
            reason = f"ended by {signal.Signals(-self.code).name}"
        return f"{reason}: {self.complaint}" if reason and self.complaint else reason


class Failed(Exception):
    """The program has no answer; the message says in a clause what happened."""


def run(
    command: Sequence[str],
    question: bytes,
    seconds: float,
    memory_mb: int | None = None,
    *,
    most: int = MOST,
    folder: Path | None = None,
    variables: Mapping[str, str] | None = None,
) -> Ended:
    """Run a program on a question for standard input.

    seconds: after which it is stopped; memory_mb: of address space, None for no limit (the shell's ulimit);
    most: bytes of answer; folder: to run it in; variables: of its environment, beside ours.
    """
    if memory_mb is not None:
        command = ["sh", "-c", 'ulimit -v "$0" && exec "$@"', str(1024 * memory_mb), *command]
    with tempfile.TemporaryFile() as source:
        source.write(question)
        source.seek(0)
        started, pipe = perf_counter(), subprocess.PIPE
        with subprocess.Popen(
            command,
            stdin=source,
            stdout=pipe,
            stderr=pipe,
            start_new_session=True,
            cwd=folder,
            env={**os.environ, **(variables or {})},
        ) as process:
            try:
                answer, complaint, stopped = _hear(process, started + seconds, most)
                took = perf_counter() - started
            finally:
                _end(process.pid)
    if stopped == LATE:
        stopped = f"no answer within {seconds:g} s"
    lines = complaint.decode("utf-8", "replace").strip().splitlines()
    return Ended(process.returncode, answer, foreign(lines[-1]) if lines else "", stopped, took)


def _hear(process: subprocess.Popen[bytes], until: float, most: int) -> tuple[bytes, bytes, str]:
    """Standard output, the end of standard error, and why to stop the program; "" where it has ended."""
    assert process.stdout is not None and process.stderr is not None
    answer, complaint = bytearray(), bytearray()
    with selectors.DefaultSelector() as waiting:
        waiting.register(process.stdout, selectors.EVENT_READ, answer)
        waiting.register(process.stderr, selectors.EVENT_READ, complaint)
        stopped = ""
        while not stopped:
            # before reading: what it has written by its end is in the pipes
            ended = process.poll() is not None
            if ended:
                until = min(until, perf_counter() + DRAIN)
            left = max(0.0, until - perf_counter())
            ready = waiting.select(0.0 if ended else min(POLL, left))
            for key, _ in ready:
                if block := os.read(key.fd, BLOCK):
                    key.data.extend(block)
                else:
                    waiting.unregister(key.fileobj)
            del complaint[:-TAIL]
            if len(answer) > most:
                stopped = f"more than {most // 2**20} MB of answer"
            elif ended and not (ready and left):
                break
            elif not left:
                stopped = LATE
            elif not waiting.get_map():
                with suppress(subprocess.TimeoutExpired):
                    process.wait(left)
    return bytes(answer), bytes(complaint), stopped


def _end(group: int) -> None:
    """Kill a program and what it has started."""
    try:
        os.killpg(group, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):  # all gone; macOS says the latter of what is dying
        return


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
    reason = f"left with exit status {ended.code}"
    if ended.stopped:
        reason = f"stopped: {ended.stopped}"
    elif ended.code < 0:
        reason = f"ended by signal {-ended.code}"
    lines = [line for line in output.splitlines() if "error" in line.lower()]
    raise Failed(f"{reason}: {foreign(lines[-1])}" if lines else reason)
