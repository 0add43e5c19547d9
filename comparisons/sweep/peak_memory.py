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
from contextlib import suppress
from pathlib import Path
from typing import TypeVar

Result = TypeVar("Result")


def with_peak_memory(solve: Callable[[], Result]) -> tuple[Result, int]:
    """Return what `solve` returns, and by how many bytes the process grew meanwhile."""
    gc.collect()
    with suppress(OSError, AttributeError):  # glibc: free pages go back, so that their reuse counts as growth
        ctypes.CDLL("libc.so.6").malloc_trim(0)
    with suppress(OSError):  # Linux: the largest set restarts from the present one
        Path("/proc/self/clear_refs").write_text("5")
    before = _largest_resident_set()
    solution = solve()
    return solution, _largest_resident_set() - before


def _largest_resident_set() -> int:
    """Return the size of the largest resident set [bytes].

    Of this program alone where Linux tells it: `getrusage` counts the process that started it too.
    """
    with suppress(OSError):
        line = re.search(r"^VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text(), re.MULTILINE)
        if line is not None:
            return 1024 * int(line[1])
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest if sys.platform == "darwin" else 1024 * largest
