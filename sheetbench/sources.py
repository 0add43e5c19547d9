"""Identity of the code that made a result: the installed version, and a digest of the packages' files."""

import hashlib
from collections.abc import Mapping
from functools import cache
from importlib import metadata
from pathlib import Path

PACKAGES = ("sheetbench", "lumped", "fem_reference", "comparisons", "studies")  # the last in a checkout


def version() -> str:
    """Return the installed version of sheetbench."""
    return metadata.version("sheetbench")


@cache
def source() -> str:
    """Return a digest of every Python file of the packages, which identifies the code of a result."""
    root = Path(__file__).parents[1]
    paths = [path for package in PACKAGES for path in (root / package).rglob("*.py")]
    return digest({path.relative_to(root).as_posix(): path for path in paths})


def digest(files: Mapping[str, Path]) -> str:
    """Return sixteen digits of a hash of the files' names and contents."""
    total = hashlib.sha256()
    for name, path in sorted(files.items()):
        total.update(f"{name}\0{hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()[:16]
