"""Reports: the parts of an answer in one type, from which every display of it is made.

A terminal, a JSON document and a folder of files are made from a report, in one place each; an answer only
provides its tables, notes and pictures.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from math import isfinite
from pathlib import Path
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Any

from sheetbench.answers import notebook
from sheetbench.answers.escape import html, markdown, terminal
from sheetbench.answers.figure_style import PLAIN, FigureStyle, parse_figure
from sheetbench.answers.files import digest, to_json, write_text
from sheetbench.answers.files import folder as made
from sheetbench.answers.table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Write = Callable[[Path], None]
ROWS = 6  # of a table at a prompt
RASTER, FILM = ("png", "pdf"), ("gif",)


class NoPicture(Exception):
    """The reason why a figure cannot be drawn, in a sentence."""


@dataclass(frozen=True)
class Picture:
    """A figure of an answer, made when it is drawn.

    compose: "module:function", which makes the figure of the arguments `of` in a style, or raises NoPicture.
    name: name of the files, without suffixes. description: kept in the files, the answer in a line unless
    given. formats: RASTER for a picture that is mostly an image, FILM if `compose` writes the files itself,
    without a style.
    """

    name: str
    compose: str
    of: tuple[Any, ...] = field(repr=False)
    description: str = ""
    formats: tuple[str, ...] = ("svg", "png", "pdf")
    style: FigureStyle = PLAIN

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of the files."""
        return tuple(f"{self.name}.{suffix}" for suffix in self.formats)

    def figure(self) -> Figure:
        """Compose the figure. Raises NoPicture."""
        from matplotlib import rc_context

        from sheetbench.answers.style import STYLE

        with rc_context(STYLE):
            figure: Figure = resolve_name(self.compose)(*self.of, self.style)
        figure.__dict__["_repr_png_"] = partial(notebook.png, figure)  # for notebooks
        return figure

    @property
    def moves(self) -> bool:
        """Return whether the picture is an animation, which is written to a file and not displayed."""
        return self.formats == FILM

    def _repr_png_(self) -> bytes | None:
        """Return the figure for a notebook, None if it cannot be drawn."""
        try:
            return None if self.moves else notebook.png(self.figure())
        except NoPicture:
            return None

    def write(self, folder: Path) -> str | None:
        """Write the files into a folder; return the reason if the picture cannot be drawn, else None."""
        from sheetbench.answers.style import save

        paths = [folder / name for name in self.names]
        try:
            if self.moves:
                resolve_name(self.compose)(*self.of, paths)
            else:
                save(self.figure(), paths, self.description)
        except NoPicture as why:
            return str(why)
        return None

    def with_styles(self, styles: Sequence[FigureStyle]) -> tuple[Picture, ...]:
        """Return the picture in each of the styles, and in the style's formats if it names some."""
        if self.moves:
            return (self,)
        return tuple(replace(self, style=one, formats=one.formats or self.formats) for one in styles)


def drawn_from(tables: Iterable[Table]) -> str:
    """Return a digest of tables' numbers, sixteen digits, which a picture's description contains. Numbers are
    rounded to a thousandth of the largest in their column."""

    def rounded(column: tuple[Any, ...]) -> list[float]:
        numbers = [one for one in column if isinstance(one, float) and isfinite(one)]
        largest = max(map(abs, numbers), default=0.0) or 1.0
        return [round(one / largest, 3) + 0.0 for one in numbers]

    return f"rows {digest(str([rounded(one) for table in tables for one in zip(*table.rows, strict=True)]))}"


@dataclass(frozen=True, repr=False)
class Report:
    """The answer to a question, ready to be shown.

    name: name of the document's file; page: name of the Markdown file, `name` unless given. title, subtitle,
    lead: the subject, and a further line. result: the answer in a line. tables: the tables in the files, in
    CSV too if they have names; printed: the tables on a terminal in place of them. notes: remarks under the
    tables, of which a terminal shows `notes_shown` without --verbose. complaints: sentences on failures.
    document: the JSON document. attachments: writers of further files by the files' names. settings: for the
    manifest. succeeded: whether the question has its answer.
    """

    name: str
    title: str
    document: Mapping[str, Any]
    subtitle: str = ""
    lead: str = ""
    result: str = ""
    page: str = ""
    tables: tuple[Table, ...] = ()
    printed: tuple[Table, ...] | None = None
    notes: tuple[str, ...] = ()
    notes_shown: int = 3
    complaints: tuple[str, ...] = ()
    pictures: tuple[Picture, ...] = ()
    attachments: Mapping[str, Write] = field(default_factory=dict)
    settings: Mapping[str, Any] = field(default_factory=dict)
    succeeded: bool = True

    @property
    def shown(self) -> tuple[Table, ...]:
        """Return the tables for a terminal."""
        return self.tables if self.printed is None else self.printed

    def save(self, folder: Path | str, figure: str | None = None) -> tuple[str, ...]:
        """Write every file and picture into a folder; return sentences on missing pictures.

        figure: pictures for a paper, in the words of `--figure`: "pdf", "svg:single,png". Raises BadInput.
        """
        styled, target = self.with_styles(parse_figure(figure)), made(folder, "folder")
        for name, write in styled.files().items():
            write(target / name)
        missing = (picture.write(target) for picture in styled.pictures)
        return tuple(why for why in missing if why)

    def with_styles(self, styles: Sequence[FigureStyle]) -> Report:
        """Return the report with its pictures in each of the styles."""
        pictures = tuple(one for picture in self.pictures for one in picture.with_styles(styles))
        return replace(self, pictures=pictures)

    def __repr__(self) -> str:
        return self.text()

    def _repr_mimebundle_(self, **kinds: Any) -> dict[str, Any]:
        """Return tables and picture for a notebook."""
        return notebook.bundle(self)

    def text(self, most: int | None = None) -> str:
        """Return title, tables and complaints as text; most: the largest number of rows of a table."""
        from sheetbench.answers.layout import text

        title = terminal("  ".join(filter(None, [self.title, self.subtitle])))
        tables = (text(table, most) for table in self.shown)
        return "\n".join([title, "", *tables, *map(terminal, self.complaints)]).rstrip()

    def files(self, made_with: str = "") -> dict[str, Write]:
        """Return the writers of all files but the pictures, by the files' names. made_with: a line under the
        page."""
        page = self.page or self.name
        texts = {f"{self.name}.json": to_json(self.document)}
        texts |= {f"{table.name}.csv": table.to_csv() for table in self.tables if table.name}
        if self.tables:
            texts |= {f"{page}.md": self.to_markdown(made_with)}
        return {**self.attachments, **{name: partial(write_text, text=text) for name, text in texts.items()}}

    def to_markdown(self, made_with: str = "") -> str:
        """Return a page with all tables, notes and complaints. A table with a text is followed by the picture
        of the table's name."""
        drawn = {picture.name: picture.names[0] for picture in self.pictures}
        parts = [f"# {markdown(self.title)}\n"]
        parts += [f"{markdown(line)}\n" for line in (self.subtitle, self.lead) if line]
        for table in self.tables:
            section = table.text and table.name in drawn
            if section:
                parts.append(f"## {markdown(table.name)}\n")
            if table.text:
                parts.append(f"{html(table.text).rstrip()}\n")
            if section:
                parts.append(f"![{markdown(table.caption)}]({drawn[table.name]})\n")
            parts.append(table.to_markdown())
        parts += [f"{markdown(line)}\n" for line in self.notes]
        parts += [f"- {markdown(line)}\n" for line in self.complaints]
        return "\n".join([*parts, f"{made_with}\n"] if made_with else parts)

    def words(self) -> dict[str, Any]:
        """Return texts, headings of tables and names of pictures, ready for JSON. They complete the files:
        rows are included for tables without a file."""
        own = ("title", "subtitle", "lead", "result", "notes", "complaints")
        return {
            **{name: getattr(self, name) for name in own},
            "document": f"{self.name}.json",
            "tables": [table.words() for table in self.tables],
            "pictures": [list(picture.names) for picture in self.pictures],
            "met": self.succeeded,
        }
