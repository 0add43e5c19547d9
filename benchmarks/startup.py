"""Whole processes, from the shell to the prompt: what a command costs beside what it computes.

    python benchmarks/startup.py [--first] [--keep]

CPU seconds and seconds by the clock, the least of REPEATS with what is compiled in the cache, and what is
said on standard error about compiling, which should be nothing. Python keeps what it makes of its sources, as
by default, whatever the environment here says: else every process would read them all anew. --first: with an
empty cache too (a minute).
"""

import argparse
import os
import subprocess
import sys
import tempfile
from resource import RUSAGE_CHILDREN, getrusage
from time import perf_counter
from typing import Any

from keeping import keep

REPEATS = 3
COMMANDS = (
    ("--version",),
    ("check",),
    ("check", "two-edges-clamped"),
    ("compare", "two-edges-clamped"),
    ("compare", "two-edges-clamped", "--json"),
)


def process(arguments: tuple[str, ...], **environment: str) -> tuple[float, float, str]:
    """CPU seconds, seconds by the clock and what a command says on standard error."""
    before, began = getrusage(RUSAGE_CHILDREN), perf_counter()
    done = subprocess.run(
        [sys.executable, "-m", "sheetbench", *arguments],
        env={**os.environ, "PYTHONDONTWRITEBYTECODE": "", **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    clock, after = perf_counter() - began, getrusage(RUSAGE_CHILDREN)
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return cpu, clock, done.stderr


def main() -> None:
    """Measure, print, keep."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--first", action="store_true", help="with an empty cache too (a minute)")
    parser.add_argument("--keep", action="store_true", help="keep the rows in benchmarks/history")
    arguments = parser.parse_args()
    rows: list[dict[str, Any]] = []
    for command in COMMANDS:
        process(command)  # what is compiled is in the cache now
        found = [process(command) for _ in range(REPEATS)]
        cpu, clock = min(each[0] for each in found), min(each[1] for each in found)
        said = found[-1][2]
        rows.append({"command": " ".join(command), "cpu_seconds": cpu, "seconds": clock})
        compiled = ", compiles" if "compiling" in said else ""
        print(f"sheetbench {' '.join(command):34s} {cpu:6.2f} s CPU {clock:6.2f} s{compiled}", flush=True)
    if arguments.first:
        command = COMMANDS[-2]
        with tempfile.TemporaryDirectory() as empty:
            cpu, clock, _ = process(command, NUMBA_CACHE_DIR=empty)
        rows.append({"command": " ".join(command), "first": True, "cpu_seconds": cpu, "seconds": clock})
        print(f"sheetbench {' '.join(command):34s} {cpu:6.2f} s CPU {clock:6.2f} s, the first time")
    if arguments.keep:
        print(keep("startup", rows))


if __name__ == "__main__":
    main()
