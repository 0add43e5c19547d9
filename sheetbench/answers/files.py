"""Folders for output files, and conversion of plain data to JSON."""

import hashlib
import json
import math
import os
from pathlib import Path
from typing import Any

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.files import replacing


def write_text(path: Path, text: str) -> None:
    """Write a text file, whole or not at all.

    Bytes of a file's name that are not UTF-8 become \\udcXX, as in JSON.
    """
    with replacing(path) as partial:
        partial.write_text(text, encoding="utf-8", errors="backslashreplace")


def folder(path: Path | str, option: str = "--out") -> Path:
    """Return a folder, made if necessary. Raises BadInput if it cannot be made or written to."""
    if path == "" or not isinstance(path, str | os.PathLike):
        raise BadInput(f"{option} = {path!r}: name a folder; '.' is the current one")
    made = Path(path)
    if os.path.realpath(path) == os.sep:
        raise BadInput(f"{option} = '{path}': the root of the file system; name a folder in it")
    try:
        made.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        why = "a broken link is there" if made.is_symlink() else error.strerror
        raise BadInput(f"{option} = '{path}': cannot make this folder: {why}") from None
    if not os.access(made, os.W_OK | os.X_OK):
        raise BadInput(f"{option} = '{path}': cannot be written to; make it writable, or choose another")
    return made


def digest(text: str) -> str:
    """Return sixteen digits of a text's hash."""
    return hashlib.sha256(text.encode()).hexdigest()[:16]


def plain(value: Any) -> Any:
    """Convert data for JSON: arrays to lists, numbers that are not finite to null."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value


def to_json(value: Any, escaped: bool = False) -> str:
    """Return a JSON document, indented, with a final newline, without NaN and Infinity.

    escaped: write characters beyond ASCII as \\uXXXX.
    """
    return json.dumps(plain(value), indent=2, ensure_ascii=escaped, allow_nan=False) + "\n"
