"""Where each model of a scene holds, the largest stable steps, every run: the answer of `stability`."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from comparisons.stability.rows import LARGE, Row, broken, place, verdict, who
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, Table, TableUnit, number
from sheetbench.choices import VARIED
from sheetbench.scenes import Scene

MICROSECONDS = TableUnit("s", "µs", 1e6)


ENDS = ("holds", "off", "refuses", "fails")
HOLDS = (
    *(
        "varied",
        "model",
        *(Column(name, prose=True) for name in ("holds", f"off by more than {100.0 * LARGE:g} %")),
    ),
    *(Column("refuses", prose=True), Column("fails", prose=True)),
    PERCENT(".2g", "largest error where it holds"),
)
STEPS = (
    *("integrator", "damping", MICROSECONDS(".4g", "largest step"), MICROSECONDS(".4g", "default step")),
    "a run with it",
)
RUNS = (
    *("status", PERCENT(".3g", "error"), NUMBER("d", "iterations")),
    *(MILLISECONDS(".3g", "seconds", shown_name="time"), Column("message", prose=True, detail=True)),
)


@dataclass(frozen=True, repr=False)
class Stability(Answer):
    """The rows of what was varied of a scene; period: of its lowest mode [s], None unless it was needed."""

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
        return (*self.printed(), *(cells(name, list(rows)) for name, rows in studies))

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
        ended = [verdict(row) for row in self.rows if place(row) is not None and verdict(row) in ENDS]
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
    rows, order = [], _order(maps)
    for (study, name), some in groupby(
        sorted(maps.rows, key=lambda row: (list(VARIED).index(row["study"]), order[who(row)])),
        key=lambda row: (row["study"], who(row)),
    ):
        of = [row for row in some if place(row) is not None]
        errors = [row["error"] for row in of if verdict(row) == "holds" and row["error"] is not None]
        rows.append((VARIED[study], name, *(_ranges(of, end) for end in ENDS), max(errors, default=None)))
    return Table.listed("Where each model is accurate", HOLDS, rows, "holds", grouped=True)


def _order(maps: Stability) -> dict[str, int]:
    """Return the place of each model and integrator."""
    return {name: place for place, name in enumerate(dict.fromkeys(map(who, maps.rows)))}


def _ranges(rows: Iterable[Row], end: str) -> str:
    """Return the places of the cells that ended so, neighbours as a range."""
    sentences = []
    for here, some in groupby(sorted(rows, key=place), key=lambda row: verdict(row) == end):
        places = [place(row) * (1e3 if row["study"] == "time-step" else 1.0) for row in some]
        if here:
            ends = [number(at, ".4g") for at in dict.fromkeys((places[0], places[-1]))]
            sentences.append(" to ".join(ends))
    return ", ".join(sentences) or "–"


def limits(maps: Stability) -> Table:
    """Return a row per explicit integrator and damping: its largest stable step and the default one."""
    known = [row for row in maps.rows if row["study"] == "damping" and row.get("computed") is not None]
    order = _order(maps)
    rows = []
    for row in sorted(known, key=lambda row: order[who(row)]):
        ratio = "the scene's" if place(row) is None else f"ratio {number(place(row), 'g')}"
        rows.append((who(row), ratio, *map(row.get, ("computed", "advised", "status"))))
    return Table.listed("Largest stable steps", STEPS, rows, "steps", grouped=True)


def cells(name: str, of: list[Row]) -> Table:
    """Return a row per run of what was varied."""
    caption = VARIED[name].partition(" [")[0]
    varied = (MILLISECONDS if name == "time-step" else NUMBER)(".4g", caption.partition(",")[0])
    what = "integrator" if "integrator" in of[0]["cell"] else "model"
    keys = ("status", "error", "iterations", "seconds", "message")
    rows = [(place(row), who(row), *(row[key] for key in keys)) for row in of]
    return Table.listed(f"{caption.capitalize()}: every run", (varied, what, *RUNS), rows, name)
