"""Columns of numbers from a CSV file as spreadsheets, cameras, testing machines and numpy write them.

The header is the first line with the names of two of the requested columns, in any order and case; lines
above it are skipped. A name may have several words, and a unit may follow it in brackets, as in "uz [mm]", or
stand below it in a row of units; numbers without a unit are in SI units, others are converted to them. Lines
that begin with # are comments. Cells are separated by commas, semicolons or tabs, whichever the header has;
where commas do not separate they may be decimal commas, as long as no number has a point. An empty cell, or
NaN, is a number that was not measured.
"""

import csv
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import isfinite, nan
from pathlib import Path

import numpy as np

from sheetbench.errors import BadInput, foreign
from sheetbench.scenes.language.reading import read_text
from sheetbench.scenes.language.units import quantity
from sheetbench.scenes.objects.quantities import LARGEST

LARGEST_FILE = 2**28  # bytes
SEPARATORS = ";\t,"
MOTION = {"time": "s", "seconds": "s", **dict.fromkeys(("x", "y", "z", "ux", "uy", "uz", "sd"), "m")}
_COMMA, _POINT = (re.compile(rf"[+-]?(\d+{mark}\d*|{mark}\d+)([eE][+-]?\d+)?") for mark in (",", r"\."))
_NUMBER = re.compile(r"[+-]?[\d.,]+([eE][+-]?\d+)?")
_CELL, _HEADED = re.compile(rf"[^{SEPARATORS}]+"), re.compile(r"(.*?)\s*(?:[\[(]([^\])]*)[\])])?")
_SHOWN = 40  # characters of a cell that a refusal repeats


@dataclass(frozen=True)
class Row:
    """A line of a file: `where` is its name in a message, `cells` its text by column, `scales` the SI units
    per unit of a column's numbers."""

    where: str
    cells: dict[str, str]
    scales: dict[str, float]
    decimal_comma: bool = False

    def number(self, name: str) -> float:
        """Return the finite number in a column. Raises BadInput where there is none."""
        value = self.measured(name)
        if value != value:
            raise self.refused(name, "a number is needed")
        return value

    def measured(self, name: str) -> float:
        """Return the number in a column, nan where not measured. Raises BadInput for any other text."""
        text = self.cells[name]
        if text.lower() in ("", "nan"):
            return nan
        plain = text.replace(",", ".") if self.decimal_comma else text
        try:
            value = float(plain) * self.scales[name] if "_" not in plain else nan
        except ValueError:
            value = nan
        if not isfinite(value):
            raise self.refused(name, "not a number")
        if abs(value) > LARGEST:
            raise self.refused(name, f"must be {LARGEST:g} or less in magnitude")
        return value

    def refused(self, name: str, why: str) -> BadInput:
        """Return the error for a cell."""
        text = self.cells[name]
        shown = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}…"
        return BadInput(f"{self.where}: {name} = '{shown}': {why}")


@dataclass(frozen=True)
class Columns:
    """Names of the columns, and the rows."""

    names: tuple[str, ...]
    rows: tuple[Row, ...]

    def numbers(self, name: str) -> np.ndarray:
        """Return the numbers (n,) in a column. Raises BadInput where there is none."""
        return np.array([row.number(name) for row in self.rows])


def read_columns(path: Path, units: Mapping[str, str] = MOTION) -> Columns:
    """Return the columns of a file; units: requested columns by name, with their SI units.

    Raises BadInput naming the file, the line and the fault."""
    try:
        lines = read_text(path, LARGEST_FILE).splitlines()
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise BadInput(f"{path}: not a text file in UTF-8") from None
    entries = [(i, line) for i, line in enumerate(lines, 1) if line.strip()[:1] not in ("", "#")]
    if not entries:
        return Columns((), ())
    matches = (len({_split_unit(c)[0] for c in _CELL.findall(line)} & units.keys()) for _, line in entries)
    entries = entries[next((index for index, matching in enumerate(matches) if matching > 1), 0) :]
    separator = next((mark for mark in SEPARATORS if mark in entries[0][1]), ",")
    (_, header), *body = _parse_lines(path, entries, separator)
    if body and (merged := _merge_units(header, body[0][1], units)) is not None:
        header, body = merged, body[1:]
    quantities = [_read_heading(path, cell, units) for cell in header]
    names, scales = tuple(name for name, _ in quantities), dict(quantities)
    duplicates = [name for name in names if name and names.count(name) > 1]
    if duplicates:
        raise BadInput(f"{path}: column {duplicates[0]} is there twice")
    comma = separator != "," and _uses_decimal_commas(path, body)
    rows = []
    for i, cells in body:
        padded = [cell.strip() for cell in cells] + [""] * (len(names) - len(cells))
        if any(padded):
            rows.append(Row(f"{path}, line {i}", dict(zip(names, padded, strict=False)), scales, comma))
    return Columns(names, tuple(rows))


def _parse_lines(path: Path, lines: list[tuple[int, str]], separator: str) -> Iterator[tuple[int, list[str]]]:
    """Return the cells of every line, with the line's number in the file."""
    reader = csv.reader((line for _, line in lines), delimiter=separator, skipinitialspace=True)
    while True:
        try:
            cells = next(reader)
        except StopIteration:
            return
        except csv.Error as error:
            raise BadInput(f"{path}, line {lines[reader.line_num - 1][0]}: {foreign(error)}") from None
        yield lines[reader.line_num - 1][0], cells


def _split_unit(cell: str) -> tuple[str, str]:
    match = _HEADED.fullmatch(cell.strip(' "'))
    name, unit = (match[1], match[2] or "") if match else (cell.strip(), "")
    return "_".join(name.lower().split()), unit.strip().removeprefix("-")  # [-] of a pure number


def _merge_units(header: list[str], row: list[str], units: Mapping[str, str]) -> list[str] | None:
    """Return the header with the units of the row below it, None if that is no row of units: a unit in
    brackets, or a unit of the column's quantity, in every nonempty cell of a requested column."""
    merged, has_unit = list(header), False
    for column, (title, cell) in enumerate(zip(header, map(str.strip, row), strict=False)):
        name, own_unit = _split_unit(title)
        if not cell or name not in units:
            continue
        unit = _split_unit(cell)[1] if _split_unit(cell)[0] == "" else cell
        if unit == cell and not _is_unit(unit, units[name]):
            return None
        merged[column], has_unit = title if own_unit else f"{name} [{unit}]", True
    return merged if has_unit else None


def _is_unit(text: str, si: str) -> bool:
    """Return whether a text is a unit of an SI unit's quantity; "-" is the unit of pure numbers."""
    if text == "-":
        return not si
    try:
        quantity(f"1 {text}", si)
    except BadInput:
        return False
    return not _NUMBER.fullmatch(text)


def _read_heading(path: Path, cell: str, units: Mapping[str, str]) -> tuple[str, float]:
    """Return a column's name, and the SI units per unit of its numbers."""
    name, unit = _split_unit(cell)
    if not unit or name not in units:
        return name, 1.0
    try:
        return name, quantity(f"1 {unit}", units[name])
    except BadInput as error:
        raise BadInput(f"{path}: column {foreign(cell)}: {error}") from None


def _uses_decimal_commas(path: Path, body: list[tuple[int, list[str]]]) -> bool:
    """Return whether numbers have commas. Raises BadInput where some have commas and others points."""
    commas = points = None
    for number, cells in body:
        for cell in map(str.strip, cells):
            commas = commas or (number if _COMMA.fullmatch(cell) else None)
            points = points or (number if _POINT.fullmatch(cell) else None)
    if commas and points:
        raise BadInput(
            f"{path}: decimal commas (line {commas}) and decimal points (line {points}): which is meant?"
        )
    return commas is not None
