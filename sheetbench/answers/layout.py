"""Layout of a table as lines of text within a width; no number or word is cut off.

Headings and prose are broken over lines at spaces. A table that is still too wide is split into blocks one
under the other, each with the columns that name the rows first. Only a word longer than the width is broken.
"""

from dataclasses import dataclass, replace
from io import StringIO
from itertools import pairwise
from shutil import get_terminal_size
from textwrap import wrap

from rich.box import Box
from rich.cells import cell_len
from rich.console import Console
from rich.table import Table as Layout
from rich.text import Text

from sheetbench.answers.escape import terminal
from sheetbench.answers.table import Column, Table

GAP, RULE = 2, "─"  # blanks between columns; the line under headings and between groups
PROSE = 24  # characters: least width of a column of prose
LEAST, UNBOUNDED = 20, 10_000  # characters of a line: least width, and width without a terminal
BOX = Box("\n".join(["    ", "    ", 4 * RULE, "    ", 4 * RULE, "    ", "    ", "    "]) + "\n")


@dataclass(frozen=True)
class Block:
    """Columns side by side: lines of headings, a rule as wide as they are, and lines of rows."""

    head: list[str]
    rule: str
    rows: list[str]


@dataclass(frozen=True)
class _TextColumn:
    """A column with its name, unit and cells as text."""

    column: Column
    name: str
    unit: str
    cells: list[str]

    @property
    def narrow(self) -> int:
        """Return the width at which every number and word is whole, and prose has its least width."""
        most = PROSE if self.column.prose else UNBOUNDED
        words = [word for text in (self.name, *self.cells) for word in text.split()]
        return max(*map(cell_len, [*words, self.unit]), *(min(cell_len(c), most) for c in self.cells))

    @property
    def wide(self) -> int:
        """Return the width at which the name fits in one line too."""
        return max(self.narrow, cell_len(self.name))

    def head(self, width: int) -> list[str]:
        """Return the name, broken to a width, over the unit."""
        lines = wrap(self.name, width, break_long_words=False)
        return [*lines, self.unit] if self.unit else lines


def blocks(table: Table, width: int | None) -> list[Block]:
    """Return the table without its details, in blocks of at most `width` characters, or in one (None)."""
    width = width and max(width, LEAST)
    shown = [[terminal(text) for text in row] for row in table.shown_rows()]
    strips = []
    for i, column in enumerate(table.columns):
        if not column.detail:
            name, unit = map(terminal, column.heading(shown=True))
            strips.append(_TextColumn(column, name, unit, [row[i] for row in shown]))
    rows = [*zip(*(strip.cells for strip in strips), strict=True)]
    if table.grouped and _fits(strips, width):
        firsts = strips[0].cells
        firsts[1:] = ["" if before == text else text for before, text in pairwise(firsts)]
    naming = next((i for i, one in enumerate(strips) if one.column.numeric or one.column.prose), 1)
    while naming < len(strips) - 1 and len({row[:naming] for row in rows}) < len(rows):
        naming += 1
    return [_block(part, width) for part in _split(strips, max(naming, 1), width)]


def text(table: Table, most: int | None = None) -> str:
    """Return the table with its caption as text as wide as the terminal; most: the number of rows shown."""
    width = get_terminal_size((100, 24)).columns
    left_out = len(table.rows[most:]) if most else 0
    table = replace(table, rows=table.rows[:most])
    lines = [line for block in blocks(table, width) for line in (*block.head, block.rule, *block.rows, "")]
    more = [f"… and {left_out} more {'row' if left_out == 1 else 'rows'}", ""] if left_out else []
    return "\n".join([terminal(table.caption), *lines[: -1 if more else None], *more])


def _fits(strips: list[_TextColumn], width: int | None, whole: bool = False) -> bool:
    """Return whether the columns fit side by side; whole: with their names in one line."""
    widths = (strip.wide if whole else strip.narrow for strip in strips)
    return width is None or sum(widths) + GAP * (len(strips) - 1) <= width


def _split(strips: list[_TextColumn], naming: int, width: int | None) -> list[list[_TextColumn]]:
    """Return the columns in as few blocks as the width allows, each with the first `naming` columns."""
    if _fits(strips, width):
        return [strips]
    while naming > 1 and not _fits(strips[:naming], 2 * (width or 0) // 3):
        naming -= 1
    keys, parts = strips[:naming], list[list[_TextColumn]]()
    for strip in strips[naming:]:
        if parts and _fits([*parts[-1], strip], width):
            parts[-1].append(strip)
        else:
            parts.append([*keys, strip])
    return parts or [keys]


def _block(strips: list[_TextColumn], width: int | None) -> Block:
    fits, whole_names = _fits(strips, width), _fits(strips, width, whole=True)
    layout = Layout(box=BOX, show_edge=False, pad_edge=False, padding=(0, GAP - 1, 0, 0))
    for strip in strips:
        head = strip.head(strip.wide if whole_names else strip.narrow)
        whole = strip.column.numeric or (fits and not strip.column.prose)
        layout.add_column(
            Text("\n".join(head)), overflow="fold", no_wrap=whole,
            justify="right" if strip.column.numeric else "left",
        )  # fmt: skip
    for row in zip(*(strip.cells for strip in strips), strict=True):
        layout.add_row(*map(Text, row))
    plain = dict(color_system=None, legacy_windows=False, force_jupyter=False)
    console = Console(file=StringIO(), width=width or UNBOUNDED, **plain)  # type: ignore[arg-type]
    console.print(layout)
    lines = [line.rstrip() for line in console.file.getvalue().splitlines()]  # type: ignore[attr-defined]
    rule = next(i for i, line in enumerate(lines) if set(line) == {RULE})
    return Block(lines[:rule], lines[rule], lines[rule + 1 :])
