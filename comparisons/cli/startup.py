"""Settings of a process of the command line: malloc, one BLAS thread, and fewer garbage collections, the
fewest during imports.

Python's default collections take a sixth of the time of `sheetbench compare` and a tenth of the time for
compiling kernels; BLAS threads, which spin while they wait for small matrices, take as much CPU time.
"""

from __future__ import annotations

import gc
import os

from sheetbench.heap import keep_freed_memory

DEFAULTS = gc.get_threshold()
IMPORT_THRESHOLD = 500_000  # allocations between collections: a verb imports some 150 000 permanent objects
WORKING = 10_000  # compiling kernels takes as much memory as with the default of 700


def begin() -> None:
    """Reduce garbage collections, keep freed memory, and use one BLAS thread unless the user set a number."""
    keep_freed_memory()
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read when NumPy and SciPy are imported
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "true")  # avoids a search of all installed packages
    gc.set_threshold(IMPORT_THRESHOLD, *DEFAULTS[1:])


def end() -> None:
    """Collect more often again, without the objects imported since `begin`."""
    if gc.get_threshold()[0] == IMPORT_THRESHOLD:
        gc.freeze()
        gc.set_threshold(WORKING, *DEFAULTS[1:])
