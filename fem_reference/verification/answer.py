"""The references against published values: the answer of `sheetbench verify`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from typing import Any

from fem_reference.verification import CASES, Row, run
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import Table, number

FIELDS = ("case", "quantity", "computed", "passed", "mesh", "published", "relative", "held_to", "source")


@dataclass(frozen=True, repr=False)
class Verification(Answer):
    """Rows of expected and computed values."""

    rows: Sequence[Row]

    file_name = "verification"

    @property
    def failed(self) -> list[Row]:
        """Rows off by more than their tolerance."""
        return [row for row in self.rows if not row.passed]

    @property
    def succeeded(self) -> bool:
        return not self.failed

    def heading(self) -> tuple[str, str, str]:
        return "verify", "the references against published and exact values", ""

    def document(self) -> dict[str, Any]:
        return {"rows": [asdict(row) for row in self.rows]}

    def tables(self) -> list[Table]:
        caption = "References against published and exact values"
        return [Table.of(Row, self.rows, caption, "verification", fields=FIELDS)]

    def printed(self) -> list[Table]:
        return [*self.by_case()]

    def by_case(self) -> Iterator[Table]:
        """Return a table for every case, with what it is; a column names the mesh where there are several."""
        for case, of_case in groupby(self.rows, key=lambda row: row.case):
            rows = list(of_case)
            meshes = {row.mesh for row in rows}
            title = f"{case}: {CASES[case].title}" + (f"; {rows[0].mesh}" if len(meshes) == 1 else "")
            details = ("case", "mesh") if len(meshes) == 1 else ("case",)
            yield Table.of(Row, rows, title, "verification", fields=FIELDS, details=details)

    def notes(self) -> tuple[str, ...]:
        return (f"{len(self.rows) - len(self.failed)} of {len(self.rows)} rows pass",)

    def complaints(self) -> list[str]:
        return [
            f"{row.case}: {row.quantity}: {number(row.computed)} instead of {number(row.published)}"
            for row in self.failed
        ]


def verify(case: Sequence[str] | str | None = None) -> Verification:
    """Check the references against published values, all cases unless some are named.

    The answer's `succeeded` says whether all pass. Raises BadInput for a case that does not exist.
    """
    return Verification(list(run([case] if isinstance(case, str) else case)))
