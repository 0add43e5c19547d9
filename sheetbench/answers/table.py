"""Tables: columns with units, rows of plain values, and the ways to write them.

Values are kept in SI units. CSV has them as they are, with the unit in the header; Markdown, LaTeX and the
terminal show them scaled and rounded (a displacement in mm, a time in ms). Negative numbers have a minus sign
(U+2212) there, in CSV a hyphen, as other programs read it.
"""

from __future__ import annotations

import csv
import io
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

from sheetbench.answers.escape import cell, csv_cell, html, markdown, terminal
from sheetbench.answers.latex import latex
from sheetbench.errors import BadInput

if TYPE_CHECKING:
    import pandas


class Unit(NamedTuple):
    """The unit of a row's numbers, as a cell of that row: in SI, as people read it, the factor between."""

    si: str
    shown: str
    scale: float = 1.0


_SHOWN = {unit.si: unit for unit in (Unit("Pa", "MPa", 1e-6), Unit("m", "mm", 1e3), Unit("s", "ms", 1e3))}


def unit(si: str) -> Unit:
    """A unit as a cell, shown as everywhere else: pressures in MPa, lengths in mm, times in ms."""
    return _SHOWN.get(si, Unit(si, si))


@dataclass(frozen=True)
class Column:
    """A column's name, the SI unit of its values, and how to show them: unit, scale and format.

    Numbers have a format; prose may be broken over lines. A detail is left out on terminals and in LaTeX. One
    that may stand apart does so on terminals too narrow for its table, over the rows that share it.
    """

    name: str
    unit: str = ""
    shown_unit: str = ""
    scale: float = 1.0
    form: str = ""
    prose: bool = False
    detail: bool = False
    apart: bool = False

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers, to be set flush right."""
        return bool(self.form)

    def header(self, shown: bool) -> str:
        """The name with its unit in brackets."""
        unit = self.shown_unit if shown else self.unit
        return f"{self.name} [{unit}]" if unit else self.name

    def show(self, value: Any, scale: float = 1.0) -> str:
        """A value as people read it; a dash where there is none.

        scale: that of the row's own unit, for columns that have none themselves.
        """
        if value is None or value != value:
            return "–"
        if isinstance(value, Unit):
            return value.shown
        if not self.numeric:
            return str(value)
        if self.form.endswith("d"):
            return number(value, self.form)
        return number(value * (self.scale if self.shown_unit else self.scale * scale), self.form)


def number(value: float, form: str = "g") -> str:
    """A number as people read it: with a minus sign, not a hyphen."""
    return format(value, form).replace("-", "−")


def quantity(value: float, si: str, form: str = ".4g") -> str:
    """A value in an SI unit as people read it, in the unit of `unit`."""
    shown = unit(si)
    return f"{number(value * shown.scale, form)} {shown.shown}".rstrip()


@dataclass(frozen=True, repr=False)
class Table:
    """A caption, columns, and rows of as many values [SI] as there are columns.

    name: of its CSV file. grouped: rows that share the first value stand together under it on a terminal.
    text: what is said of it, in Markdown.
    """

    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]
    name: str = ""
    grouped: bool = False
    text: str = ""

    def to_csv(self) -> str:
        """All digits in SI units; an empty cell where there is no value."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(csv_cell(column.header(shown=False)) for column in self.columns)
        for row in self.rows:
            writer.writerow(csv_cell(value.si if isinstance(value, Unit) else value) for value in row)
        return text.getvalue()

    def to_pandas(self) -> pandas.DataFrame:
        """All values in SI units as a data frame, with the unit in a column's name. Raises BadInput where
        pandas is not installed."""
        try:
            import pandas
        except ModuleNotFoundError:
            raise BadInput("to_pandas needs pandas: pip install pandas") from None
        rows = [[value.si if isinstance(value, Unit) else value for value in row] for row in self.rows]
        return pandas.DataFrame(rows, columns=[column.header(shown=False) for column in self.columns])

    def __repr__(self) -> str:
        return self.to_markdown()

    def _repr_html_(self) -> str:
        heads = "".join(f"<th>{html(column.header(shown=True))}</th>" for column in self.columns)
        rows = (
            "".join(
                f'<td style="text-align:{"right" if column.numeric else "left"}">{html(shown)}</td>'
                for column, shown in zip(self.columns, row, strict=True)
            )
            for row in self.shown_rows()
        )
        body = "".join(f"<tr>{row}</tr>" for row in rows)
        return f"<table><caption>{html(self.caption)}</caption><tr>{heads}</tr>{body}</table>"

    def to_markdown(self) -> str:
        """A pipe table with shown units, its caption above it."""
        headers = [cell(column.header(shown=True)) for column in self.columns]
        rules = ["---:" if column.numeric else "---" for column in self.columns]
        lines = [headers, rules, *([cell(shown) for shown in row] for row in self.shown_rows())]
        return f"{markdown(self.caption)}\n\n" + "".join(f"| {' | '.join(line)} |\n" for line in lines)

    def words(self) -> dict[str, Any]:
        """What the CSV file does not say, ready for JSON; where there is none, the rows too."""
        said = {"name": self.name, "caption": self.caption, "text": self.text, "grouped": self.grouped}
        units = [any(isinstance(row[i], Unit) for row in self.rows) for i in range(len(self.columns))]
        said |= {"columns": [{**asdict(c), "units": u} for c, u in zip(self.columns, units, strict=True)]}
        return said if self.name else {**said, "rows": [list(row) for row in self.rows]}

    def to_latex(self) -> str:
        """A booktabs tabular with shown units and without details, its caption as a comment above it."""
        brief = self.brief()
        headers = [latex(column.header(shown=True)) for column in brief.columns]
        kinds = "".join("r" if column.numeric else "l" for column in brief.columns)
        lines = [" & ".join(latex(shown) for shown in row) + " \\\\" for row in brief.shown_rows()]
        return "\n".join(
            [
                f"% {terminal(self.caption)}",
                f"\\begin{{tabular}}{{{kinds}}}",
                "\\toprule",
                " & ".join(headers) + " \\\\",
                "\\midrule",
                *lines,
                "\\bottomrule",
                "\\end{tabular}",
                "",
            ]
        )

    def brief(self) -> Table:
        """The table without its details."""
        kept = [i for i, column in enumerate(self.columns) if not column.detail]
        rows = tuple(tuple(row[i] for i in kept) for row in self.rows)
        columns = tuple(self.columns[i] for i in kept)
        return Table(self.caption, columns, rows, self.name, self.grouped, self.text)

    def shown_rows(self) -> list[list[str]]:
        """The rows as people read them."""
        shown = []
        for row in self.rows:
            scale = next((value.scale for value in row if isinstance(value, Unit)), 1.0)
            shown.append([c.show(value, scale) for c, value in zip(self.columns, row, strict=True)])
        return shown
