"""The record of a result: versions, machine, date and command."""

from __future__ import annotations

import hashlib
import os
import platform
import re
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

PACKAGES = ("sheetbench", "lumped", "fem_reference", "comparisons", "studies")  # the last in a checkout


def record(command: list[str]) -> dict[str, Any]:
    """Return the record to keep beside a result, ready for JSON: command, date, versions, machine."""
    return {
        "command": command,
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "sheetbench": version(),
        "source": source(),
        "versions": versions(),
        "machine": machine(),
    }


def made_with() -> str:
    """Version, Python, processor and date in a line, for the foot of a page."""
    made, today = machine(), datetime.now(UTC).date().isoformat()
    return (
        f"sheetbench {version()}, Python {made['python']}, {made['processor']}, "
        f"{made['cpu_count']} processors, {today}."
    )


def version() -> str:
    """Return the installed version of sheetbench."""
    return metadata.version("sheetbench")


@cache
def source() -> str:
    """Return a digest of every Python file of the packages: a result is of this code and no other."""
    root = Path(__file__).parents[2]
    paths = [path for package in PACKAGES for path in (root / package).rglob("*.py")]
    files = {path.relative_to(root).as_posix(): path for path in paths}
    return digest(files)


def digest(files: Mapping[str, Path]) -> str:
    """Sixteen digits that follow from the files' names and contents."""
    total = hashlib.sha256()
    for name, path in sorted(files.items()):
        total.update(f"{name}\0{hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()[:16]


@cache
def versions() -> dict[str, str]:
    """Versions of every package that sheetbench is declared to use, optional ones where installed."""
    names = sorted(
        {re.split(r"[^\w.-]", line, maxsplit=1)[0] for line in metadata.requires("sheetbench") or []}
    )
    installed = {}
    for name in names:
        try:
            installed[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return installed


def machine() -> dict[str, Any]:
    """Python, operating system, processor and processor count; nothing that names the machine."""
    return {
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()}",
        "architecture": platform.machine(),
        "processor": processor(),
        "cpu_count": os.cpu_count(),
    }


def processor() -> str:
    """Return the processor's model, as far as the system tells."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor()
    named = re.search(r"^model name\s*:\s*(.+)$", text, re.MULTILINE)
    return named.group(1) if named else platform.processor()
