"""Numba's cache of compiled kernels: place, invalidation, a line of the log where something is compiled.

They are kept in the user's cache, unless NUMBA_CACHE_DIR names another place: numba would keep them inside
the installed package, where uninstalling leaves them behind. By itself numba compiles a kernel anew when its
own file changes; one that calls kernels of other files would go on with what they were. So a kernel's stamp
here is that of all files with kernels, or with the tuples and options that they take, which its file imports,
and theirs. And before it loads what is compiled numba gets all that it would need to compile: here only where
it does.

Kernels are compiled for x86-64-v3 (AVX2, FMA, BMI2) where the processor has that and numba has not been
imported before: results do not depend on the processor then, and a wheel may carry its kernels, in the folder
`compiled`, which is looked into before the user's cache and never written to (`make wheel`).

What is compiled is code that runs here, so the folder must be the user's own and nobody else may write it.

To be imported before numba is. Whoever wants to know that something is compiled listens to the logger
"sheetbench"; nothing is said where all is in the cache.
"""

from __future__ import annotations

import gc
import hashlib
import logging
import os
import platform
import re
import stat
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

try:
    import fcntl
except ImportError:  # not on Windows
    fcntl = None  # type: ignore[assignment]

from llvmlite.binding import get_host_cpu_features
from platformdirs import user_cache_path

from sheetbench import clock
from sheetbench.errors import BadInput

X86_64_V3 = ("avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave")  # beyond x86-64-v2


def target_common_processor() -> None:
    """Have numba compile for x86-64-v3 where this processor is one; else, where the user has chosen
    NUMBA_CPU_NAME, and where numba has read its settings already, leave it as it is."""
    if "numba" in sys.modules or "NUMBA_CPU_NAME" in os.environ:
        return
    if platform.machine() in ("x86_64", "AMD64") and all(map(get_host_cpu_features().get, X86_64_V3)):
        os.environ["NUMBA_CPU_NAME"] = "x86-64-v3"
        os.environ["NUMBA_CPU_FEATURES"] = "+avx2,+fma,+bmi,+bmi2"


os.environ.setdefault("NUMBA_CACHE_DIR", str(user_cache_path("sheetbench") / "numba"))  # numba reads it once
target_common_processor()

from numba.core import caching, event  # noqa: E402  # after its settings are made
from numba.core.runtime import rtsys  # noqa: E402

import sheetbench.linking  # noqa: E402, F401

ROOT = Path(__file__).resolve().parent.parent
SHIPPED = Path(__file__).resolve().parent / "compiled"
OURS = ("lumped", "fem_reference", "sheetbench.numerics", "sheetbench.runs")
IMPORTS = re.compile(rf"^from ((?:{'|'.join(OURS)})[\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)
COMPILED = re.compile(r"\b(njit|inner|NamedTuple|intrinsic|OPTIONS)\b")
NOTICE = "compiling for this machine, once: a minute or two …"


class Locator(caching.UserProvidedCacheLocator):  # type: ignore[misc]  # numba is not typed
    """Of our own kernels: numba's locator with another stamp and another folder.

    The folder is named by the file's path inside its checkout and by the stamp, where numba takes the
    absolute path: checkouts beside each other, and a copy of one, share what is compiled of the same sources.
    """

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        """Return the folder of a file's kernels, relative to the cache's: `lumped.springs-1f2e3d4c5b6a`."""
        path = _resolved(py_file)
        return f"{'.'.join(path.relative_to(ROOT).with_suffix('').parts)}-{stamp(path)[:12]}"

    def get_source_stamp(self) -> str:
        """A digest of all that the kernel may be compiled from."""
        return stamp(_resolved(self._py_file))

    def ensure_cache_path(self) -> None:
        """Once a folder, not once a kernel."""
        if self.get_cache_path() not in _writable:
            _make(Path(self.get_cache_path()))
            super().ensure_cache_path()
            _writable.add(self.get_cache_path())

    @classmethod
    def from_function(cls, function: Callable[..., Any], file: str) -> Locator | None:
        """The locator of a function of ours; None of others, which numba looks after."""
        if not _ours(file):
            return None
        _make(Path(os.environ["NUMBA_CACHE_DIR"]))
        locator: Locator | None = super().from_function(function, file)
        if locator is not None:
            folder = Path(locator.get_cache_path())
            require_own(folder.parent)
            require_own(folder)
        return locator


def kept(file: str) -> bool:
    """Return whether kernels of a file were compiled before, here or into the package."""
    folder = Locator.get_suitable_cache_subpath(file)
    places = SHIPPED, Path(os.environ["NUMBA_CACHE_DIR"])
    return any(next((place / folder).glob("*.nbi"), None) for place in places)


@cache
def _make(folder: Path) -> None:
    """Make a folder that the user alone can enter; where it cannot be made numba looks for another."""
    with suppress(OSError):
        folder.mkdir(mode=0o700, parents=True, exist_ok=True)


@cache
def require_own(folder: Path) -> None:
    """Raise BadInput for a folder that another user may write to: numba unpickles what lies there, and that
    may do anything."""
    with suppress(FileNotFoundError):
        status = folder.stat()
        if status.st_uid not in (0, os.geteuid()) or status.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
            raise BadInput(
                f"{folder}: other users may write here, and what is kept here is run: remove the folder (its "
                "kernels are compiled anew), or name one of your own in NUMBA_CACHE_DIR"
            )


_writable: set[str] = set()


@cache
def stamp(path: Path) -> str:
    """A digest of a file, of those with kernels that it is made of, and of those that say how."""
    digest = hashlib.sha256()
    here = (Path(__file__).with_name(name) for name in ("kernels.py", "linking.py", "compiling.py"))
    for source in (*here, *sorted(made_of(path))):
        digest.update(_text(source).encode())
    return digest.hexdigest()


def made_of(path: Path) -> set[Path]:
    """A file, the files with kernels that it imports, and so on."""
    files, ahead = {path}, [path]
    while ahead:
        fresh = _imported(ahead.pop()) - files
        files |= fresh
        ahead.extend(fresh)
    return files


@cache
def _imported(path: Path) -> set[Path]:
    """Our files with kernels that a file imports."""
    files = set()
    for module, names in IMPORTS.findall(_text(path)):
        parts = ROOT.joinpath(*module.split("."))
        inside = [parts / name for name in re.findall(r"\w+", names)]
        files |= {file for place in (parts, *inside) if _compiled(file := place.with_suffix(".py"))}
    return files


@cache
def _compiled(path: Path) -> bool:
    return path.is_file() and COMPILED.search(_text(path)) is not None


@cache
def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@cache
def _resolved(file: str) -> Path:
    return Path(file).resolve()


@cache
def _ours(file: str) -> bool:
    path = _resolved(file)
    return any(path.is_relative_to(ROOT.joinpath(*package.split("."))) for package in OURS)


class _Announcement(event.Listener):  # type: ignore[misc]
    """Says once a process that something is compiled, and stops the solvers' clock meanwhile, and the search
    for garbage, a tenth of what compiling takes; numba lets one thread compile at a time."""

    announced, collecting, inside = False, False, 0

    def on_start(self, event: object) -> None:
        """Say it before the first."""
        if not self.announced:
            self.announced = True
            from sheetbench.compiling import shorten

            shorten()
            logging.getLogger("sheetbench").info(NOTICE)
        if not self.inside:
            self.collecting = gc.isenabled()
            gc.disable()
        self.inside += 1
        clock.stop()

    def on_end(self, event: object) -> None:
        """Let both go on."""
        clock.start()
        self.inside -= 1
        if self.collecting and not self.inside:
            if gc.get_freeze_count():  # as on the command line: what was compiled stays, as what was imported
                gc.freeze()
            gc.enable()


def _load(self: caching.FunctionCache, signature: object, target_context: object) -> object:
    """A compiled kernel of the cache, or None: what numba does, without what only compiling needs."""
    if not isinstance(self._impl.locator, Locator):
        return _load_as_numba(self, signature, target_context)
    with clock.stopped():
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            kernel = _load_shipped(self, signature, target_context) if SHIPPED.is_dir() else None
            return kernel if kernel is not None else self._load_overload(signature, target_context)


def _load_shipped(self: caching.FunctionCache, signature: object, target_context: Any) -> object:
    """A compiled kernel that came with the wheel, or None."""
    folder = SHIPPED / Path(self.cache_path).name
    shipped = caching.IndexDataCacheFile(
        str(folder), self._impl.filename_base, self._impl.locator.get_source_stamp()
    )
    data = shipped.load(self._index_key(signature, target_context.codegen()))
    return None if data is None else self._impl.rebuild(target_context, data)


def _save(self: caching.FunctionCache, signature: object, compiled: object) -> None:
    """Keep a compiled kernel: what numba does, alone in the kernel's folder. Of two processes that keep
    kernels of one function at once, for arguments of their own, numba's index may name the other's code."""
    if not isinstance(self._impl.locator, Locator) or fcntl is None:
        _save_as_numba(self, signature, compiled)
        return
    self._impl.locator.ensure_cache_path()
    with Path(self.cache_path, "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        _save_as_numba(self, signature, compiled)


def _load_index(self: caching.IndexDataCacheFile) -> dict[Any, str]:
    """Return what is kept of a function; nothing where a type of its arguments is gone from our sources."""
    try:
        index: dict[Any, str] = _load_index_as_numba(self)
    except (AttributeError, ImportError):
        return {}
    return index


_load_index_as_numba = caching.IndexDataCacheFile._load_index
_load_as_numba, _save_as_numba = caching.FunctionCache.load_overload, caching.FunctionCache.save_overload
setattr(caching.FunctionCache, "load_overload", _load)  # noqa: B010  # methods of numba's, for ours alone
setattr(caching.FunctionCache, "save_overload", _save)  # noqa: B010
setattr(caching.IndexDataCacheFile, "_load_index", _load_index)  # noqa: B010
caching.CacheImpl._locator_classes.insert(0, Locator)
event.register("numba:compile", _Announcement())
