"""Running a program within limits of time, memory and output; at the end nothing that it started is left."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
from dataclasses import dataclass
from threading import Thread, Timer
from time import perf_counter
from typing import IO

MOST = 2**24  # bytes of what it says on standard output
TAIL = 2000  # of what is kept of standard error


@dataclass(frozen=True)
class Ended:
    """How a program ended: its exit status, negative for a signal, what it said, why it was stopped."""

    code: int
    answer: bytes
    complaint: str
    stopped: str
    seconds: float

    @property
    def fault(self) -> str:
        """What went wrong in a phrase, with its last words; nothing where nothing did."""
        said = self.stopped or (f"exit status {self.code}" if self.code else "")
        if self.code < 0 and not self.stopped:
            said = f"ended by {signal.Signals(-self.code).name}"
        return f"{said}: {self.complaint}" if said and self.complaint else said


def run(command: list[str], question: bytes, seconds: float, memory_mb: int | None) -> Ended:
    """Run a program on a question for standard input.

    seconds: after which it is stopped; memory_mb: of address space, None for no limit (the shell's ulimit).
    """
    if memory_mb is not None:
        command = ["sh", "-c", 'ulimit -v "$0" && exec "$@"', str(1024 * memory_mb), *command]
    stopped: list[str] = []
    tail: list[str] = []
    with tempfile.TemporaryFile() as source:
        source.write(question)
        source.seek(0)
        started = perf_counter()
        pipe = subprocess.PIPE
        with subprocess.Popen(
            command, stdin=source, stdout=pipe, stderr=pipe, start_new_session=True
        ) as process:
            assert process.stdout is not None and process.stderr is not None

            def stop(why: str) -> None:
                stopped.append(why)
                _end(process.pid)

            listening = Thread(target=_listen, args=(process.stderr, tail), daemon=True)
            clock = Timer(seconds, stop, [f"no answer within {seconds:g} s"])
            listening.start()
            clock.start()
            try:
                answer = process.stdout.read(MOST + 1)
                if len(answer) > MOST:
                    stop(f"more than {MOST // 2**20} MB of answer")
                process.wait()
                took = perf_counter() - started
            finally:
                clock.cancel()
                _end(process.pid)
            listening.join()
    lines = "".join(tail).strip().splitlines()
    return Ended(process.returncode, answer, lines[-1] if lines else "", "".join(stopped[:1]), took)


def _end(group: int) -> None:
    """Kill a program and what it has started."""
    try:
        os.killpg(group, signal.SIGKILL)
    except (ProcessLookupError, PermissionError):  # all gone; macOS says the latter of what is dying
        return


def _listen(stream: IO[bytes], tail: list[str]) -> None:
    """Read a stream to its end, and keep the end."""
    kept = b""
    while block := stream.read1(4096):  # type: ignore[attr-defined]
        kept = (kept + block)[-TAIL:]
    tail.append(kept.decode("utf-8", "replace"))
