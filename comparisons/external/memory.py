"""Memory that this process may still take, by the machine, its control groups and its own limit."""

import os
import re
import resource
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

ROOT = Path("/")  # of the system's own files
UNLIMITED = 2**60  # bytes; larger limits count as none


def available() -> int | None:
    """Return the available memory in bytes, None if the system does not report it."""
    amounts = (_of_machine(), _of_address_space(), *_of_groups())
    limits = [amount for amount in amounts if amount is not None and amount < UNLIMITED]
    return max(0, min(limits)) if limits else None


def _of_machine() -> int | None:
    """Return the machine's free or reclaimable memory [bytes]."""
    if (free := _amount(_text("proc/meminfo"), r"MemAvailable:\s+(\d+) kB")) is not None:
        return 1024 * free
    try:  # macOS reports the whole memory
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (ValueError, OSError, AttributeError):
        return None


def _of_address_space() -> int | None:
    """Return the address space left below `ulimit -v` [bytes]."""
    limit, _ = resource.getrlimit(resource.RLIMIT_AS)
    if limit == resource.RLIM_INFINITY:
        return None
    used = _amount(_text("proc/self/status"), r"VmSize:\s+(\d+) kB") or 0
    return limit - 1024 * used


def _of_groups() -> Iterator[int | None]:
    """Return the memory left [bytes] in each control group of this process, of versions 2 and 1."""
    for line in _text("proc/self/cgroup").splitlines():
        _, controllers, name = line.split(":", 2)
        group = Path(name.lstrip("/"))
        for at in (group, *group.parents):
            if not controllers:
                folder = ROOT / "sys/fs/cgroup" / at
                yield _free_memory(folder, "memory.max", "memory.current", r"^inactive_file (\d+)")
            elif "memory" in controllers.split(","):
                folder = ROOT / "sys/fs/cgroup/memory" / at
                files = ("memory.limit_in_bytes", "memory.usage_in_bytes")
                yield _free_memory(folder, *files, r"^total_inactive_file (\d+)")


def _free_memory(folder: Path, limit: str, usage: str, cached: str) -> int | None:
    """Return a group's limit minus its use [bytes]; cached pages of files do not count as used."""
    most, used = (_amount(_text(folder / name), r"(\d+)") for name in (limit, usage))
    if most is None or used is None:
        return None
    return most - used + (_amount(_text(folder / "memory.stat"), cached) or 0)


def _text(path: str | Path) -> str:
    with suppress(OSError):
        return (ROOT / path).read_text(encoding="ascii", errors="replace")
    return ""


def _amount(text: str, pattern: str) -> int | None:
    match = re.search(pattern, text, re.MULTILINE)
    return int(match.group(1)) if match else None
