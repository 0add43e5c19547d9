"""The references against published values: the answer of `sheetbench verify`."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import groupby
from typing import Annotated, Any

from fem_reference.verification import CASES, Row, run, strain_laws
from fem_reference.verification.locking import MODELS
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import NUMBER, PERCENT, Table, number
from sheetbench.choices import STRAIN_LAWS

LAWS = "strain-laws"
FIELDS = ("case", "quantity", "computed", "passed", "mesh", "published", "relative", "held_to", "source")


@dataclass(frozen=True)
class LawForce:
    """Force of every law of strain over that of Hooke's, at a stretch."""

    pulled: str
    stretch: Annotated[float, PERCENT("g")]
    force: Annotated[dict[str, float], NUMBER(".4f")]


@dataclass(frozen=True, repr=False)
class Verification(Answer):
    """Rows of expected and computed values; locking sweeps have a picture, the laws of strain a table."""

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
        return [Table.of(Row, self.rows, caption, "verification", fields=FIELDS), *self._laws()]

    def printed(self) -> list[Table]:
        return [*self.by_case(), *self._laws()]

    def by_case(self) -> Iterator[Table]:
        """Return a table for every case, with what it is; a column names the mesh where there are several."""
        for case, of_case in groupby(self.rows, key=lambda row: row.case):
            rows = list(of_case)
            meshes = {row.mesh for row in rows}
            title = f"{case}: {CASES[case].title}" + (f"; {rows[0].mesh}" if len(meshes) == 1 else "")
            details = ("case", "mesh") if len(meshes) == 1 else ("case",)
            yield Table.of(Row, rows, title, "verification", fields=FIELDS, details=details)

    def _laws(self) -> list[Table]:
        if not any(row.case == LAWS for row in self.rows):
            return []
        poisson = strain_laws.MATERIAL.poisson
        hooke = {"one way": 1.0, "both ways": 1.0 / (1.0 - poisson)}
        rows = [
            LawForce(
                way,
                strain,
                {law: strain_laws.stress(law, way, strain) / (strain * hooke[way]) for law in STRAIN_LAWS},
            )
            for way in strain_laws.WAYS
            for strain in (0.001, 0.003, 0.01, 0.03, 0.1)
        ]
        caption = f"Force at a stretch over that of Hooke's law, ν = {poisson:g}"
        return [Table.of(LawForce, rows, caption, "laws", grouped=True)]

    def notes(self) -> tuple[str, ...]:
        return (f"{len(self.rows) - len(self.failed)} of {len(self.rows)} rows pass",)

    def complaints(self) -> list[str]:
        return [
            f"{row.case}: {row.quantity}: {number(row.computed)} instead of {number(row.published)}"
            for row in self.failed
        ]

    def figures(self) -> tuple[Picture, ...]:
        rows = [row for row in self.rows if row.case in MODELS]
        compose = "fem_reference.verification.locking_figure:compose"
        return (Picture("locking", compose, (rows,), formats=("png",)),) if rows else ()


def verify(case: Sequence[str] | str | None = None) -> Verification:
    """Check the references against published values, all cases unless some are named.

    The answer's `succeeded` says whether all pass. Raises BadInput for a case that does not exist.
    """
    return Verification(list(run([case] if isinstance(case, str) else case)))
