"""Growth of a process in memory during a solve.

On Linux, the growth is the largest resident set minus its size before the solve, with all code loaded;
elsewhere it is the growth of the largest resident set so far.
"""

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
    """Return the result of `solve`, and the growth of the process during the call [bytes]."""
    gc.collect()
    with suppress(OSError, AttributeError):  # glibc: release free pages, so that their reuse counts as growth
        ctypes.CDLL("libc.so.6").malloc_trim(0)
    with suppress(OSError):  # Linux: reset the largest set to the present one
        Path("/proc/self/clear_refs").write_text("5")
    start = _largest_resident_set()
    solution = solve()
    return solution, _largest_resident_set() - start


def _largest_resident_set() -> int:
    """Return the size of the largest resident set [bytes]; Linux reports it for this program alone, while
    `getrusage` includes the process that started it."""
    with suppress(OSError):
        line = re.search(r"^VmHWM:\s+(\d+) kB", Path("/proc/self/status").read_text(), re.MULTILINE)
        if line is not None:
            return 1024 * int(line[1])
    largest = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return largest if sys.platform == "darwin" else 1024 * largest
