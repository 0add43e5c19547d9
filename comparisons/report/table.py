"""Tables: columns with units, rows of plain values, and the ways to write them.

Values are kept in SI units. CSV has them as they are, with the unit in the header; Markdown, LaTeX and the
terminal show them scaled and rounded (a displacement in mm, a time in ms).
"""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Column:
    """A column's name, the SI unit of its values, and how to show them: unit, scale and format.

    Numbers have a format; prose may be broken over lines.
    """

    name: str
    unit: str = ""
    shown_unit: str = ""
    scale: float = 1.0
    form: str = ""
    prose: bool = False

    @property
    def numeric(self) -> bool:
        """Whether the values are numbers, to be set flush right."""
        return bool(self.form)

    def header(self, shown: bool) -> str:
        """The name with its unit in brackets."""
        unit = self.shown_unit if shown else self.unit
        return f"{self.name} [{unit}]" if unit else self.name

    def show(self, value: Any) -> str:
        """A value as people read it; a dash where there is none."""
        if value is None or value != value:
            return "–"
        if not self.numeric:
            return str(value)
        scaled = value if self.form.endswith("d") else value * self.scale
        return format(scaled, self.form).replace("-", "−")


@dataclass(frozen=True)
class Table:
    """A caption, columns, and rows of as many values [SI] as there are columns."""

    caption: str
    columns: tuple[Column, ...]
    rows: tuple[tuple[Any, ...], ...]

    def to_csv(self) -> str:
        """All digits in SI units; an empty cell where there is no value."""
        text = io.StringIO()
        writer = csv.writer(text, lineterminator="\n")
        writer.writerow(column.header(shown=False) for column in self.columns)
        writer.writerows(self.rows)
        return text.getvalue()

    def to_markdown(self) -> str:
        """A pipe table with shown units, its caption above it."""
        headers = [column.header(shown=True) for column in self.columns]
        rules = ["---:" if column.numeric else "---" for column in self.columns]
        lines = [headers, rules, *self.shown_rows()]
        return f"{self.caption}\n\n" + "".join(f"| {' | '.join(line)} |\n" for line in lines)

    def to_latex(self) -> str:
        """A booktabs tabular with shown units, its caption as a comment above it."""
        headers = [column.header(shown=True) for column in self.columns]
        kinds = "".join("r" if column.numeric else "l" for column in self.columns)
        lines = [" & ".join(_latex(cell) for cell in line) + " \\\\" for line in self.shown_rows()]
        return "\n".join(
            [
                f"% {self.caption}",
                f"\\begin{{tabular}}{{{kinds}}}",
                "\\toprule",
                " & ".join(_latex(header) for header in headers) + " \\\\",
                "\\midrule",
                *lines,
                "\\bottomrule",
                "\\end{tabular}",
                "",
            ]
        )

    def shown_rows(self) -> list[list[str]]:
        """The rows as people read them."""
        return [[c.show(value) for c, value in zip(self.columns, row, strict=True)] for row in self.rows]


_LATEX = {
    "\\": r"\textbackslash{}",
    "−": "$-$",
    "–": "--",
    "×": r"$\times$",
    "ν": r"$\nu$",
    "≥": r"$\ge$",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    **{character: f"\\{character}" for character in "&%$#_{}"},
}


def _latex(text: str) -> str:
    """Text with what LaTeX reads as its own made plain."""
    return "".join(_LATEX.get(character, character) for character in text)
