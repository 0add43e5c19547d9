"""Tasks of worker processes for the tests of campaigns."""

import os
import signal
import time
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.sweep.load import conditions
from sheetbench.scenes import BadInput


def square(x: float, seconds: float = 0.0) -> dict[str, Any]:
    time.sleep(seconds)
    return {"status": "done", "square": x * x, "process": os.getpid()}


def graded(x: float, grading: str | None = None) -> dict[str, Any]:
    """Return the grading of a cell."""
    return {"status": "done", "grading": grading}


def ballast(x: int, size: int) -> dict[str, Any]:
    return {"x": x, "ballast": "x" * size}


def log(x: int, path: str, seconds: float) -> dict[str, Any]:
    """Write a line at the start and one at the end."""
    with Path(path).open("a", encoding="utf-8") as file:
        file.write(f"start {x}\n")
        file.flush()
        time.sleep(seconds)
        file.write(f"end {x}\n")
    return {"x": x}


def gated(x: int, folder: str) -> dict[str, Any]:
    """Write the process's number into a file at the start; from the fourth task on wait for the gate."""
    with (Path(folder) / "started").open("a", encoding="utf-8") as file:
        file.write(f"{x} {os.getpid()}\n")
    while x > 3 and not (Path(folder) / "gate").exists():
        time.sleep(0.02)
    return {"x": x}


def mark(x: int, folder: str, seconds: float) -> dict[str, Any]:
    """Write a file with the process's number at the start, and another at the end."""
    started = Path(folder) / f"{x}.started"
    started.write_text(str(os.getpid()), encoding="utf-8")
    time.sleep(seconds)
    started.with_suffix(".ended").touch()
    return {"x": x, "process": os.getpid()}


def where(x: int, seconds: float = 0.0) -> dict[str, Any]:
    """Return the worker of this task."""
    time.sleep(seconds)
    return {"x": x, "worker": conditions()["worker"]}


def refuse() -> dict[str, Any]:
    raise BadInput("x = −1: must be positive")


def stumble(over: str) -> dict[str, Any]:
    """Raise errors of faulty code, none of them a refusal."""
    if over == "value":
        int("not a number")
    if over == "type":
        len(3)  # type: ignore[arg-type]
    if over == "memory":
        raise MemoryError("9 GiB")
    np.linalg.inv(np.zeros((2, 2)))
    return {}


def interrupted() -> dict[str, Any]:
    """Raise the interpreter's error for an interrupt while a compiled function checks its arguments."""
    raise SystemError("returned a result with an exception set") from KeyboardInterrupt()


def fail() -> dict[str, Any]:
    raise ZeroDivisionError("by nothing")


def needs(path: str) -> dict[str, Any]:
    if not Path(path).exists():
        raise FileNotFoundError(path)
    return {}


def not_finite() -> dict[str, Any]:
    return {"value": float("nan")}


def die() -> dict[str, Any]:
    os.kill(os.getpid(), signal.SIGKILL)
    return {}


def threads() -> dict[str, Any]:
    return {"threads": os.environ.get("OMP_NUM_THREADS")}
