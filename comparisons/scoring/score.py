"""Answers to a suite, scored against its reference and ranked with our models and other programs.

    error   largest |component of u − u_ref| over the probes (and times) of a case / largest |component of
            u_ref|; for frequencies the largest |f/f_ref − 1|
    score   geometric mean over the cases of the error, clipped to the range from the reference's error bar
            to 1; a case without an answer counts as 1

An answer within the reference's error bar is not distinguishable from the reference.
"""

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

ANSWERS = "answers"
OWN_MODELS = ("lumped", *REFERENCES)
SIZES = ("grid", "elements")
ORIGINS = YOURS, OURS, OTHERS = "yours", "ours", "other program"


@dataclass(frozen=True)
class Row:
    """The error at a probe or of a mode of a case; distinguishable: whether it exceeds its error bar."""

    case: str
    probe: str
    error: Annotated[float, PERCENT(".3g")]
    distinguishable: bool


@dataclass(frozen=True)
class CaseRow:
    """A case: its largest error, the reference's bar, whether the error exceeds it, and the time [s]."""

    case: str
    error: Annotated[float, PERCENT(".3g")]
    bar: Annotated[float, PERCENT(".3g", "reference's bar")]
    distinguishable: bool
    seconds: Annotated[float | None, MILLISECONDS(".1f", "time")]


@dataclass(frozen=True)
class ModelScore:
    """A model's score and the geometric mean of its times [s], None if not given; whose: one of `ORIGINS`."""

    model: str
    score: Annotated[float, PERCENT(".3g")]
    seconds: Annotated[float | None, MILLISECONDS(".1f", "time")]
    whose: str


@dataclass(frozen=True, eq=False, repr=False)
class Score(ShownAnswer):
    """Answers to a suite with their errors and likely mistakes; unanswered: requested cases that are open."""

    file_name = "score"
    suite: str
    answers: tuple[Answer, ...]
    unanswered: tuple[str, ...] = ()

    @property
    def rows(self) -> list[Row]:
        """Errors by probe or mode."""
        return [row for answer in self.answers for row in _rows(answer)]

    @cached_property
    def faults(self) -> list[str]:
        """Likely mistakes, a sentence each."""
        return faults(self.answers)

    def error(self, answer: Answer) -> float:
        """Return the error of a case."""
        return max(row.error for row in _rows(answer))

    @property
    def score(self) -> float:
        """The score over all answered cases."""
        return mean([self.error(a) for a in self.answers], [a.reference for a in self.answers])

    @property
    def cases(self) -> list[CaseRow]:
        """Errors by case."""
        errors = ((a, self.error(a)) for a in self.answers)
        return [
            CaseRow(a.reference.name, e, a.reference.bar, e > a.reference.bar, a.seconds) for a, e in errors
        ]

    @property
    def leaderboard(self) -> list[ModelScore]:
        """Scores of the answers and of other models on their cases, the best first."""
        times = [answer.seconds for answer in self.answers if answer.seconds]
        seconds = _geometric(times) if len(times) == len(self.answers) else None
        others = other_models([answer.reference for answer in self.answers])
        return sorted([ModelScore(ANSWERS, self.score, seconds, YOURS), *others], key=lambda row: row.score)

    def document(self) -> dict[str, Any]:
        """Return the JSON document of `sheetbench score`."""
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
            "standing": [asdict(place) for place in self.leaderboard],
        }

    @property
    def _verdict(self) -> str:
        return verdict(self.answers, [self.error(answer) for answer in self.answers], self.faults)

    def heading(self) -> tuple[str, str, str]:
        answered, total = len(self.answers), len(self.answers) + len(self.unanswered)
        cases = "1 case" if total == 1 else f"{'' if answered == total else f'{answered} of '}{total} cases"
        title = f"score {number(100 * self.score, '.3g')} %"
        return title, f"on {cases} of {self.suite}, reference set {document()['version']}", self._verdict

    def tables(self) -> tuple[Table, ...]:
        cases, *place = self.printed()
        return (cases, Table.of(Row, self.rows, "Errors by probe", "rows"), *place)

    def printed(self) -> tuple[Table, ...]:
        cases = Table.of(CaseRow, self.cases, "Errors by case", "cases")
        caption = "Scores of our models and other programs on these cases"
        place = Table.of(
            ModelScore, self.leaderboard, caption, "place", fields=("model", "whose", "score", "seconds")
        )
        return (cases, place) if len(self.leaderboard) > 1 else (cases,)

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("score", "comparisons.scoring.figure:compose", (self,)),)

    def result(self) -> str:
        return self._verdict

    def notes(self) -> list[str]:
        notes = [
            "error: largest difference over the reference's largest value; distinguishable: yes if the error "
            "is larger than the reference's error bar",
            "score: geometric mean of the cases' errors, none below the reference's bar, none above 100 %",
        ]
        if self.unanswered:
            notes.append(f"not answered yet: {', '.join(self.unanswered)}")
        if len(self.leaderboard) > 1:
            if any(place.seconds is not None for place in self.leaderboard if place.model != ANSWERS):
                machine = document()["made_with"]["machine"].get("processor", "another machine")
                notes.append(f"times of the others are geometric means, measured on {machine}")
            notes.append(self.place)
        return notes

    @property
    def place(self) -> str:
        """Rank among other models by score, and the model of the nearest score, in words."""
        ranked = self.leaderboard
        rank = [place.model for place in ranked].index(ANSWERS) + 1
        others = [place for place in ranked if place.model != ANSWERS]
        nearest = min(others, key=lambda place: abs(np.log(max(place.score, 1e-12) / max(self.score, 1e-12))))
        return (
            f"you rank {rank} of {len(ranked)}; nearest neighbour {nearest.model}, "
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
    """Score a file of answers to a suite, or to one or some of its cases. suite: by default from the file's
    header. Raises BadInput for an incomplete or invalid file."""
    answers, unanswered = read_answers(path, suite, [case] if isinstance(case, str) else case)
    return Score(answers[0].reference.suite, tuple(answers), tuple(case.name for case in unanswered))


def mean(errors: Sequence[float | None], cases: Sequence[Reference]) -> float:
    """Return the score of errors on cases."""
    pairs = zip(errors, cases, strict=True)
    return _geometric([1.0 if error is None else min(1.0, max(error, case.bar)) for error, case in pairs])


def _geometric(values: Sequence[float]) -> float:
    return float(np.exp(np.mean(np.log(np.maximum(values, 1e-12)))))


def _rows(answer: Answer) -> list[Row]:
    case = answer.reference
    difference, truth = np.abs(answer.values - case.values), np.abs(case.values)
    if case.suite == "modes":
        names, errors = [f"mode {n + 1}" for n in range(len(truth))], difference / truth
        distinguishable = difference > case.bars
    else:
        names = list(case.scene.probes)
        errors = difference.reshape(len(difference), -1).max(axis=1) / truth.max()
        distinguishable = (difference > case.bars).reshape(len(difference), -1).any(axis=1)
    values = zip(names, errors.tolist(), distinguishable.tolist(), strict=True)
    return [Row(case.name, name, error, differs) for name, error, differs in values]


def other_models(cases: Sequence[Reference]) -> list[ModelScore]:
    """Return the stored scores of our models and of other programs with an answer to any of the cases."""
    rows: dict[str, dict[str, dict[str, Any]]] = {}
    names = {case.name for case in cases}
    stored = [row for row in document()["standing"] if row["case"] in names]
    for row in stored or [row for case in cases for row in _model_rows(case)]:
        rows.setdefault(str(spec_of(row["model"], row["settings"])), {})[row["case"]] = row
    places = []
    for name, of_model in rows.items():
        answered = [row for row in of_model.values() if row["error"] is not None]
        if not answered:
            continue
        times = [row["seconds"] for row in answered if row["seconds"]]
        origin = OURS if answered[0]["model"] in OWN_MODELS else OTHERS
        score = mean([of_model[case.name]["error"] for case in cases], cases)
        places.append(ModelScore(name, score, _geometric(times) if times else None, origin))
    return places


def _model_rows(case: Reference) -> list[dict[str, Any]]:
    """Return rows of other models that solved a case when the set was made; their times are not stored."""
    return [
        {**row, "case": case.name, "seconds": None, "settings": {k: row[k] for k in SIZES if k in row}}
        for row in case.judges
        if row["error"]
    ]
