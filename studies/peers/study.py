"""Both questions in one run."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Annotated, Any

from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, Table
from studies.peers import settling, statics
from studies.peers.row import PeerRow, faster

QUESTIONS = {"statics": statics.rows, "settling": settling.rows}
TEXTS = {
    "statics": (
        "The sheet of Habibi et al. (reproduction.md), two adjacent edges clamped, under its own weight. "
        "Error at the probes, of the largest displacement, against the shell on 32 × 32 elements; "
        "time of the solve alone, warm, on one thread, of CalculiX as a whole program."
    ),
    "settling": (
        "Two seconds of the same sheet on 9 × 9 × 2 masses after its weight comes on. The far corner's error "
        "over all samples against BDF at a tolerance of 1e-6. Every row solves the same equations of motion, "
        "SciPy with the lattice's compiled right-hand side and sparse Jacobian."
    ),
}
NOTES = (
    "ours is faster: a peer's time over that of the fastest of ours with no larger an error.",
    "Left out: MATLAB's and Octave's ode15s, which would need the lattice written again in their language; "
    "dismech-newton, which was not tried.",
)


@dataclass(frozen=True)
class PeerLine:
    """A code and size as a table has them; faster: how many times as long as the fastest of ours."""

    code: Annotated[str, Column(prose=True)]
    size: str
    error: Annotated[float | None, PERCENT("z.3f")]
    median: Annotated[float | None, MILLISECONDS(".4g", "time")]
    faster: Annotated[float | None, NUMBER(".3g", "ours is faster")]
    status: Annotated[str, Column(prose=True)]


@dataclass(frozen=True, repr=False)
class Peers(Answer):
    """What was measured of ours and of other people's codes."""

    rows: Sequence[PeerRow]

    file_name = "peers"

    def heading(self) -> tuple[str, str, str]:
        return "Ours and other people's codes", "error and time on Habibi et al.'s sheet, in one run", ""

    def document(self) -> dict[str, Any]:
        return {
            "rows": [
                {**asdict(row), "median": row.median, "faster": faster(row, self.rows)} for row in self.rows
            ]
        }

    def tables(self) -> list[Table]:
        return [self._table(question) for question in dict.fromkeys(row.question for row in self.rows)]

    def _table(self, question: str) -> Table:
        rows = [
            PeerLine(row.code, row.size, row.error, row.median, faster(row, self.rows), row.status)
            for row in self.rows
            if row.question == question
        ]
        caption = f"{question.capitalize()} of Habibi et al.'s sheet"
        return Table.of(PeerLine, rows, caption, question, text=TEXTS[question])

    def notes(self) -> tuple[str, ...]:
        return NOTES

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("peers", "studies.peers.figure:compose", (self.rows,)),)


def study(questions: Sequence[str], say: Callable[[str], None]) -> Peers:
    """Measure, one after the other; say: called with what is being measured."""
    return Peers([row for name in questions for row in QUESTIONS[name](say)])
