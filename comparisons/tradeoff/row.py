"""Rows of a trade-off, at rest and in motion: a model, its status, cost and errors."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Self

import numpy as np

from comparisons.comparison.measures import difference, largest, matching_measures
from comparisons.external.plugins import shown_name
from comparisons.sweep.solved import Solved
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, TableUnit
from sheetbench.scenes.language.summary import milliseconds

MEMORY = TableUnit("B", "MB", 1e-6)
FRONT = Column("front", words=("yes", ""))
FIELDS = ("label", "status", "message", "cell_size", "started", "finished", "error", "field_error")
MEASURED = ("unknowns", "iterations", "setup_seconds", "peak_memory_bytes")
CONDITIONS = ("load_average", "machine", "worker", "versions")  # in the JSON if known
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
    """A row of the table of solves, with its errors at the probes and over the sheet, fractions if known."""

    error: float | None = None
    field_error: float | None = None

    @property
    def known(self) -> dict[str, Any]:
        """The answer's document, its additional columns and its cost in one mapping."""
        return {**self.row, **self.row.get("columns", {}), **self.row.get("cost", {})}

    @property
    def model_error(self) -> float | None:
        """Model error of a reference, independent of its mesh, a fraction."""
        return self.known.get("model_error")

    @property
    def cell_size(self) -> float | None:
        """Size of a cell along the shorter side [m], None if the settings have no size."""
        cells = _cells(self.request.spec.settings)
        return min(self.request.scene.sheet.lengths) / cells if cells else None

    @property
    def model(self) -> str:
        return self.request.spec.model

    @property
    def plot_point(self) -> tuple[float | None, float | None]:
        """Abscissa and ordinate of a convergence plot: size of a cell [m] and error."""
        return self.cell_size, self.error

    @property
    def mark(self) -> str:
        """Label of the row's point: counts along both sides, one count if they are equal."""
        along = self.request.spec.size.split("×")[:2]
        return along[0] if len(set(along)) == 1 else "×".join(along)

    @property
    def cost(self) -> float | None:
        """Cost of the row: its solve time [s]."""
        return self.seconds

    @property
    def name(self) -> str:
        """Name of the row in sentences."""
        return self.label

    def cells(self) -> tuple[Any, ...]:
        """Return the values of `TRADED` without row number, front and status."""
        spec, known = self.request.spec, self.known
        unknowns, iterations, setup, memory = (known.get(name) for name in MEASURED)
        times = (setup, self.seconds, min(self.samples, default=None), max(self.samples, default=None))
        return (spec.series, spec.size, unknowns, iterations, *times, memory, self.error, self.field_error)

    def as_dict(self) -> dict[str, Any]:
        """Return the row as JSON data."""
        spec, known = self.request.spec, self.known
        out = {name: getattr(self, name) for name in FIELDS} | {name: known.get(name) for name in MEASURED}
        out |= {"model": shown_name(spec.model), "settings": spec.settings, "series": spec.series}
        out |= {name: known[name] for name in _OF_AN_ANSWER if known.get(name) is not None}
        return out | {"solve_seconds": {"median": self.seconds, "samples": self.samples}}


def _cells(settings: Mapping[str, Any]) -> int | None:
    """Return the number of cells along the shorter side, None if the settings have no size."""
    for name, more in (("grid", 1), ("elements", 0)):
        if (size := settings.get(name)) is not None:
            return int(np.min(size[:2] if isinstance(size, list | tuple) else size)) - more
    return None


@dataclass(frozen=True)
class MotionRow(TradeoffRow):
    """A run of a model's motion with its errors.

    error: largest error of the displacement, a fraction of the reference's largest; step_error: largest
    difference from the lattice with fine steps; period [s] and damping ratio by
    `comparisons.comparison.measures`; period_error: relative; damping_error: a difference. A value is None
    for a run without answer or oscillation.
    """

    step_error: float | None = None
    period: float | None = None
    period_error: float | None = None
    damping: float | None = None
    damping_error: float | None = None

    @classmethod
    def of(cls, solved: Solved, truth: Solved, fine: Solved | None = None) -> Self:
        """Return the row of a run; truth: of the reference; fine: of the lattice with fine steps."""
        history, reference = solved.history, truth.history
        if history is None or reference is None:
            return cls(**vars(solved))
        errors, (run, true) = difference(history, reference), matching_measures(history, reference)
        fine_history = None if fine is None else fine.history
        damping = None if run.damping is None or true.damping is None else run.damping - true.damping
        return cls(
            **vars(solved),
            error=errors["largest"],
            step_error=None if fine_history is None else largest(history, fine_history),
            period=run.period,
            period_error=errors["period"],
            damping=run.damping,
            damping_error=damping,
        )

    @property
    def step(self) -> float | None:
        """The step [s]: fixed, or the mean step of an error control."""
        steps = self.row["steps"] if self.usable else 0
        return self.request.run.get("step") or ((self.request.duration or 0.0) / steps if steps else None)

    @property
    def cost(self) -> float | None:
        """Solver time per simulated second."""
        return self.row["solve_seconds"] / self.request.duration if self.usable else None

    @property
    def integrator(self) -> str:
        """Name of the integrator, "" for models without a choice."""
        return str(self.request.run.get("integrator", ""))

    @property
    def run(self) -> str:
        """The model with its size and integrator."""
        return " ".join(filter(None, (self.model, self.request.spec.size, self.integrator)))

    @property
    def name(self) -> str:
        """The run and its step in words."""
        return f"{self.run} with steps of {milliseconds(self.step)}" if self.step else self.run

    @property
    def plot_point(self) -> tuple[float | None, float | None]:
        """Abscissa and ordinate of a convergence plot: step [s] and step error."""
        return self.step, self.step_error

    @property
    def mark(self) -> str:
        return milliseconds(self.step) if self.step else self.request.spec.size

    def as_dict(self) -> dict[str, Any]:
        """Return the row as JSON data."""
        size, integrator = self.request.spec.size, self.integrator
        out: dict[str, Any] = {"model": self.model, "size": size, "integrator": integrator}
        out |= {"step": self.step, "status": self.status, "message": self.message}
        out |= {name: self.known.get(name) for name in OF_A_RUN} | {"seconds_per_second": self.cost}
        return out | {"error": self.error, **{name: getattr(self, name) for name in OF_A_MOTION}}
