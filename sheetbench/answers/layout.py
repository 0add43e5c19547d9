"""A table as lines of text within a width: every figure and every status whole, however narrow that is.

A table that is too wide first breaks its headings and its prose over lines, at spaces. Where that is not
enough, columns that may stand apart go, the last one first, on lines of their own over the rows that share
them. Where there are none, or still no room, the columns are stacked in blocks, each led by the columns that
name the rows. Only a word longer than the width itself is broken, and goes on in the next line: nothing is
ever cut off.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain

from rich.cells import cell_len

from sheetbench.answers.escape import terminal
from sheetbench.answers.table import Column, Table

GAP = 2  # blanks between columns
PROSE = 24  # a narrower column of prose is no pleasure to read


@dataclass(frozen=True)
class Block:
    """Columns that stand side by side: heading lines, a rule as wide as they are, and lines of rows."""

    head: list[str]
    rule: str
    rows: list[str]


@dataclass(frozen=True)
class _Strip:
    """A column with its name, unit and cells as text, and the widths that it may have."""

    column: Column
    name: str
    unit: str
    cells: list[str]

    @property
    def wide(self) -> int:
        """Width without a broken line."""
        return max(map(cell_len, [*self.cells, self.name, self.unit]))

    @property
    def narrow(self) -> int:
        """The least width at which every number and word is whole."""
        words = chain(self.name.split(), *(c.split() for c in self.cells if self.column.prose))
        whole = [] if self.column.prose else self.cells
        return max(map(cell_len, [*whole, *words, self.unit]))

    @property
    def pleasant(self) -> int:
        """The width below which columns are stacked rather than prose squeezed."""
        return max(self.narrow, min(self.wide, PROSE)) if self.column.prose else self.narrow


def blocks(table: Table, width: int | None, say: Callable[[str], str] = terminal) -> list[Block]:
    """The table without its details, in blocks of at most `width` columns of text; without one, in one.

    say: what makes a text fit to be shown, before it is laid out.
    """
    brief = table.brief()
    shown = [[say(text) for text in row] for row in brief.shown_rows()]
    naming = _naming(brief.columns, shown)
    starts = [i == 0 or not table.grouped or shown[i][0] != shown[i - 1][0] for i in range(len(shown))]
    for row, start in zip(shown, starts, strict=True):
        if not start:
            row[0] = ""
    strips = [
        _Strip(
            column,
            say(column.name),
            say(f"[{column.shown_unit}]") if column.shown_unit else "",
            [row[i] for row in shown],
        )
        for i, column in enumerate(brief.columns)
    ]
    ruled = [table.grouped and start and i > 0 for i, start in enumerate(starts)]
    apart, rest = _set_apart(strips, width)
    if apart and width is not None:
        return [_over(apart, rest, width, ruled)]
    return [_block(part, _widths(part, width), ruled) for part in _stacked(strips, naming, width)]


def _set_apart(strips: list[_Strip], width: int | None) -> tuple[list[_Strip], list[_Strip]]:
    """The columns that are to stand apart for the others to fit into the width, and the others."""
    apart, rest = list[_Strip](), strips
    while width is not None and _total(strip.pleasant for strip in rest) > width - (GAP if apart else 0):
        last = next((strip for strip in reversed(rest) if strip.column.apart), None)
        if last is None or len(rest) == 1:
            return [], strips
        apart, rest = [last, *apart], [strip for strip in rest if strip is not last]
    return apart, rest


def _naming(columns: Sequence[Column], rows: list[list[str]]) -> int:
    """How many columns name a row: those before the first figure, and more until no two rows are alike."""
    count = next((i for i, column in enumerate(columns) if column.numeric or column.prose), 1)
    while count < len(columns) - 1 and len({tuple(row[:count]) for row in rows}) < len(rows):
        count += 1
    return max(count, 1)


def _stacked(strips: list[_Strip], count: int, width: int | None) -> list[list[_Strip]]:
    """The columns in as few blocks as the width allows, the `count` naming columns in front of each."""
    if width is None or _total(s.pleasant for s in strips) <= width:
        return [strips]
    while count > 1 and _total(s.wide for s in strips[:count]) > width // 2:
        count -= 1
    keys, rest = strips[:count], strips[count:]
    parts: list[list[_Strip]] = []
    for strip in rest:
        if parts and _total(s.pleasant for s in [*parts[-1], strip]) <= width:
            parts[-1].append(strip)
        else:
            parts.append([*keys, strip])
    return parts or [keys]


def _total(widths: Iterable[int]) -> int:
    each = list(widths)
    return sum(each) + GAP * (len(each) - 1)


def _widths(strips: list[_Strip], width: int | None) -> list[int]:
    """The width of each column: as wide as it would be, or its least and what is left over, prose first.

    Where not even that fits, text is broken before figures are.
    """
    wide = [strip.wide for strip in strips]
    if width is None or _total(wide) <= width:
        return wide
    found = [strip.narrow for strip in strips]
    while (spare := width - _total(found)) != 0:
        if spare > 0:
            short = [i for i, n in enumerate(found) if n < wide[i]]
            if not short:
                break
            prose = [i for i in short if strips[i].column.prose]
            found[min(prose or short, key=lambda i: found[i])] += 1
        else:
            text = [i for i, n in enumerate(found) if n > 2 and not strips[i].column.numeric]
            widest = max(text or range(len(found)), key=lambda i: found[i])
            if found[widest] <= 2:
                break
            found[widest] -= 1
    return found


def _over(apart: list[_Strip], rest: list[_Strip], width: int, ruled: list[bool]) -> Block:
    """The columns that stand apart over the others, which are indented, wherever they change."""
    widths = _widths(rest, width - GAP)
    indent = " " * GAP
    leads = [" · ".join(cells) for cells in zip(*(strip.cells for strip in apart), strict=True)]
    rule, rows = "─" * (GAP + _total(widths)), list[str]()
    for i, lines in enumerate(_rows(rest, widths)):
        rows += [rule] if ruled[i] else []
        rows += wrapped(leads[i], width) if i == 0 or leads[i] != leads[i - 1] else []
        rows += [indent + line for line in lines]
    title = wrapped(" · ".join(strip.name for strip in apart), width)
    return Block([*title, *(indent + line for line in _head(rest, widths))], rule, rows)


def _block(strips: list[_Strip], widths: list[int], ruled: list[bool]) -> Block:
    rule, rows = "─" * _total(widths), list[str]()
    for i, lines in enumerate(_rows(strips, widths)):
        rows += [rule, *lines] if ruled[i] else lines
    return Block(_head(strips, widths), rule, rows)


def _rows(strips: list[_Strip], widths: list[int]) -> Iterator[list[str]]:
    """The lines of each row."""
    for cells in zip(*(strip.cells for strip in strips), strict=True):
        yield _lines(
            [wrapped(cell, width) for cell, width in zip(cells, widths, strict=True)], strips, widths
        )


def _head(strips: list[_Strip], widths: list[int]) -> list[str]:
    """The lines of the headings, names over units."""
    any_unit = any(strip.unit for strip in strips)
    heads = []
    for strip, width in zip(strips, widths, strict=True):
        lines = wrapped(strip.name, width)
        heads.append([*lines, strip.unit] if any_unit and strip.unit else lines)
    height = max(map(len, heads))
    return _lines([[""] * (height - len(head)) + head for head in heads], strips, widths)


def _lines(cells: list[list[str]], strips: list[_Strip], widths: list[int]) -> list[str]:
    """Cells of several lines side by side."""
    found = []
    for i in range(max(map(len, cells))):
        texts = [cell[i] if i < len(cell) else "" for cell in cells]
        padded = [
            " " * (width - cell_len(text)) + text
            if strip.column.numeric
            else text + " " * (width - cell_len(text))
            for text, strip, width in zip(texts, strips, widths, strict=True)
        ]
        found.append((" " * GAP).join(padded).rstrip())
    return found


def wrapped(text: str, width: int) -> list[str]:
    """The text in lines of at most `width`, broken at spaces; a longer word goes on in the next line."""
    if cell_len(text) <= width:
        return [text]
    lines, line = [], ""
    for word in text.split():
        joined = f"{line} {word}" if line else word
        if cell_len(joined) <= width:
            line = joined
            continue
        if line:
            lines.append(line)
        *whole, line = _pieces(word, width)
        lines += whole
    return [*lines, line]


def _pieces(word: str, width: int) -> list[str]:
    """A word in pieces of at most `width`, or of one character where that is wider."""
    pieces = [""]
    for character in word:
        if pieces[-1] and cell_len(pieces[-1] + character) > width:
            pieces.append("")
        pieces[-1] += character
    return pieces
