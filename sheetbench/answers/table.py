"""Tables: columns with units, rows of plain values, and the ways to write them.

A row is a dataclass whose fields carry their columns, `error: Annotated[float | None, PERCENT(".3g")]`, and
`Table.of` makes a table of rows: CSV, Markdown, pandas and a terminal's lines follow from it. Values are kept
in SI units. CSV has them unchanged, with the unit in the header; Markdown and the terminal show them scaled
and rounded (a displacement in mm, a time in ms). Negative numbers have a minus sign (U+2212) there, in CSV a
hyphen for other programs.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from dataclasses import fields as dataclass_fields
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple, get_args, get_origin, get_type_hints

import numpy as np

from sheetbench.answers.escape import cell, csv_cell, markdown
from sheetbench.answers.notebook import table_html
from sheetbench.errors import BadInput

if TYPE_CHECKING:
    import pandas


class TableUnit(NamedTuple):
    """An SI unit, the unit of display, and the factor between them. A call makes a column of numbers in the
    unit; a cell with it holds the unit of its row's numbers."""

    si: str
    shown: str
    scale: float = 1.0

    def __call__(self, form: str, name: str = "", **options: Any) -> Column:
        """Return a column of numbers in this unit; its name is the field's unless given."""
        return Column(name, self.si, self.shown, self.scale, form, **options)


NUMBER, PERCENT = TableUnit("", ""), TableUnit("", "%", 100.0)
HERTZ, NEWTONS = TableUnit("Hz", "Hz"), TableUnit("N", "N")
MILLIMETRES, MILLISECONDS, SECONDS = TableUnit("m", "mm", 1e3), TableUnit("s", "ms", 1e3), TableUnit("s", "s")
MEGAPASCALS = TableUnit("Pa", "MPa", 1e-6)
_SHOWN = {unit.si: unit for unit in (MEGAPASCALS, MILLIMETRES, MILLISECONDS)}


def unit(si: str) -> TableUnit:
    """Return a unit as a cell in its unit of display: pressures in MPa, lengths in mm, times in ms."""
    return _SHOWN.get(si, TableUnit(si, si))


@dataclass(frozen=True)
class Column:
    """A column's name, the SI unit of its values, and their unit, scale and format of display.

    Numbers have a format; prose may be broken over lines. A detail is left out on terminals. words: for true
    and false; none: for an empty list; shown_name: name of display if it differs from the CSV file's.
    """

    name: str = ""
    unit: str = ""
    shown_unit: str = ""
    scale: float = 1.0
    form: str = ""
    prose: bool = False
    detail: bool = False
    words: tuple[str, str] = ("yes", "no")
    none: str = ""
    shown_name: str = ""

    def of(self, value: Any) -> Any:
        """Return a row's value as a cell: true and false in words, a grid as 9×9×2, texts with commas."""
        if isinstance(value, bool | np.bool_):
            return self.words[not value]
        if isinstance(value, list | tuple) and not isinstance(value, TableUnit):
            whole = ("×" if all(isinstance(part, int) for part in value) else ", ").join(map(str, value))
            return whole or self.none
        return value.item() if isinstance(value, np.generic) else value

    @property
    def numeric(self) -> bool:
        """Return whether the values are numbers, to be set flush right."""
        return bool(self.form)

    def heading(self, shown: bool) -> tuple[str, str]:
        """Return the name, and the unit in brackets, "" without one; shown: for display."""
        name, unit = (self.shown_name or self.name, self.shown_unit) if shown else (self.name, self.unit)
        return name, f"[{unit}]" if unit else ""

    def header(self, shown: bool) -> str:
        """Return name and unit in a line; shown: for display."""
        return " ".join(self.heading(shown)).rstrip()

    def show(self, value: Any, scale: float = 1.0) -> str:
        """Return a value for display, a dash for None.

        scale: scale of the row's own unit, for columns without a unit.
        """
        if value is None or value != value:
            return "–"
        if isinstance(value, TableUnit):
            return value.shown
        if not self.numeric:
            return str(value)
        if self.form.endswith("d"):
            return number(value, self.form)
        return number(value * (self.scale if self.shown_unit else self.scale * scale), self.form)


@cache
def _declared(kind: type) -> dict[str, Column]:
    """Return the columns of a row's class by field and property."""
    hints = get_type_hints(kind, include_extras=True)
    declared = {field.name: hints[field.name] for field in dataclass_fields(kind)}
    for name, value in vars(kind).items():
        if isinstance(value, property):
            declared[name] = get_type_hints(value.fget, include_extras=True)["return"]
    return {name: _column(name, hint) for name, hint in declared.items()}


def _column(name: str, hint: Any) -> Column:
    declared = get_args(hint)[1:] if get_origin(hint) is Annotated else ()
    column = next((one for one in declared if isinstance(one, Column)), Column())
    return replace(column, name=column.name or name.replace("_", " "))


def number(value: float, form: str = "g") -> str:
    """Return a number for display: a minus sign, not a hyphen; no zeros behind a zero; exponents from 6."""
    shown = format(value, form if value else form.removeprefix("#"))
    if form.endswith("g") and "e+0" in shown and abs(value) < 1e6:
        shown = f"{float(shown):.0f}"
    return shown.removesuffix(".").replace("-", "−")


def quantity(value: float, si: str, form: str = ".4g") -> str:
    """Return a value in an SI unit for display, with its unit of display."""
    shown = unit(si)
    return f"{number(value * shown.scale, form)} {shown.shown}".rstrip()


def percent(fraction: float, form: str = ".2g") -> str:
    """Return a fraction for display in per cent."""
    return f"{number(100.0 * fraction, form)} %"


@dataclass(frozen=True, repr=False)
class Table:
    """A caption, columns, and rows with a value [SI] for each column.

    name: name of the CSV file. grouped: a terminal shows the common first value of following rows once.
    text: notes on the table, in Markdown.
    """

    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    name: str = ""
    grouped: bool = False
    text: str = ""

    @classmethod
    def of(
        cls, kind: type, rows: Iterable[Any], caption: str, name: str = "", *, fields: Sequence[str] = (),
        details: Sequence[str] = (), grouped: bool = False, text: str = "",
    ) -> Table:  # fmt: skip
        """Return the table of rows, dataclasses of one class, with a column for each field.

        fields: the fields and properties shown, in their order, if not all fields. A field's column is in its
        annotation; without one it holds words under the field's name. A field that holds a mapping has a
        column for each key: a name, or a Column. details: fields for the files alone.
        """
        rows, declared = list(rows), _declared(kind)
        columns: list[Column] = []
        cells: list[list[Any]] = [[] for _ in rows]
        for field in fields or (one.name for one in dataclass_fields(kind)):
            column = replace(declared[field], detail=declared[field].detail or field in details)
            of_field, values = [column], [(getattr(row, field),) for row in rows]
            if values and isinstance(values[0][0], Mapping):
                keys, values = list(values[0][0]), [tuple(value.values()) for (value,) in values]
                of_field = [k if isinstance(k, Column) else replace(column, name=str(k)) for k in keys]
            columns += of_field
            for row, parts in zip(cells, values, strict=True):
                row += [c.of(part) for c, part in zip(of_field, parts, strict=True)]
        return cls(caption, tuple(columns), tuple(map(tuple, cells)), name, grouped, text)

    @classmethod
    def listed(
        cls, caption: str, columns: Iterable[Any], rows: Iterable[Iterable[Any]], name: str = "",
        *, grouped: bool = False, text: str = "",
    ) -> Table:  # fmt: skip
        """Return the table of rows of values in the order of the columns; a text is a column of words."""
        own = tuple(Column(one) if isinstance(one, str) else one for one in columns)
        cells = (tuple(c.of(value) for c, value in zip(own, row, strict=True)) for row in rows)
        return cls(caption, own, tuple(cells), name, grouped, text)

    def to_csv(self) -> str:
        """Return the table as CSV: all digits in SI units, empty cells for None."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(csv_cell(column.header(shown=False)) for column in self.columns)
        for row in self.rows:
            writer.writerow(csv_cell(value.si if isinstance(value, TableUnit) else value) for value in row)
        return text.getvalue()

    def to_pandas(self) -> pandas.DataFrame:
        """Return all values in SI units as a data frame, with the unit in a column's name. Raises BadInput if
        pandas is not installed."""
        try:
            import pandas
        except ModuleNotFoundError:
            raise BadInput("to_pandas needs pandas: pip install pandas") from None
        rows = [[value.si if isinstance(value, TableUnit) else value for value in row] for row in self.rows]
        return pandas.DataFrame(rows, columns=[column.header(shown=False) for column in self.columns])

    def __repr__(self) -> str:
        return self.to_markdown()

    def _repr_html_(self) -> str:
        return table_html(self)

    def to_markdown(self) -> str:
        """Return a pipe table with shown units, its caption above it."""
        headers = [cell(column.header(shown=True)) for column in self.columns]
        rules = ["---:" if column.numeric else "---" for column in self.columns]
        lines = [headers, rules, *([cell(shown) for shown in row] for row in self.shown_rows())]
        return f"{markdown(self.caption)}\n\n" + "".join(f"| {' | '.join(line)} |\n" for line in lines)

    def words(self) -> dict[str, Any]:
        """Return caption, text and columns, ready for JSON, with the rows if the table has no CSV file."""
        words = {"name": self.name, "caption": self.caption, "text": self.text, "grouped": self.grouped}
        units = [any(isinstance(row[i], TableUnit) for row in self.rows) for i in range(len(self.columns))]
        words |= {"columns": [{**asdict(c), "units": u} for c, u in zip(self.columns, units, strict=True)]}
        return words if self.name else {**words, "rows": [list(row) for row in self.rows]}

    def shown_rows(self) -> list[list[str]]:
        """Return the rows for display."""
        shown = []
        for row in self.rows:
            scale = next((value.scale for value in row if isinstance(value, TableUnit)), 1.0)
            shown.append([c.show(value, scale) for c, value in zip(self.columns, row, strict=True)])
        return shown
