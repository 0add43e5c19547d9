"""Answers to a suite beside its reference, our own models and other people's programs.

    error   of a case, as everywhere: largest |component of u − u_ref| over the probes (and times) / largest
            |component of u_ref|; of frequencies the largest |f/f_ref − 1|
    score   the geometric mean over the cases of the error, none counted below the reference's own bar and
            none above 1, which is also what a case without an answer counts

An answer within the reference's bar is not distinguishable from it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import numpy as np

from comparisons.models.spec import spec_of
from comparisons.scoring.answers import Answer, read_answers
from comparisons.scoring.faults import faults
from comparisons.scoring.reference import Reference, document
from comparisons.scoring.verdict import stiffness, verdict
from sheetbench.answers.answer import Answer as ShownAnswer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MILLISECONDS, PERCENT, Table, number
from sheetbench.choices import REFERENCES

OWN = "answers"
OWN_MODELS = ("lumped", *REFERENCES)
SIZES = ("grid", "elements")
WHOSE = YOURS, OURS, OTHERS = "yours", "ours", "other program"


@dataclass(frozen=True)
class Row:
    """A probe of a case, or a mode: its error, and whether that is more than the bar there."""

    case: str
    probe: str
    error: Annotated[float, PERCENT(".3g")]
    distinguishable: bool


@dataclass(frozen=True)
class CaseRow:
    """A case: its largest error, the reference's bar, whether that is less, and the time [s] where it was
    given."""

    case: str
    error: Annotated[float, PERCENT(".3g")]
    bar: Annotated[float, PERCENT(".3g", "reference's bar")]
    distinguishable: bool
    seconds: Annotated[float | None, MILLISECONDS(".1f", "time")]


@dataclass(frozen=True)
class Place:
    """A model's score and the geometric mean of its times [s], None where they are not given; whose: one of
    `WHOSE`."""

    model: str
    score: Annotated[float, PERCENT(".3g")]
    seconds: Annotated[float | None, MILLISECONDS(".1f", "time")]
    whose: str


@dataclass(frozen=True, eq=False, repr=False)
class Score(ShownAnswer):
    """Answers to a suite with what they get wrong; unanswered: cases that were requested and are open."""

    file_name = "score"
    suite: str
    answers: tuple[Answer, ...]
    unanswered: tuple[str, ...] = ()

    @property
    def rows(self) -> list[Row]:
        """One a probe or a mode."""
        return [row for answer in self.answers for row in _rows(answer)]

    @cached_property
    def faults(self) -> list[str]:
        """Sentences."""
        return faults(self.answers)

    def error(self, answer: Answer) -> float:
        """The error of a case."""
        return max(row.error for row in _rows(answer))

    @property
    def score(self) -> float:
        """Of all cases."""
        return mean([self.error(a) for a in self.answers], [a.reference for a in self.answers])

    @property
    def cases(self) -> list[CaseRow]:
        """One a case."""
        rated = ((a, self.error(a)) for a in self.answers)
        return [
            CaseRow(a.reference.name, e, a.reference.bar, e > a.reference.bar, a.seconds) for a, e in rated
        ]

    @property
    def leaderboard(self) -> list[Place]:
        """These answers and other models on the same cases, the best first."""
        times = [answer.seconds for answer in self.answers]
        known = [time for time in times if time]
        own = Place(OWN, self.score, _geometric(known) if len(known) == len(times) else None, YOURS)
        ours = own_models([answer.reference for answer in self.answers])
        return sorted([own, *ours], key=lambda one: one.score)

    def document(self) -> dict[str, Any]:
        """The JSON document of `sheetbench score`."""
        return {
            "suite": self.suite,
            "version": document()["version"],
            "rows": [asdict(row) for row in self.rows],
            "cases": [asdict(row) for row in self.cases],
            "unanswered": list(self.unanswered),
            "verdict": self._verdict,
            "stiffer": stiffness(self.answers),
            "faults": self.faults,
            "score": self.score,
            "standing": [asdict(one) for one in self.leaderboard],
        }

    @property
    def _verdict(self) -> str:
        return verdict(self.answers, [self.error(answer) for answer in self.answers], self.faults)

    def heading(self) -> tuple[str, str, str]:
        many, every = len(self.answers), len(self.answers) + len(self.unanswered)
        of = "1 case" if every == 1 else f"{many} cases" if many == every else f"{many} of {every} cases"
        title = f"score {number(100 * self.score, '.3g')} %"
        return title, f"on {of} of {self.suite}, reference set {document()['version']}", self._verdict

    def tables(self) -> tuple[Table, ...]:
        cases, *place = self.printed()
        return (cases, Table.of(Row, self.rows, "Errors by probe", "rows"), *place)

    def printed(self) -> tuple[Table, ...]:
        cases = Table.of(CaseRow, self.cases, "Errors by case", "cases")
        caption = "Beside our own models and other programs on the same cases"
        place = Table.of(
            Place, self.leaderboard, caption, "place", fields=("model", "whose", "score", "seconds")
        )
        return (cases, place) if len(self.leaderboard) > 1 else (cases,)

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("score", "comparisons.scoring.figure:compose", (self,)),)

    def result(self) -> str:
        return self._verdict

    def notes(self) -> list[str]:
        notes = [
            "error: largest difference over the reference's largest value; distinguishable: above that bar",
            "score: geometric mean of the cases' errors, none below the reference's bar, none above 100 %",
        ]
        if self.unanswered:
            notes.append(f"not answered yet: {', '.join(self.unanswered)}")
        if len(self.leaderboard) > 1:
            if any(one.seconds is not None for one in self.leaderboard if one.model != OWN):
                made = document()["made_with"]["machine"].get("processor", "another machine")
                notes.append(f"times of the others are geometric means, measured on {made}")
            notes.append(self.place)
        return notes

    @property
    def place(self) -> str:
        """The place among other models by score, and the model of the nearest score."""
        ranked = self.leaderboard
        at = [one.model for one in ranked].index(OWN)
        others = [one for one in ranked if one.model != OWN]
        nearest = min(others, key=lambda one: abs(np.log(max(one.score, 1e-12) / max(self.score, 1e-12))))
        return (
            f"you rank {at + 1} of {len(ranked)}; nearest neighbour {nearest.model}, "
            f"{number(100 * nearest.score, '.3g')} %"
        )

    def complaints(self) -> list[str]:
        return self.faults

    def choices(self) -> dict[str, Any]:
        return {"suite": self.suite}

    @property
    def succeeded(self) -> bool:
        return not self.faults


def score(path: Path, suite: str | None = None, case: str | Sequence[str] = ()) -> Score:
    """The score of a file of answers to a suite, or to a case or some cases of it.

    suite: the one that the file's header is of unless given. Raises BadInput for what the file lacks.
    """
    answers, unanswered = read_answers(path, suite, [case] if isinstance(case, str) else case)
    return Score(answers[0].reference.suite, tuple(answers), tuple(one.name for one in unanswered))


def mean(errors: Sequence[float | None], of: Sequence[Reference]) -> float:
    """The score of errors on cases."""
    counted = [
        1.0 if error is None else min(1.0, max(error, one.bar)) for error, one in zip(errors, of, strict=True)
    ]
    return _geometric(counted)


def _geometric(values: Sequence[float]) -> float:
    return float(np.exp(np.mean(np.log(np.maximum(values, 1e-12)))))


def _rows(answer: Answer) -> list[Row]:
    known = answer.reference
    off, truth = np.abs(answer.values - known.values), np.abs(known.values)
    if known.suite == "modes":
        names, errors = [f"mode {n + 1}" for n in range(len(truth))], off / truth
        distinguishable = off > known.bars
    else:
        names = list(known.scene.probes)
        errors = off.reshape(len(off), -1).max(axis=1) / truth.max()
        distinguishable = (off > known.bars).reshape(len(off), -1).any(axis=1)
    every = zip(names, errors.tolist(), distinguishable.tolist(), strict=True)
    return [Row(known.name, name, error, differs) for name, error, differs in every]


def own_models(cases: Sequence[Reference]) -> list[Place]:
    """Our own models and other programs that have an answer to any of these cases, as they were measured."""
    rows: dict[str, dict[str, dict[str, Any]]] = {}
    names = {case.name for case in cases}
    leaderboard = [row for row in document()["standing"] if row["case"] in names]
    for row in leaderboard or [row for case in cases for row in _of_models(case)]:
        rows.setdefault(str(spec_of(row["model"], row["settings"])), {})[row["case"]] = row
    return [
        Place(
            name,
            mean([of_model[case.name]["error"] for case in cases], cases),
            _geometric(times)
            if (times := [t for row in answered.values() if (t := row["seconds"])])
            else None,
            OURS if next(iter(of_model.values()))["model"] in OWN_MODELS else OTHERS,
        )
        for name, of_model in rows.items()
        if (answered := {case: row for case, row in of_model.items() if row["error"] is not None})
    ]


def _of_models(case: Reference) -> list[dict[str, Any]]:
    """Other models that solved a case when the set was made, whose times were not kept."""
    return [
        {**row, "case": case.name, "seconds": None, "settings": {k: row[k] for k in SIZES if k in row}}
        for row in case.judges
        if row["error"]
    ]
