"""What a process of the command line sets for itself: malloc, one BLAS thread, and fewer garbage collections,
fewest while a verb imports what it works with: what is imported stays.

Collections take a sixth of the time of `sheetbench compare` otherwise, a tenth of compiling the kernels; and
threads of BLAS, which wait for small matrices by spinning, as much of its CPU.
"""

from __future__ import annotations

import gc
import os

from sheetbench.heap import keep_freed_memory

USUAL = gc.get_threshold()
IMPORTING = 500_000  # allocations between collections: a verb imports some 150 000 objects that stay
WORKING = 10_000  # kernels compile in as much memory as with the usual 700


def begin() -> None:
    """Collect seldom from now on, keep the memory that arrays free, and use one thread for BLAS unless the
    user names a number."""
    keep_freed_memory()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when NumPy and SciPy are imported
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "true")  # it searches all that is installed for them
    gc.set_threshold(IMPORTING, *USUAL[1:])


def end() -> None:
    """Collect more often again, and leave alone what was imported since `begin`."""
    if gc.get_threshold()[0] == IMPORTING:
        gc.freeze()
        gc.set_threshold(WORKING, *USUAL[1:])
