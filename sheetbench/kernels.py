"""Where compiled kernels are kept, when they are compiled anew, and that somebody hears of it.

They are kept in the user's cache, unless NUMBA_CACHE_DIR names another place: numba would keep them inside
the installed package, where uninstalling leaves them behind. By itself numba compiles a kernel anew when its
own file changes; one that calls kernels of other files would go on with what they were. So a kernel's stamp
here is that of all files with kernels, or with the tuples and options that they take, which its file imports,
and theirs.

To be imported before numba is. Whoever wants to know that something is compiled listens to the logger
"sheetbench"; nothing is said where all is in the cache.
"""

from __future__ import annotations

import hashlib
import logging
import os
import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

from platformdirs import user_cache_path

os.environ.setdefault("NUMBA_CACHE_DIR", str(user_cache_path("sheetbench") / "numba"))  # numba reads it once

from numba.core import caching, event  # after its directory is set

ROOT = Path(__file__).resolve().parent.parent
OURS = ("lumped", "fem_reference")
IMPORTS = re.compile(rf"^from ((?:{'|'.join(OURS)})[\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)
COMPILED = re.compile(r"\b(njit|NamedTuple|intrinsic|OPTIONS)\b")
SAID = "compiling for this machine, once: a minute or two …"


class Locator(caching.UserProvidedCacheLocator):  # type: ignore[misc]  # numba is not typed
    """Of our own kernels: numba's locator with another stamp."""

    def get_source_stamp(self) -> str:
        """A digest of all that the kernel may be compiled from."""
        return stamp(Path(self._py_file).resolve())

    @classmethod
    def from_function(cls, function: Callable[..., Any], file: str) -> Locator | None:
        """The locator of a function of ours; None of others, which numba looks after."""
        path = Path(file).resolve()
        if not path.is_relative_to(ROOT) or path.relative_to(ROOT).parts[0] not in OURS:
            return None
        found: Locator | None = super().from_function(function, file)
        return found


@cache
def stamp(path: Path) -> str:
    """A digest of a file and of those with kernels that it is made of."""
    digest = hashlib.sha256()
    for source in sorted(made_of(path)):
        digest.update(_text(source).encode())
    return digest.hexdigest()


def made_of(path: Path) -> set[Path]:
    """A file, the files with kernels that it imports, and so on."""
    found, ahead = {path}, [path]
    while ahead:
        fresh = {other for other in _imported(ahead.pop()) if COMPILED.search(_text(other))} - found
        found |= fresh
        ahead.extend(fresh)
    return found


@cache
def _imported(path: Path) -> set[Path]:
    """Our files that a file imports."""
    found = set()
    for module, names in IMPORTS.findall(_text(path)):
        parts = ROOT.joinpath(*module.split("."))
        inside = [parts / name for name in re.findall(r"\w+", names)]
        found |= {file for place in (parts, *inside) if (file := place.with_suffix(".py")).is_file()}
    return found


@cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


class _Announcement(event.Listener):  # type: ignore[misc]
    """Says once a process that something is compiled."""

    said = False

    def on_start(self, event: object) -> None:
        """Say it before the first."""
        if not self.said:
            self.said = True
            logging.getLogger("sheetbench").info(SAID)

    def on_end(self, event: object) -> None:
        """Nothing."""


caching.CacheImpl._locator_classes.insert(0, Locator)
event.register("numba:compile", _Announcement())
