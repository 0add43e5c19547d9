"""Rows of a trade-off, at rest and in motion: a model, how its solve ended, its cost and errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from comparisons.comparison.measures import difference, largest, measured_alike
from comparisons.external.plugins import shown_name
from comparisons.sweep.solved import Solved
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, TableUnit
from sheetbench.scenes.language.summary import milliseconds

MEMORY = TableUnit("B", "MB", 1e-6)
FRONT = Column("front", words=("yes", ""))
OWN = ("label", "status", "message", "cell_size", "started", "finished", "error", "field_error")
MEASURED = ("unknowns", "iterations", "setup_seconds", "peak_memory_bytes")
CONDITIONS = ("load_average", "machine", "worker", "versions")  # in the JSON where they are known
_OF_AN_ANSWER = ("load_factor", "model_error", "probes", "traceback", *CONDITIONS)
TRADED = (
    *(NUMBER("d", "row"), Column("model", prose=True), "size", NUMBER("d", "unknowns")),
    *(NUMBER("d", "factorisations", detail=True), MILLISECONDS(".1f", "set-up", detail=True)),
    *(MILLISECONDS(".2f", "solve"), MILLISECONDS(".2f", "from", detail=True)),
    *(MILLISECONDS(".2f", "to", detail=True), MEMORY(".1f", "memory"), PERCENT(".3g", "error")),
    *(PERCENT(".3g", "field error"), FRONT, Column("status", detail=True)),
)
OF_A_RUN = ("unknowns", "steps", "peak_memory_bytes", *CONDITIONS)
OF_A_MOTION = ("step_error", "period", "period_error", "damping", "damping_error")
MOVED = {
    **{"model": Column(), "size": Column(), "integrator": Column(), "step": MILLISECONDS(".3g")},
    **{"steps": NUMBER("d", detail=True), "unknowns": NUMBER("d", detail=True)},
    **{
        "seconds_per_second": TableUnit("s/s", "s/s")(".3g", "cost"),
        "peak_memory_bytes": MEMORY(".1f", "memory"),
    },
    **{"error": PERCENT(".3g"), "step_error": PERCENT(".2g"), "period_error": PERCENT("z.2f", "period")},
    **{"damping": PERCENT("z.2f"), "front": FRONT, "status": Column(detail=True)},
}


@dataclass(frozen=True)
class TradeoffRow(Solved):
    """A row of the table of solves, at rest, with its errors at the probes and over the sheet, fractions,
    None where there is nothing to measure."""

    error: float | None = None
    field_error: float | None = None

    @property
    def known(self) -> dict[str, Any]:
        """The answer's document, its further columns and its cost in one."""
        return {**self.row, **self.row.get("columns", {}), **self.row.get("cost", {})}

    @property
    def model_error(self) -> float | None:
        """What a reference leaves out on every mesh, a fraction."""
        return self.known.get("model_error")

    @property
    def cell_size(self) -> float | None:
        """Size of a cell along the shorter side [m], where the settings tell."""
        cells = _cells(self.ask.spec.settings)
        return min(self.ask.scene.sheet.lengths) / cells if cells else None

    @property
    def model(self) -> str:
        return self.ask.spec.model

    @property
    def sized(self) -> tuple[float | None, float | None]:
        """Size of a cell [m] and the error of it."""
        return self.cell_size, self.error

    @property
    def mark(self) -> str:
        """Counts along both sides, or one where they are alike."""
        along = self.ask.spec.size.split("×")[:2]
        return along[0] if len(set(along)) == 1 else "×".join(along)

    @property
    def cost(self) -> float | None:
        """What the front and the cheapest are of."""
        return self.seconds

    @property
    def name(self) -> str:
        """What the row is called in sentences."""
        return self.label

    def cells(self) -> tuple[Any, ...]:
        """Return the values of `TRADED` between the row's number and whether it is on the front."""
        spec, known = self.ask.spec, self.known
        unknowns, iterations, setup, memory = (known.get(name) for name in MEASURED)
        times = (setup, self.seconds, min(self.samples, default=None), max(self.samples, default=None))
        return (spec.series, spec.size, unknowns, iterations, *times, memory, self.error, self.field_error)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        spec, known = self.ask.spec, self.known
        own = {name: getattr(self, name) for name in OWN} | {name: known.get(name) for name in MEASURED}
        own |= {"model": shown_name(spec.model), "settings": spec.settings, "series": spec.series}
        own |= {name: known[name] for name in _OF_AN_ANSWER if known.get(name) is not None}
        return own | {"solve_seconds": {"median": self.seconds, "samples": self.samples}}


def _cells(settings: Mapping[str, Any]) -> int | None:
    """Return the number of cells along the shorter side, where settings tell."""
    for name, more in (("grid", 1), ("elements", 0)):
        if (size := settings.get(name)) is not None:
            return int(np.min(size[:2] if isinstance(size, list | tuple) else size)) - more
    return None


@dataclass(frozen=True)
class MotionRow(TradeoffRow):
    """A run of a model's motion beside the reference's.

    error: the largest of the displacement's, a fraction of the reference's largest; step_error: likewise
    against the same lattice in fine steps; period [s] and damping ratio as `comparisons.comparison.measures`
    has them, and how far they are off: the period by a fraction, the damping by a difference. None where a
    run has no answer, or does not swing.
    """

    step_error: float | None = None
    period: float | None = None
    period_error: float | None = None
    damping: float | None = None
    damping_error: float | None = None

    @classmethod
    def of(cls, found: Solved, truth: Solved, own: Solved | None = None) -> MotionRow:
        """Return the row of a run; own: the same lattice in fine steps."""
        history, reference = found.history, truth.history
        if history is None or reference is None:
            return cls(**vars(found))
        off, (mine, theirs) = difference(history, reference), measured_alike(history, reference)
        fine = None if own is None else own.history
        step_error = None if fine is None else largest(history, fine)
        damped = None if mine.damping is None or theirs.damping is None else mine.damping - theirs.damping
        swings = dict(
            zip(OF_A_MOTION, (step_error, mine.period, off["period"], mine.damping, damped), strict=True)
        )
        return cls(**vars(found), error=off["largest"], **swings)

    @property
    def step(self) -> float | None:
        """The step [s]: fixed, or the mean of steps that keep to an error."""
        mean = (self.ask.duration or 0.0) / self.row["steps"] if self.usable and self.row["steps"] else None
        return self.ask.run.get("step") or mean

    @property
    def cost(self) -> float | None:
        """The solver's time in a simulated second."""
        return self.row["solve_seconds"] / self.ask.duration if self.usable else None

    @property
    def integrator(self) -> str:
        """Where there is a choice."""
        return str(self.ask.run.get("integrator", ""))

    @property
    def run(self) -> str:
        """The model with its size and integrator."""
        return " ".join(filter(None, (self.model, self.ask.spec.size, self.integrator)))

    @property
    def name(self) -> str:
        """The run and its steps."""
        return f"{self.run} with steps of {milliseconds(self.step)}" if self.step else self.run

    @property
    def sized(self) -> tuple[float | None, float | None]:
        """The step [s] and what it misses."""
        return self.step, self.step_error

    @property
    def mark(self) -> str:
        return milliseconds(self.step) if self.step else self.ask.spec.size

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        own: dict[str, Any] = {"model": self.model, "size": self.ask.spec.size, "integrator": self.integrator}
        own |= {"step": self.step, "status": self.status, "message": self.message}
        own |= {name: self.known.get(name) for name in OF_A_RUN} | {"seconds_per_second": self.cost}
        return own | {"error": self.error, **{name: getattr(self, name) for name in OF_A_MOTION}}
