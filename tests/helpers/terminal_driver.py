"""Runs verbs one after another on the terminal it is started on, and writes what each printed to a file.

    python terminal_driver.py CASES.json SCREENS.json

A case is [name, arguments, columns, environment, encoding]; a screen is [name, exit status, standard output,
standard error]. In one process, so that starting up and compiling are paid once; campaigns run in it too. Its
clock ticks at every look, so that the same solve takes the same time whenever it is run; its machine is idle.
"""

import importlib
import io
import itertools
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

_ticks = itertools.count()
time.perf_counter = lambda: 1e-3 * next(_ticks)
os.getloadavg = lambda: (0.0, 0.0, 0.0)

from answers import once  # noqa: E402
from campaigns import FEW, Here  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from terminals import resize  # noqa: E402

from comparisons.cli import console, main  # noqa: E402
from comparisons.runs import campaign, executors, load  # noqa: E402
from comparisons.stability import extremes  # noqa: E402
from comparisons.sweep import here  # noqa: E402


class Echo(io.RawIOBase):
    """A stream of the terminal that keeps what it has shown."""

    def __init__(self, file: int) -> None:
        self.file, self.shown = file, b""

    def fileno(self) -> int:
        return self.file

    def isatty(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def write(self, data: Any) -> int:
        self.shown += bytes(data)
        return os.write(self.file, data)


def screen(
    name: str, arguments: list[str], columns: int, environment: dict[str, str], encoding: str
) -> list[object]:
    """Run a verb; its name, exit status and what it printed."""
    resize(1, columns)
    os.environ.pop("NO_COLOR", None)
    os.environ.update(environment)
    streams = [Echo(1), Echo(2)]
    sys.stdout, sys.stderr = (
        io.TextIOWrapper(io.BufferedWriter(stream), encoding=encoding, write_through=True)
        for stream in streams
    )
    importlib.reload(console)  # as a new process has it
    status: object = 0
    try:
        main(arguments)
    except SystemExit as leaving:
        status = leaving.code or 0
    sys.stdout.flush()
    sys.stderr.flush()
    return [name, status, *(stream.shown.decode(encoding) for stream in streams)]


if __name__ == "__main__":
    sys.stdin = io.StringIO()  # nobody is there to be asked
    here.solve = once(here.solve)  # what is looked at is how it is shown
    load.average = lambda: None  # a busy machine is noted with its load, which changes
    executors.processes = Here
    vars(extremes).update(FEW)
    campaign.carry_out.__kwdefaults__["pool"] = executors.processes
    Figure.savefig = lambda self, place, *_, **__: Path(place).touch()  # type: ignore[method-assign, assignment]
    asked = json.loads(Path(sys.argv[1]).read_text(encoding="utf-8"))
    Path(sys.argv[2]).write_text(json.dumps([screen(*case) for case in asked]), encoding="utf-8")
