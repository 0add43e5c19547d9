"""Cache folder of the compiled kernels, and a line of the log when one is compiled.

numba compiles a function anew when its own file changes, but keeps the old machine code when only a file with
functions that it calls has changed. So this project adds a locator to numba's list, for its own files alone:
a folder named by a digest of all files with kernels. numba's settings, its other locators, and functions of
other packages stay unchanged.

The folder lies in NUMBA_CACHE_DIR if the user has set it, else in the user's cache; if it cannot be written,
the process uses a temporary copy.
"""

from __future__ import annotations

import atexit
import hashlib
import logging
import os
import re
import shutil
from contextlib import suppress
from functools import cache
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from numba.core import caching, config, event
from platformdirs import user_cache_path

from sheetbench import clock

ROOT = Path(__file__).resolve().parent.parent
PACKAGES = tuple(ROOT / name for name in ("lumped", "fem_reference", "sheetbench"))
WITH_KERNELS = re.compile(rb"\b(njit|inner|intrinsic|NamedTuple)\b")  # also tuples passed to kernels
NOTICE = "compiling for this machine, once: about half a minute …"


class KernelLocator(caching.UserWideCacheLocator):  # type: ignore[misc]  # numba is not typed
    """Cache folder of the kernels in this project's files."""

    def __init__(self, function: Any, file: str) -> None:
        super().__init__(function, file)
        self._cache_path = str(folder(file))

    def get_source_stamp(self) -> str:
        """Return the digest of all files with kernels."""
        return digest()

    @classmethod
    def from_function(cls, function: Any, file: str) -> KernelLocator | None:
        """Return the locator of a function in this project's files, else None for numba's own locators."""
        path = Path(file).resolve()
        if not any(map(path.is_relative_to, PACKAGES)):
            return None
        locator: KernelLocator | None = super().from_function(function, file)
        return locator


@cache
def folder(file: str) -> Path:
    """Return the folder of the kernels of a source file."""
    parts = Path(file).resolve().relative_to(ROOT).with_suffix("").parts
    return Path(root(), f"kernels-{digest()}", ".".join(parts))


@cache
def root() -> Path:
    """Return a folder that can be written, for kernels of all digests."""
    place = Path(config.CACHE_DIR or user_cache_path("sheetbench"))  # type: ignore[attr-defined]
    with suppress(OSError):
        place.mkdir(parents=True, exist_ok=True)
    if os.access(place, os.W_OK | os.X_OK):
        return place
    temporary = mkdtemp(prefix="sheetbench-")
    atexit.register(shutil.rmtree, temporary, ignore_errors=True)
    kernels = f"kernels-{digest()}"
    if (place / kernels).is_dir():
        shutil.copytree(place / kernels, Path(temporary, kernels))
    unwritable = "%s cannot be written: kernels are kept as long as the process"
    logging.getLogger("sheetbench").info(unwritable, place)
    return Path(temporary)


def compiled_before(file: str) -> bool:
    """Return whether the cache holds machine code of a source file's kernels."""
    return any(folder(file).glob("*.nbi"))


@cache
def digest() -> str:
    """Return a digest of all source files with kernels, whose functions call each other across files."""
    texts = (path.read_bytes() for package in PACKAGES for path in sorted(package.rglob("*.py")))
    return hashlib.sha256(b"".join(filter(WITH_KERNELS.search, texts))).hexdigest()[:16]


class Announcement(event.Listener):  # type: ignore[misc]
    """A listener that logs once in a process that kernels of this project are compiled."""

    announced = False

    def on_start(self, event: Any) -> None:
        """Log before the first kernel."""
        function = getattr(event.data["dispatcher"], "py_func", None)
        package = str(getattr(function, "__module__", None)).partition(".")[0]  # some of numba's have none
        if not self.announced and package in ("lumped", "fem_reference", "sheetbench"):
            self.announced = True
            logging.getLogger("sheetbench").info(NOTICE)

    def on_end(self, event: Any) -> None:
        """Do nothing."""


class StoppedClock(event.Listener):  # type: ignore[misc]
    """A listener that stops the solvers' clock while numba compiles or loads a kernel: both hold its
    compiler's lock."""

    def on_start(self, event: Any) -> None:
        """Stop the clock."""
        clock.stop()

    def on_end(self, event: Any) -> None:
        """Let the clock go on."""
        clock.start()


caching.CacheImpl._locator_classes.insert(0, KernelLocator)
event.register("numba:compile", Announcement())
event.register("numba:compiler_lock", StoppedClock())
