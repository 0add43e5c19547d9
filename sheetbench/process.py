"""Run a program within limits of time, memory and output; its failure is one line.

The program leads a process group of its own, which is killed at the end. It writes to files: the ends of
pipes could be held open by a surviving process that has left the group.
"""

import os
import subprocess
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from signal import SIGKILL, Signals
from tempfile import TemporaryFile
from time import perf_counter

from sheetbench.errors import foreign

ONE_THREAD = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMBA", "RAYON")}
MOST = 2**24  # bytes of standard output
ERROR_BYTES = 2000  # bytes of standard error that are read
POLL = 0.05  # s between checks of the time and of the output's size


@dataclass(frozen=True)
class ProcessResult:
    """End of a program: its exit status, negative for a signal, its output, the reason if it was stopped."""

    code: int
    answer: bytes
    complaint: str
    stopped: str
    seconds: float

    @property
    def reason(self) -> str:
        """Return the failure in a phrase, "" without one."""
        if self.stopped or not self.code:
            return self.stopped
        return f"ended by {Signals(-self.code).name}" if self.code < 0 else f"exit status {self.code}"

    @property
    def fault(self) -> str:
        """Return the failure with the program's last line, "" without one."""
        return f"{self.reason}: {self.complaint}" if self.reason and self.complaint else self.reason


def run(
    command: Sequence[str],
    question: bytes,
    seconds: float,
    memory_mb: int | None = None,
    *,
    most: int = MOST,
    folder: Path | None = None,
    variables: Mapping[str, str] | None = None,
) -> ProcessResult:
    """Run a program with a question on its standard input.

    seconds: limit of time. memory_mb: limit of address space by the shell's ulimit, None for none. most:
    limit of the answer's size [bytes]. folder: working directory. variables: added to the environment.
    """
    if memory_mb is not None:
        command = ["sh", "-c", 'ulimit -v "$0" && exec "$@"', str(1024 * memory_mb), *command]
    with TemporaryFile() as source, TemporaryFile() as answer, TemporaryFile() as complaint:
        source.write(question)
        source.seek(0)
        started = perf_counter()
        with subprocess.Popen(
            command,
            stdin=source,
            stdout=answer,
            stderr=complaint,
            start_new_session=True,
            cwd=folder,
            env={**os.environ, **(variables or {})},
        ) as process:
            try:
                stopped = ""
                while not stopped and process.returncode is None:
                    remaining = started + seconds - perf_counter()
                    with suppress(subprocess.TimeoutExpired):
                        process.wait(max(0.0, min(POLL, remaining)))
                    if max(os.fstat(file.fileno()).st_size for file in (answer, complaint)) > most:
                        stopped = f"more than {most // 2**20} MB of answer"
                    elif remaining <= 0.0 and process.returncode is None:
                        stopped = f"no answer within {seconds:g} s"
                took = perf_counter() - started
            finally:
                # the group is gone; macOS raises PermissionError for a dying process
                with suppress(ProcessLookupError, PermissionError):
                    os.killpg(process.pid, SIGKILL)
        answer.seek(0)
        complaint.seek(max(0, complaint.seek(0, os.SEEK_END) - ERROR_BYTES))
        lines = complaint.read().decode("utf-8", "replace").strip().splitlines()
        last_line = foreign(lines[-1]) if lines else ""
        return ProcessResult(process.returncode, answer.read(most), last_line, stopped, took)
