"""Ranges in which each model is accurate, largest stable steps, and all runs: the answer of `stability`."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from typing import Annotated, Any

from comparisons.stability.rows import LARGE, Row, fault_sentences, label_of, place, verdict
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, Table, TableUnit, number
from sheetbench.choices import VARIED
from sheetbench.scenes import Scene

MICROSECONDS = TableUnit("s", "µs", 1e6)


ENDS = ("holds", "off", "refuses", "fails")
RUNS = (
    *("status", PERCENT(".3g", "error"), NUMBER("d", "iterations")),
    *(MILLISECONDS(".3g", "seconds", shown_name="time"), Column("message", prose=True, detail=True)),
)


@dataclass(frozen=True)
class SummaryRow:
    """A parameter and a model: its values by verdict as text, and the largest error of values that hold."""

    varied: str
    model: str
    holds: Annotated[str, Column(prose=True)]
    off: Annotated[str, Column(f"off by more than {100.0 * LARGE:g} %", prose=True)]
    refuses: Annotated[str, Column(prose=True)]
    fails: Annotated[str, Column(prose=True)]
    error: Annotated[float | None, PERCENT(".2g", "largest error where it holds")]


@dataclass(frozen=True)
class StepRow:
    """Steps of an explicit integrator at a damping ratio, and the status of a run with the default step."""

    integrator: str
    damping: str
    largest_step: Annotated[float, MICROSECONDS(".4g")]
    default_step: Annotated[float, MICROSECONDS(".4g")]
    status: Annotated[str, Column("a run with it")]


@dataclass(frozen=True, repr=False)
class Stability(Answer):
    """Rows of all runs of a scene; period: of its lowest mode [s], None unless runs in motion need it."""

    file_name = "stability"
    scene: Scene
    reference: str
    period: float | None
    rows: tuple[Row, ...]

    def document(self) -> dict[str, Any]:
        return {
            "scene": self.scene.document(),
            "reference": self.reference,
            "period": self.period,
            "rows": list(self.rows),
        }

    def heading(self) -> tuple[str, str, str]:
        return "stability", f"where each model of {self.scene.name} holds", ""

    def tables(self) -> tuple[Table, ...]:
        studies = groupby(self.rows, key=lambda row: row["study"])
        return (*self.printed(), *(run_table(name, list(rows)) for name, rows in studies))

    def printed(self) -> tuple[Table, ...]:
        steps = limits(self)
        return (summary(self), steps) if steps.rows else (summary(self),)

    def figures(self) -> tuple[Picture, ...]:
        drawn = any(row["study"] != "damping" for row in self.rows)
        return (Picture("stability", "comparisons.stability.figure:compose", (self,)),) if drawn else ()

    def notes(self) -> tuple[str, ...]:
        bound = f"holds: converged with an error of at most {100.0 * LARGE:g} %"
        return (f"{bound}, at rest against the {self.reference}, in motion against a fine step.",)

    def result(self) -> str:
        verdicts = [verdict(row) for row in self.rows if place(row) is not None and verdict(row) in ENDS]
        return f"{verdicts.count('holds')} of {len(verdicts)} cells hold"

    def complaints(self) -> list[str]:
        return fault_sentences(self.rows)

    def choices(self) -> dict[str, Any]:
        return {"studies": list(dict.fromkeys(row["study"] for row in self.rows))}

    @property
    def succeeded(self) -> bool:
        return not self.complaints()


def summary(maps: Stability) -> Table:
    """Return a table of the parameter ranges by verdict, with a row per study and model."""
    rows, order = [], _order(maps)
    for (study, name), group in groupby(
        sorted(maps.rows, key=lambda row: (list(VARIED).index(row["study"]), order[label_of(row)])),
        key=lambda row: (row["study"], label_of(row)),
    ):
        runs = [row for row in group if place(row) is not None]
        errors = [row["error"] for row in runs if verdict(row) == "holds" and row["error"] is not None]
        holds, off, refuses, fails = (_ranges(runs, end) for end in ENDS)
        worst = max(errors, default=None)
        rows.append(SummaryRow(VARIED[study], name, holds, off, refuses, fails, worst))
    return Table.of(SummaryRow, rows, "Where each model is accurate", "holds", grouped=True)


def _order(maps: Stability) -> dict[str, int]:
    """Return the order of models and integrators by their first row."""
    return {name: place for place, name in enumerate(dict.fromkeys(map(label_of, maps.rows)))}


def _ranges(rows: Iterable[Row], end: str) -> str:
    """Return the parameter values of rows with a verdict as text, neighbours as a range."""
    ranges = []
    for matches, group in groupby(sorted(rows, key=place), key=lambda row: verdict(row) == end):
        places = [place(row) * (1e3 if row["study"] == "time-step" else 1.0) for row in group]
        if matches:
            ends = [number(at, ".4g") for at in dict.fromkeys((places[0], places[-1]))]
            ranges.append(" to ".join(ends))
    return ", ".join(ranges) or "–"


def limits(maps: Stability) -> Table:
    """Return a table of largest stable and default steps, with a row per explicit integrator and damping."""
    runs = [row for row in maps.rows if row["study"] == "damping" and row.get("computed") is not None]
    order = _order(maps)
    rows = []
    for row in sorted(runs, key=lambda row: order[label_of(row)]):
        ratio = "the scene's" if place(row) is None else f"ratio {number(place(row), 'g')}"
        rows.append(StepRow(label_of(row), ratio, row["computed"], row["advised"], row["status"]))
    return Table.of(StepRow, rows, "Largest stable steps", "steps", grouped=True)


def run_table(study: str, rows: list[Row]) -> Table:
    """Return a table of a study's runs."""
    caption = VARIED[study].partition(" [")[0]
    varied = (MILLISECONDS if study == "time-step" else NUMBER)(".4g", caption.partition(",")[0])
    kind = "integrator" if "integrator" in rows[0]["cell"] else "model"
    keys = ("status", "error", "iterations", "seconds", "message")
    values = [(place(row), label_of(row), *(row[key] for key in keys)) for row in rows]
    return Table.listed(f"{caption.capitalize()}: every run", (varied, kind, *RUNS), values, study)
