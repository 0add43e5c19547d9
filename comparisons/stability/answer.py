"""Where each model of a scene holds, the largest stable steps, every run: the answer of `stability`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import groupby
from typing import Annotated, Any

from comparisons.stability.rows import LARGE, Row, broken, place, verdict, who
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, Table, TableUnit, number
from sheetbench.choices import VARIED
from sheetbench.scenes import Scene

MICROSECONDS = TableUnit("s", "µs", 1e6)


@dataclass(frozen=True)
class HoldsRow:
    """Where a model holds, degrades, refuses and fails over what was varied, and its largest error there."""

    varied: str
    model: str
    holds: Annotated[str, Column(prose=True)]
    off: Annotated[str, Column(f"off by more than {100.0 * LARGE:g} %", prose=True)]
    refuses: Annotated[str, Column(prose=True)]
    fails: Annotated[str, Column(prose=True)]
    error: Annotated[float | None, PERCENT(".2g", "largest error where it holds")]


@dataclass(frozen=True)
class StepRow:
    """An explicit integrator's largest stable step under a damping, computed and measured."""

    integrator: str
    damping: str
    computed: Annotated[float, MICROSECONDS(".4g", "largest step")]
    measured: Annotated[float | None, MICROSECONDS(".4g")]
    advised: Annotated[float, MICROSECONDS(".4g", "default step")]
    status: Annotated[str, Column("a run with it")]


@dataclass(frozen=True)
class CellRow:
    """A run: the value that was varied, the model or integrator, and how it ended."""

    at: Mapping[Column, Any]
    status: str
    error: Annotated[float | None, PERCENT(".3g")]
    iterations: Annotated[int | None, NUMBER("d")]
    seconds: Annotated[float, MILLISECONDS(".3g", shown_name="time")]
    message: Annotated[str, Column(prose=True, detail=True)]


@dataclass(frozen=True, repr=False)
class Stability(Answer):
    """The rows of what was varied of a scene; period: of its lowest mode [s], None unless it was needed."""

    file_name = "stability"
    scene: Scene
    reference: str
    period: float | None
    rows: tuple[Row, ...]

    def document(self) -> dict[str, Any]:
        """Return the JSON document: SI units, errors as fractions."""
        return {
            "scene": self.scene.document(),
            "reference": self.reference,
            "period": self.period,
            "rows": list(self.rows),
        }

    def heading(self) -> tuple[str, str, str]:
        return "stability", f"where each model of {self.scene.name} holds", ""

    def tables(self) -> tuple[Table, ...]:
        return (*self.printed(), *map(cells, _studies(self)))

    def printed(self) -> tuple[Table, ...]:
        return (summary(self), limits(self)) if _limits(self) else (summary(self),)

    def figures(self) -> tuple[Picture, ...]:
        drawn = any(row["study"] != "damping" for row in self.rows)
        return (Picture("stability", "comparisons.stability.figure:compose", (self,)),) if drawn else ()

    def notes(self) -> tuple[str, ...]:
        bound = f"holds: converged with an error of at most {100.0 * LARGE:g} %"
        return (f"{bound}, at rest against the {self.reference}, in motion against a fine step.",)

    def result(self) -> str:
        ended = [verdict(row) for row in self.rows if place(row) is not None]
        return f"{ended.count('holds')} of {len(ended)} cells hold"

    def complaints(self) -> list[str]:
        return broken(self.rows)

    def choices(self) -> dict[str, Any]:
        return {"studies": list(dict.fromkeys(row["study"] for row in self.rows))}

    @property
    def succeeded(self) -> bool:
        return not self.complaints()


def summary(maps: Stability) -> Table:
    """Return a row per study and model: over what it holds, degrades, refuses and fails, the worst error
    held."""
    rows = []
    for (study, name), some in groupby(
        sorted(maps.rows, key=lambda r: (list(VARIED).index(r["study"]), _order(maps, r))),
        key=lambda r: (r["study"], who(r)),
    ):
        of = [row for row in some if place(row) is not None]
        holds, off, refuses, fails = (_ranges(of, end) for end in ("holds", "off", "refuses", "fails"))
        errors = [row["error"] for row in of if verdict(row) == "holds" and row["error"] is not None]
        rows.append(HoldsRow(VARIED[study], name, holds, off, refuses, fails, max(errors, default=None)))
    return Table.of(HoldsRow, rows, "Where each model is accurate", "holds", grouped=True)


def _order(maps: Stability, row: Row) -> int:
    return list(dict.fromkeys(map(who, maps.rows))).index(who(row))


def _ranges(rows: Iterable[Row], end: str) -> str:
    """Return the places of the cells that ended so, neighbours as a range."""
    ordered = sorted(rows, key=place)
    sentences = []
    for here, some in groupby(ordered, key=lambda row: verdict(row) == end):
        places = [place(row) * (1e3 if row["study"] == "time-step" else 1.0) for row in some]
        if here:
            ends = [number(at, ".4g") for at in dict.fromkeys((places[0], places[-1]))]
            sentences.append(" to ".join(ends))
    return ", ".join(sentences) or "–"


def _limits(maps: Stability) -> list[Row]:
    return [row for row in maps.rows if row["study"] == "damping" and row.get("computed") is not None]


def limits(maps: Stability) -> Table:
    """Return a row per explicit integrator and damping: its largest stable step, computed and measured."""
    rows = [
        StepRow(
            who(row),
            "the scene's" if place(row) is None else f"ratio {number(place(row), 'g')}",
            row["computed"],
            row.get("measured"),
            row["advised"],
            row["status"],
        )
        for row in sorted(_limits(maps), key=lambda row: _order(maps, row))
    ]
    return Table.of(StepRow, rows, "Largest stable steps", "steps", grouped=True)


def _studies(maps: Stability) -> list[tuple[str, list[Row]]]:
    return [(study, list(rows)) for study, rows in groupby(maps.rows, key=lambda row: row["study"])]


def cells(study: tuple[str, list[Row]]) -> Table:
    """Return a row per cell of what was varied."""
    name, of = study
    caption = VARIED[name].partition(" [")[0]
    unit = MILLISECONDS if name == "time-step" else NUMBER
    varied = unit(".4g", caption.partition(",")[0])
    what = Column("integrator" if "integrator" in of[0]["cell"] else "model")
    rows = (
        CellRow(
            {varied: place(r), what: who(r)},
            r["status"],
            r["error"],
            r["iterations"],
            r["seconds"],
            r["message"],
        )
        for r in of
    )
    return Table.of(CellRow, rows, f"{caption.capitalize()}: every run", name)
