"""What a result was made with: versions, machine, date, scene, settings and command."""

from __future__ import annotations

import os
import platform
import re
from datetime import UTC, datetime
from importlib import metadata
from pathlib import Path
from typing import Any

from sheetbench.scenes import Scene


def manifest(scene: Scene, settings: dict[str, Any], command: list[str]) -> dict[str, Any]:
    """The record to keep beside the result of a scene, ready for JSON."""
    asked = scene.model_dump(mode="json", by_alias=True, exclude_none=True)
    return {**record(command), "settings": settings, "scene": asked}


def record(command: list[str]) -> dict[str, Any]:
    """What does not depend on the scene: command, date, versions, machine."""
    return {
        "command": command,
        "date": datetime.now(UTC).isoformat(timespec="seconds"),
        "sheetbench": version(),
        "versions": versions(),
        "machine": machine(),
    }


def today() -> str:
    """The date, UTC."""
    return datetime.now(UTC).date().isoformat()


def version() -> str:
    """The installed version of sheetbench."""
    return metadata.version("sheetbench")


def versions() -> dict[str, str]:
    """Versions of every package that sheetbench is declared to use, optional ones where installed."""
    names = sorted(
        {re.split(r"[^\w.-]", line, maxsplit=1)[0] for line in metadata.requires("sheetbench") or []}
    )
    found = {}
    for name in names:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            continue
    return found


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
    """The processor's model, as far as the system tells."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return platform.processor()
    named = re.search(r"^model name\s*:\s*(.+)$", text, re.MULTILINE)
    return named.group(1) if named else platform.processor()
