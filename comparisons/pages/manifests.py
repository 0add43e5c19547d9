"""Validated reading of a folder's manifest, as verbs write it.

What a run was given and found, under "settings" and "scene", may be anything: it is checked by the code that
shows it.
"""

import json
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, TypeAdapter, ValidationError
from typing_extensions import TypedDict

from comparisons.sweep.folder import MANIFEST
from sheetbench.errors import BadInput, foreign

LARGEST = 64_000_000  # bytes of a file that a page reads
LONGEST = 255  # bytes of a file's name


def _name(text: str) -> str:
    if not text or "\0" in text or any(len(part.encode()) > LONGEST for part in text.split("/")):
        raise BadInput("not the name of a file")
    return text


Name = Annotated[str, AfterValidator(_name)]


class Words(TypedDict, total=False):
    """The texts of a run's answer (`sheetbench.answers.report.Report.words`)."""

    title: str
    subtitle: str | None
    lead: str | None
    document: Name
    tables: list[dict[str, Any]]
    notes: list[str]
    complaints: list[str]
    met: bool


class Run(TypedDict, total=False):
    """A verb's latest run."""

    command: list[str]
    date: str | None
    finished: bool
    files: list[Name]
    words: Words | None


class Record(TypedDict, total=False):
    """The manifest."""

    sheetbench: str
    source: str
    machine: dict[str, Any]
    versions: dict[str, str]
    runs: dict[str, Run]


SHAPE = TypeAdapter(Record)


def manifest(folder: Path) -> dict[str, Any]:
    """Return the folder's manifest, empty where there is none. Raises BadInput for one that cannot be
    read."""
    path = folder / MANIFEST
    if not path.exists():
        return {}
    try:
        if not path.is_file() or path.stat().st_size > LARGEST:
            raise BadInput("no file, or too large for a page")
        data = json.loads(path.read_text(encoding="utf-8"))
        SHAPE.validate_python(data, strict=True)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(map(str, first["loc"]))
        raise BadInput(f"{place}: {first['msg']}" if place else first["msg"]) from None
    except (OSError, ValueError, RecursionError) as error:
        raise BadInput(foreign(error)) from None
    return dict(data)
