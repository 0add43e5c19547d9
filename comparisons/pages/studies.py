"""The studies in a folder: command, answer, files and tables of every run.

A manifest lists its folder's runs. A file that cannot be read costs a sentence and nothing else.

Tables have values with all their digits to sort by, shown as everywhere else. The manifest has the columns
with their units and formats, the CSV file the values in SI units. Other CSV files, as of samples over time,
are listed among the files.
"""

import csv
import json
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property, partial
from os.path import isdir, isfile, islink
from pathlib import Path
from typing import Any

from comparisons.pages.manifests import LARGEST, manifest
from comparisons.sweep import store
from comparisons.sweep.folder import MANIFEST
from sheetbench.answers.table import Column, Table, TableUnit, unit
from sheetbench.errors import BadInput, foreign
from sheetbench.scenes import Scene

OURS = ("report.html", MANIFEST, store.FILE)


@dataclass
class Study:
    """A run's answer.

    folder: where its files are; place: its path below the root; verb: of the run, "" of sheets without one;
    run: its entry in the manifest; record: the manifest. troubles: a sentence for everything that cannot be
    read.
    """

    folder: Path
    place: str
    verb: str
    files: tuple[str, ...]
    run: Mapping[str, Any] = field(default_factory=dict)
    record: Mapping[str, Any] = field(default_factory=dict)
    troubles: list[str] = field(default_factory=list)

    @cached_property
    def words(self) -> Mapping[str, Any]:
        """The words of the run's answer; empty for a run that has not ended."""
        return self.run.get("words") or {}

    @cached_property
    def document(self) -> Mapping[str, Any]:
        """The run's JSON document. Empty where there is none."""
        documents = [name for name in self.files if name.endswith(".json") and name not in OURS]
        named = self.words.get("document")
        chosen = named if named in documents else next(iter(documents), None)
        document = self.read(chosen, lambda path: json.loads(path.read_text("utf-8"))) if chosen else None
        return document if isinstance(document, dict) else {}

    @cached_property
    def scene(self) -> Scene | None:
        """The scene of the study, where there is one that can be read."""
        data = self.run.get("scene") or self.document.get("scene")
        if not isinstance(data, dict):
            return None
        try:
            return Scene.model_validate(data)
        except (BadInput, ValueError) as error:
            self.troubles.append(f"{self.place}: its scene cannot be read: {foreign(error)}")
            return None

    @property
    def title(self) -> str:
        """The title of the study."""
        data = self.run.get("scene")
        named = self.words.get("title") or (data.get("name") if isinstance(data, dict) else None)
        alone = self.files[0] if not self.verb and len(self.files) == 1 else ""
        return str(named or alone or self.place or self.folder.resolve().name)

    @property
    def result(self) -> str:
        """The run's answer in a line."""
        return str(self.words.get("result") or "")

    @property
    def date(self) -> str:
        """The day and minute of the run, as "2026-11-21 04:37"."""
        return str(self.run.get("date") or "")[:16].replace("T", " ")

    @property
    def command(self) -> str:
        """The command as it was typed."""
        words = self.run.get("command") or ()
        return shlex.join(map(str, words))

    @property
    def notes(self) -> list[str]:
        """The notes of the run on one line each but its complaints; a colon joins the next."""
        notes: list[str] = []
        for note in self.words.get("notes") or texts(self.document.get("notes")):
            line = " ".join(note.split())
            if notes and notes[-1].endswith(":"):
                notes[-1] += f" {line}"
            else:
                notes.append(line)
        return [note for note in notes if note not in self.complaints]

    @property
    def complaints(self) -> list[str]:
        """Failures of the run, and warnings about the scene."""
        complaints = [*self.words.get("complaints", ()), *texts(self.document.get("warnings"))]
        return list(dict.fromkeys(complaints))

    def read(self, name: str, reader: Callable[[Path], Any]) -> Any:
        """Return the result of a reader on a file. For a file that is missing, outside the folder, too large
        or damaged, return None and add a sentence to `troubles`."""
        path = self.folder / name
        if not path.resolve().is_relative_to(self.folder.resolve()):
            self.troubles.append(f"{name}: lies outside {self.folder.name}, left alone")
        elif not path.is_file():
            self.troubles.append(f"{self.path_of(name)}: the manifest names it, but it is not there")
        elif path.stat().st_size > LARGEST:
            self.troubles.append(f"{self.path_of(name)}: too large for a page, left out")
        else:
            try:
                return reader(path)
            except RecursionError:
                self.troubles.append(f"{self.path_of(name)}: damaged, nested too deeply")
            except (Exception, SystemExit) as error:  # readers of meshes raise and exit as they like
                self.troubles.append(f"{self.path_of(name)}: damaged, cannot be read: {foreign(error)}")
        return None

    def guarded(self, what: str, made: Callable[[], Any]) -> Any:
        """Return the result of a call on the manifest's texts. If they are damaged, return None and add a
        sentence to `troubles`."""
        try:
            return made()
        except Exception as error:  # the document may hold anything
            self.troubles.append(
                f"{self.path_of(what)}: cannot be shown: {type(error).__name__}: {foreign(error)}"
            )
        return None

    def path_of(self, name: str) -> str:
        """Return a file's path below the root."""
        return f"{self.place}/{name}" if self.place else name

    def with_suffix(self, *suffixes: str) -> list[str]:
        """Return names of its files with the given suffixes."""
        return [name for name in self.files if name.lower().endswith(suffixes)]


def texts(value: Any) -> list[str]:
    """Return the texts of a document's list; none where it is something else."""
    return [str(one) for one in value] if isinstance(value, list) else []


@dataclass
class FolderContents:
    """Studies in the order of a page, and sentences on damaged files."""

    studies: list[Study] = field(default_factory=list)
    troubles: list[str] = field(default_factory=list)


def read(root: Path) -> FolderContents:
    """Return every study in a folder and below it. Raises BadInput for a missing folder."""
    if not root.is_dir():
        raise BadInput(f"'{root}': there is no such folder")
    contents = FolderContents()
    _collect(root, "", contents)
    return contents


def _collect(folder: Path, place: str, contents: FolderContents) -> None:
    """Add the studies of a folder and of its subfolders, except output folders of runs, hidden folders and
    links; place: the folder's path below the root."""
    try:
        paths = [path for path in sorted(folder.iterdir()) if not path.name.startswith(".")]
    except OSError as error:
        contents.troubles.append(f"{folder}: cannot be read: {error.strerror}")
        return
    record: Mapping[str, Any] = {}
    try:
        record = manifest(folder)
    except BadInput as error:
        damaged = f"{place}/{MANIFEST}".lstrip("/") + f": damaged, cannot be read: {foreign(error)}"
        contents.troubles.append(damaged)
    outputs = {*OURS}
    for verb, run in record.get("runs", {}).items():
        outputs.update(names := tuple(run.get("files", ())))
        contents.studies.append(Study(folder, place, verb, names, run, record))
    excluded = {path.stem for path in paths if path.suffix == ".pvd"} | {name.rstrip("/") for name in outputs}
    for path in paths:
        if isdir(path) and not islink(path) and path.name not in excluded and not isfile(path / "run.json"):
            _collect(path, f"{place}/{path.name}".lstrip("/"), contents)


MOST, LONG = 500, 15  # rows of a table on a page, and from which on it is folded


@dataclass(frozen=True, repr=False)
class PageTable(Table):
    """A table for a page. note: a sentence about omitted rows; aside: shown when requested only."""

    note: str = ""
    aside: bool = False

    @property
    def cells(self) -> list[list[tuple[Column, str, Any]]]:
        """Column, text and value of every cell, by rows."""
        both = zip(self.shown_rows(), self.rows, strict=True)
        return [list(zip(self.columns, texts, values, strict=True)) for texts, values in both]


def tables(study: Study) -> list[PageTable]:
    """Return every table in a study's manifest."""
    collected = []
    for description in study.words.get("tables", ()):
        name, rows = f"{description.get('name')}.csv", description.get("rows")
        if rows is None and name in study.files:
            rows = (study.read(name, _read_rows) or [])[1:] or None
        table = study.guarded(name, partial(_restore_table, description, rows)) if rows is not None else None
        if table:
            collected.append(table)
    return collected


def _read_rows(path: Path) -> list[list[str]]:
    with path.open(encoding="utf-8", newline="") as file:
        return [[_strip_guard(cell) for cell in row] for row in csv.reader(file, strict=True) if row]


def _strip_guard(cell: str) -> str:
    """Return a cell without the apostrophe that protects it from being read as a formula by spreadsheets."""
    return cell[1:] if cell[:1] == "'" and cell[1:2] in ("=", "+", "-", "@", "\t", "\r") else cell


def _restore_table(words: Mapping[str, Any], rows: Sequence[Sequence[Any]]) -> PageTable:
    names = {one.name for one in fields(Column)}
    columns = [Column(**{k: v for k, v in column.items() if k in names}) for column in words["columns"]]
    units = [bool(column.get("units")) for column in words["columns"]]
    values = [
        tuple(_parse_cell(c, u, v) for c, u, v in zip(columns, units, row, strict=True))
        for row in rows[:MOST]
    ]
    caption, text = words.get("caption", ""), words.get("text", "")
    note = f"The first {MOST} of {len(rows)} rows; the file has all." if len(rows) > MOST else ""
    return PageTable(caption, tuple(columns), tuple(values), text=text, note=note, aside=len(rows) > LONG)


def _parse_cell(column: Column, of_units: bool, value: Any) -> Any:
    """Return a cell's value in the original table: a number, a unit, text, or None."""
    if value in ("", None):
        return None
    if of_units:
        return TableUnit(*value) if isinstance(value, list) else unit(str(value))
    if not column.numeric:
        return str(value)
    try:
        number = float(value)
    except (TypeError, ValueError):
        return None
    return int(number) if column.form.endswith("d") and number == number else number
