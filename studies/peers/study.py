"""Both questions in one run, as a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict

from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table
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


def study(questions: Sequence[str], say: Callable[[str], None]) -> Report:
    """Measure, one after the other, and show; say: told what is being measured."""
    return report([row for name in questions for row in QUESTIONS[name](say)])


def report(rows: Sequence[PeerRow]) -> Report:
    """What is shown of rows."""
    questions = list(dict.fromkeys(row.question for row in rows))
    documents = [{**asdict(row), "median": row.median, "faster": faster(row, rows)} for row in rows]
    return Report(
        name="peers",
        title="Ours and other people's codes",
        subtitle="error and time on Habibi et al.'s sheet, in one run",
        document={"rows": documents},
        tables=tuple(table(name, rows) for name in questions),
        notes=NOTES,
        pictures=(Picture("peers", "studies.peers.figure:compose", (rows,)),),
    )


def table(question: str, rows: Sequence[PeerRow]) -> Table:
    """A row per code and size."""
    columns = (
        Column("code", prose=True),
        Column("size"),
        Column("error", "", "%", 100.0, "z.3f"),
        Column("time", "s", "ms", 1e3, ".4g"),
        Column("ours is faster", form=".3g"),
        Column("status", prose=True),
    )
    kept = [row for row in rows if row.question == question]
    shown = tuple((r.code, r.size, r.error, r.median, faster(r, kept), r.status) for r in kept)
    caption = f"{question.capitalize()} of Habibi et al.'s sheet"
    return Table(caption, columns, shown, question, text=TEXTS[question])
