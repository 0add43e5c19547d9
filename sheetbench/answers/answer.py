"""Base of all answers: a document, tables, figures and notes, from which its files and its display follow."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

from sheetbench.answers import notebook
from sheetbench.answers.report import ROWS, Picture, Report, Write
from sheetbench.answers.table import Table
from sheetbench.errors import BadInput

if TYPE_CHECKING:
    import pandas


class Answer(ABC):
    """Base of all answers. file_name: name of the files under `--out`. page_name: name of the Markdown file
    if it differs. notes_shown: number of notes that a terminal shows without --verbose."""

    file_name: ClassVar[str] = "answer"
    page_name: ClassVar[str] = ""
    notes_shown: ClassVar[int] = 3

    @abstractmethod
    def document(self) -> dict[str, Any]:
        """Return the JSON document: plain data in SI units."""

    @abstractmethod
    def tables(self) -> Sequence[Table]:
        """Return the tables; a table with a name becomes a CSV file too."""

    def heading(self) -> tuple[str, str, str]:
        """Return title, subtitle and a further line: the scene's, unless an answer has its own."""
        scene: Any = getattr(self, "scene", None)
        return ("", "", "") if scene is None else (scene.name, scene.title, "")

    def result(self) -> str:
        """Return the answer in a line with its numbers, for a list of answers. It is the first complaint or
        note, unless an answer has its own line."""
        return next(iter((*self.complaints(), *self.notes())), "")

    def printed(self) -> Sequence[Table]:
        """Return the tables that a terminal shows."""
        return self.tables()

    def figures(self) -> Sequence[Picture]:
        """Return the figures, drawn when they are requested."""
        return ()

    def notes(self) -> Sequence[str]:
        """Return remarks on the tables, a sentence each."""
        return ()

    def complaints(self) -> Sequence[str]:
        """Return sentences on failures and warnings."""
        return ()

    def files(self) -> Mapping[str, Write]:
        """Return the writers of further files, by the files' names."""
        return {}

    def choices(self) -> Mapping[str, Any]:
        """Return the settings of the answer, for the manifest."""
        return {}

    @property
    def succeeded(self) -> bool:
        """Return whether the question has its answer."""
        return True

    def report(self) -> Report:
        """Return all parts of the answer as a report."""
        title, subtitle, lead = self.heading()
        result = self.result()
        pictures = (replace(one, description=one.description or result) for one in self.figures())
        return Report(
            name=self.file_name,
            page=self.page_name,
            title=title,
            subtitle=subtitle,
            lead=lead,
            result=result,
            document=self.document(),
            tables=tuple(self.tables()),
            printed=tuple(self.printed()),
            notes=tuple(self.notes()),
            notes_shown=self.notes_shown,
            complaints=tuple(self.complaints()),
            pictures=tuple(pictures),
            attachments=self.files(),
            settings=self.choices(),
            succeeded=self.succeeded,
        )

    def to_pandas(self, table: str = "") -> pandas.DataFrame:
        """Return the first table, or the table of a name, as a data frame in SI units. Raises BadInput if
        there is no table of this name, or pandas is not installed."""
        tables = {one.name or one.caption: one for one in self.tables()}
        if not tables or (table and table not in tables):
            raise BadInput(f"to_pandas('{table}'): tables are {', '.join(tables) or 'none'}")
        return tables[table or next(iter(tables))].to_pandas()

    def save(self, folder: Path | str, figure: str | None = None) -> tuple[str, ...]:
        """Write every file and picture into a folder, as `Report.save` does."""
        return self.report().save(folder, figure)

    def __repr__(self) -> str:
        return self.report().text(ROWS)

    def _repr_mimebundle_(self, **kinds: Any) -> dict[str, Any]:
        """Return tables and picture for a notebook, drawn once."""
        return notebook.bundle(self.report())

    def _repr_html_(self) -> str:
        return str(notebook.bundle(self.report())["text/html"])

    def _repr_png_(self) -> bytes | None:
        return notebook.first_png(self.report().pictures)
