"""By how much a process grows while it solves.

How far its resident set rises above what it was with all code loaded (Linux; elsewhere the rise of the
largest resident set so far).
"""

from __future__ import annotations

import ctypes
import gc
import re
import resource
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar

Found = TypeVar("Found")


def with_peak_memory(solve: Callable[[], Found]) -> tuple[Found, int]:
    """What `solve` returns, and by how many bytes the process grew meanwhile."""
    gc.collect()
    _release_freed_memory()
    before = _start_watching_memory()
    solution = solve()
    return solution, max(0, _peak_memory() - before)


def _start_watching_memory() -> int:
    """Memory [bytes] from which growth is counted."""
    try:
        Path("/proc/self/clear_refs").write_text("5")  # the peak restarts from the present resident set
        return _proc("VmRSS")
    except (OSError, LookupError):
        return _largest_resident_set()


def _peak_memory() -> int:
    try:
        return _proc("VmHWM")
    except (OSError, LookupError):
        return _largest_resident_set()


def _proc(name: str) -> int:
    found = re.search(rf"^{name}:\s+(\d+) kB", Path("/proc/self/status").read_text(), re.MULTILINE)
    if found is None:
        raise LookupError(name)
    return 1024 * int(found.group(1))


def _largest_resident_set() -> int:
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest if sys.platform == "darwin" else 1024 * largest


def _release_freed_memory() -> None:
    """Give the heap's free pages back, so that reusing them counts as growth (glibc; elsewhere nothing)."""
    try:
        ctypes.CDLL("libc.so.6").malloc_trim(0)
    except (OSError, AttributeError):
        return
