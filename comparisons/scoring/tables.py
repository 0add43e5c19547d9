"""What a score shows: a row a case, the place beside other models, faults in sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comparisons.scoring.reference import document
from comparisons.scoring.verdict import verdict
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table, number

if TYPE_CHECKING:
    from comparisons.scoring.score import Score

PERCENT = ("", "%", 100.0, ".3g")


def report(found: Score) -> Report:
    """What `sheetbench score` shows."""
    standing = found.standing
    return Report(
        name="score",
        title=f"score {number(100 * found.score, '.3g')} %",
        subtitle=f"on {_of(found)} of {found.suite}, reference set {document()['version']}",
        lead=verdict(found),
        document=found.as_dict(),
        tables=(cases(found), rows(found), *([place(found)] if len(standing) > 1 else [])),
        printed=(cases(found), *([place(found)] if len(standing) > 1 else [])),
        notes=(
            "score: geometric mean of the cases' errors, none below the reference's bar, none above 100 %",
            *_where(found),
            *_left(found),
        ),
        complaints=tuple(found.faults),
        pictures=(Picture("score", "comparisons.scoring.figure:compose", (found,)),),
        settings={"suite": found.suite},
        met=not found.faults,
    )


def _of(found: Score) -> str:
    many, asked = len(found.answers), len(found.answers) + len(found.unanswered)
    return "1 case" if asked == 1 else f"{many} cases" if many == asked else f"{many} of {asked} cases"


def _left(found: Score) -> list[str]:
    """The cases that are still open."""
    return [f"not answered yet: {', '.join(found.unanswered)}"] if found.unanswered else []


def cases(found: Score) -> Table:
    """A row per case: its error, the reference's bar, whether the two can be told apart, the time."""
    lines = tuple(
        (
            answer.reference.name,
            found.error(answer),
            answer.reference.bar,
            "yes" if found.error(answer) > answer.reference.bar else "no",
            answer.seconds,
        )
        for answer in found.answers
    )
    columns = (
        Column("case"),
        Column("error", *PERCENT),
        Column("reference's bar", *PERCENT),
        Column("distinguishable"),
        Column("time", "s", "ms", 1e3, ".3g"),
    )
    return Table("Errors by case", columns, lines, "cases")


def rows(found: Score) -> Table:
    """A row per probe or mode."""
    lines = tuple(
        (row.case, row.probe, row.error, "yes" if row.distinguishable else "no") for row in found.rows
    )
    columns = (Column("case"), Column("probe"), Column("error", *PERCENT), Column("distinguishable"))
    return Table("Errors by probe", columns, lines, "rows")


def place(found: Score) -> Table:
    """Where the answers stand among our own models and other programs, the best first."""
    front = found.front
    lines = tuple(
        (one.model, one.whose, one.score, one.seconds, "yes" if one.model in front else "no")
        for one in found.standing
    )
    columns = (
        Column("model"),
        Column("whose"),
        Column("score", *PERCENT),
        Column("time", "s", "ms", 1e3, ".3g"),
        Column("on the front"),
    )
    return Table("Beside our own models and other programs on the same cases", columns, lines, "place")


def _where(found: Score) -> list[str]:
    """The place in a sentence, and where the times were measured."""
    if len(found.standing) < 2:
        return []
    at = [one.model for one in found.standing].index("answers")
    made = document()["made_with"]["machine"].get("processor", "another machine")
    said = (
        f"place {at + 1} of {len(found.standing)} by score; times of the others are geometric means, "
        f"measured on {made}"
    )
    return [said]
