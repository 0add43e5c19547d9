"""Campaigns with counters and limits for tests."""

import os
import signal
import sqlite3
import time
from collections.abc import Callable
from concurrent.futures import Executor, Future
from pathlib import Path
from typing import Any

from comparisons.stability import extremes
from comparisons.sweep.campaign import Run


def task(name: str, **arguments: object) -> Run:
    return Run(f"campaign_tasks:{name}", arguments, name)


FEW: dict[str, Any] = {  # of comparisons.stability.extremes: two runs along each axis, motions short
    "FACTORS": {name: (1.0, max(all_)) for name, all_ in extremes.FACTORS.items()},
    "CELLS": {"lumped": (2, 4), "references": (2,)},
    "DAMPING": (0.1,),
    "DIVISIONS": (20, 4),
    "FINE_STEPS": 50,
    "PERIODS": 0.5,
}


class Serial(Executor):
    """A pool that is this process: what is submitted is carried out at once."""

    def __init__(self, workers: int = 1) -> None:
        pass

    def submit(self, task: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        future: Future[Any] = Future()
        future.set_result(task(*arguments, **named))
        return future


def wait_for(condition: Callable[[], bool], seconds: float = 600.0) -> None:
    """Wait for what is certain to happen; the limit is only there to end a test that hangs."""
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "it did not happen in time"
        time.sleep(0.02)


def rows_in(path: Path) -> dict[str, tuple]:
    """Return the present rows of a campaign's file."""
    if not path.exists():
        return {}
    with sqlite3.connect(path, timeout=10) as database:
        try:
            return {row[0]: row for row in database.execute("select * from runs")}
        except sqlite3.OperationalError:
            return {}  # the table is not there yet
        finally:
            database.commit()


def alive(process: int) -> bool:
    """Return whether a process runs; a zombie does not."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    stat = Path(f"/proc/{process}/stat")
    return not (stat.exists() and stat.read_text(encoding="utf-8").rpartition(")")[2].split()[0] == "Z")


def interrupt_when(condition: Callable[[], bool]) -> None:
    """Send Ctrl-C to the main thread as soon as the condition holds."""
    wait_for(condition)
    os.kill(os.getpid(), signal.SIGINT)
