"""How much memory this process may still take: of the machine, of its control group, of its own limit."""

from __future__ import annotations

import os
import re
import resource
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

ROOT = Path("/")  # of the system's own files
UNLIMITED = 2**60  # bytes; limits beyond are none


def available() -> int | None:
    """Bytes, None where the system does not tell."""
    rooms = (_of_machine(), _of_address_space(), *_of_groups())
    known = [room for room in rooms if room is not None and room < UNLIMITED]
    return max(0, min(known)) if known else None


def _of_machine() -> int | None:
    """Return what is free or can be freed."""
    if (free := _amount(_text("proc/meminfo"), r"MemAvailable:\s+(\d+) kB")) is not None:
        return 1024 * free
    try:  # macOS tells how much there is
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError, AttributeError):
        return None


def _of_address_space() -> int | None:
    """Return what `ulimit -v` leaves."""
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit == resource.RLIM_INFINITY:
        return None
    taken = _amount(_text("proc/self/status"), r"VmSize:\s+(\d+) kB") or 0
    return limit - 1024 * taken


def _of_groups() -> Iterator[int | None]:
    """Return what every control group that holds this process leaves, of version 2 and 1."""
    for line in _text("proc/self/cgroup").splitlines():
        _, controllers, name = line.split(":", 2)
        inside = Path(name.lstrip("/"))
        for at in (inside, *inside.parents):
            if not controllers:
                folder = ROOT / "sys/fs/cgroup" / at
                yield _left(folder, "memory.max", "memory.current", r"^inactive_file (\d+)")
            elif "memory" in controllers.split(","):
                folder = ROOT / "sys/fs/cgroup/memory" / at
                files = ("memory.limit_in_bytes", "memory.usage_in_bytes")
                yield _left(folder, *files, r"^total_inactive_file (\d+)")


def _left(folder: Path, limit: str, usage: str, cached: str) -> int | None:
    """Return the limit less what is in use, but for pages of files, which are given back when needed."""
    most, used = (_amount(_text(folder / name), r"(\d+)") for name in (limit, usage))
    if most is None or used is None:
        return None
    return most - used + (_amount(_text(folder / "memory.stat"), cached) or 0)


def _text(path: str | Path) -> str:
    with suppress(OSError):
        return (ROOT / path).read_text(encoding="ascii", errors="replace")
    return ""


def _amount(text: str, pattern: str) -> int | None:
    found = re.search(pattern, text, re.MULTILINE)
    return int(found.group(1)) if found else None
