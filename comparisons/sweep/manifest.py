"""The record of a result: versions, machine, date and command."""

import os
import platform
import re
from contextlib import suppress
from datetime import UTC, datetime
from functools import cache
from importlib import metadata
from pathlib import Path
from typing import Any

from sheetbench.sources import source, version


def record(command: list[str]) -> dict[str, Any]:
    """Return the record of a result as JSON data: command, date, versions, machine."""
    return {
        "command": command,
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "sheetbench": version(),
        "source": source(),
        "versions": versions(),
        "machine": machine(),
    }


def made_with() -> str:
    """Return version, Python, processor and date in a line, for the foot of a page."""
    here, today = machine(), datetime.now(UTC).date().isoformat()
    return (
        f"sheetbench {version()}, Python {here['python']}, {here['processor']}, "
        f"{here['cpu_count']} processors, {today}."
    )


@cache
def versions() -> dict[str, str]:
    """Return the versions of the packages that sheetbench declares, as far as installed."""
    names = sorted(
        {re.split(r"[^\w.-]", line, maxsplit=1)[0] for line in metadata.requires("sheetbench") or []}
    )
    installed = {}
    for name in names:
        with suppress(metadata.PackageNotFoundError):
            installed[name] = metadata.version(name)
    return installed


def machine() -> dict[str, Any]:
    """Return Python, operating system, processor and processor count, without a name of the machine."""
    return {
        "python": platform.python_version(),
        "system": f"{platform.system()} {platform.release()}",
        "architecture": platform.machine(),
        "processor": processor(),
        "cpu_count": os.cpu_count(),
    }


def processor() -> str:
    """Return the processor's model, as far as the system reports it."""
    text = ""
    with suppress(OSError):
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    match = re.search(r"^model name\s*:\s*(.+)$", text, re.MULTILINE)
    return match.group(1) if match else platform.processor()
