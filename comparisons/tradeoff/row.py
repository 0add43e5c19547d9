"""Rows of a trade-off, at rest and in motion: a model, how its solve ended, its cost and errors."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Annotated, Any

import numpy as np

from comparisons.comparison.measures import difference, largest, measured_alike
from comparisons.external.plugins import shown_name
from comparisons.models.spec import counted
from comparisons.sweep.solved import Solved
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, TableUnit
from sheetbench.scenes.language.summary import milliseconds

MEMORY = TableUnit("B", "MB", 1e-6)
FRONT = Column(words=("yes", ""))
# in the JSON where they are known
_OF_AN_ANSWER = ("load_factor", "model_error", "load_average", "probes", "machine", "versions", "traceback")


@dataclass(frozen=True)
class TradeoffRow:
    """A solve at rest and its errors, None where there is nothing to measure.

    A run that ended without an answer has its settings and its status. series: the family whose order is
    looked for; cell_size [m]: along the shorter side, where the settings tell; solve_seconds: every sample;
    error, field_error: fractions; bar: by which the model says that it may be off, likewise; model_error:
    what it leaves out on every mesh, of a reference; started, finished: UTC; number, front: in a table.
    """

    model: str
    label: str
    settings: Mapping[str, Any]
    status: Annotated[str, Column(detail=True)]
    message: str
    series: Annotated[str, Column("model", prose=True)]
    cell_size: float | None
    started: str
    finished: str
    unknowns: Annotated[int | None, NUMBER("d")] = None
    iterations: Annotated[int | None, NUMBER("d", "factorisations", detail=True)] = None
    solve_seconds: tuple[float, ...] = ()
    setup_seconds: Annotated[float | None, MILLISECONDS(".1f", "set-up", detail=True)] = None
    peak_memory_bytes: Annotated[int | None, MEMORY(".1f", "memory")] = None
    error: Annotated[float | None, PERCENT(".3g")] = None
    field_error: Annotated[float | None, PERCENT(".3g", "field error")] = None
    bar: Annotated[float | None, PERCENT(".2g", "own bar", detail=True)] = None
    model_error: float | None = None
    load_factor: float | None = None
    probes: Mapping[str, Any] | None = None
    load_average: float | None = None
    machine: Mapping[str, Any] | None = None
    versions: Mapping[str, Any] | None = None
    traceback: str | None = None
    number: Annotated[int, NUMBER("d", "row")] = 0
    front: Annotated[bool, FRONT] = False

    @classmethod
    def of(cls, found: Solved, error: float | None = None, field_error: float | None = None) -> TradeoffRow:
        """Return the row of a solve, with its errors."""
        spec, sides = found.ask.spec, found.ask.scene.sheet.lengths
        own = ("unknowns", "iterations", "setup_seconds", "load_factor", "probes", "traceback")
        known: dict[str, Any] = {name: found.row.get(name) for name in own}
        known |= {name: value for name, value in found.row.get("columns", {}).items() if name != "field"}
        known |= {name: value for name, value in found.row.get("cost", {}).items() if name != "samples"}
        cells = _cells(spec.settings)
        return cls(
            model=shown_name(spec.model),
            label=found.label,
            settings=spec.settings,
            status=found.status,
            message=found.message,
            series=spec.series,
            cell_size=min(sides) / cells if cells else None,
            started=found.started,
            finished=found.finished,
            solve_seconds=found.samples,
            error=error,
            field_error=field_error,
            **known,
        )

    @property
    def seconds(self) -> Annotated[float | None, MILLISECONDS(".2f", "solve")]:
        """Median of the solve's samples [s]."""
        return statistics.median(self.solve_seconds) if self.solve_seconds else None

    @property
    def quickest(self) -> Annotated[float | None, MILLISECONDS(".2f", "from", detail=True)]:
        """The least of the samples [s]."""
        return min(self.solve_seconds, default=None)

    @property
    def slowest(self) -> Annotated[float | None, MILLISECONDS(".2f", "to", detail=True)]:
        """The largest of the samples [s]."""
        return max(self.solve_seconds, default=None)

    @property
    def cost(self) -> float | None:
        """What the front and the cheapest are of."""
        return self.seconds

    @property
    def name(self) -> str:
        """What the row is called in sentences."""
        return self.label

    @property
    def size(self) -> str:
        """The grid, or both of a pair, or the elements, as requested; nothing where there are none."""
        sizes = (self.settings.get(name) for name in ("coarser", "grid", "elements"))
        return ":".join(counted(size) for size in sizes if size is not None)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        found = {key: value for key, value in asdict(self).items() if key not in ("number", "front")}
        known = {key: value for key, value in found.items() if key not in _OF_AN_ANSWER or value is not None}
        return known | {"solve_seconds": {"median": self.seconds, "samples": self.solve_seconds}}


def _cells(settings: Mapping[str, Any]) -> int | None:
    """Return the number of cells along the shorter side, where settings tell."""
    for name, more in (("grid", 1), ("elements", 0)):
        if (size := settings.get(name)) is not None:
            return int(np.min(size[:2] if isinstance(size, list | tuple) else size)) - more
    return None


@dataclass(frozen=True)
class MotionRow:
    """A run of a model's motion beside the reference's.

    size: the grid, or the elements; step [s]: fixed, or the mean of steps that keep to an error;
    seconds_per_second: the solver's time in a simulated second; error: the largest of the displacement's,
    a fraction of the reference's largest; step_error: likewise against the same lattice in fine steps;
    period [s] and damping ratio as `comparisons.comparison.measures` has them, and how far they are off: the
    period by a fraction, the damping by a difference. None where a run has no answer, or does not swing.
    """

    model_error, solve_seconds = None, ()
    model: str
    size: str
    integrator: str
    step: Annotated[float | None, MILLISECONDS(".3g")]
    status: Annotated[str, Column(detail=True)]
    message: str
    unknowns: Annotated[int | None, NUMBER("d", detail=True)] = None
    steps: Annotated[int | None, NUMBER("d", detail=True)] = None
    seconds_per_second: Annotated[float | None, TableUnit("s/s", "s/s")(".3g", "cost")] = None
    peak_memory_bytes: Annotated[float | None, MEMORY(".1f", "memory")] = None
    error: Annotated[float | None, PERCENT(".3g")] = None
    step_error: Annotated[float | None, PERCENT(".2g", "step error")] = None
    period: float | None = None
    period_error: Annotated[float | None, PERCENT("z.2f", "period")] = None
    damping: Annotated[float | None, PERCENT("z.2f")] = None
    damping_error: float | None = None
    load_average: float | None = None
    machine: Mapping[str, Any] | None = None
    versions: Mapping[str, Any] | None = None
    number: int = 0
    front: Annotated[bool, FRONT] = False

    @classmethod
    def of(cls, found: Solved, truth: Solved, own: Solved | None = None) -> MotionRow:
        """Return the row of a run: its settings, cost, and errors; own: the same lattice in fine steps."""
        spec, requested, steps = found.ask.spec, found.ask.run, found.row.get("steps")
        history, reference, duration = found.history, truth.history, found.ask.duration or 0.0
        ended = cls(
            model=spec.model,
            size=spec.size,
            integrator=requested.get("integrator", ""),
            step=requested.get("step") or (duration / steps if history is not None and steps else None),
            status=found.status,
            message=found.message,
            steps=steps,
        )
        if history is None or reference is None:
            return ended
        off, (mine, theirs) = difference(history, reference), measured_alike(history, reference)
        fine = None if own is None else own.history
        damping = None if mine.damping is None or theirs.damping is None else mine.damping - theirs.damping
        return replace(
            ended,
            unknowns=found.row["unknowns"],
            **found.row["cost"],
            seconds_per_second=history.solve_seconds / duration,
            error=off["largest"],
            step_error=None if fine is None else largest(history, fine),
            period=mine.period,
            period_error=off["period"],
            damping=mine.damping,
            damping_error=damping,
        )

    @property
    def run(self) -> str:
        """The model with its size, and the integrator where there is a choice."""
        return " ".join(filter(None, [self.model, self.size, self.integrator]))

    @property
    def name(self) -> str:
        """The run and its steps."""
        return f"{self.run} with steps of {milliseconds(self.step or 0.0)}"

    @property
    def cost(self) -> float | None:
        """The solver's time in a simulated second."""
        return self.seconds_per_second

    def as_dict(self) -> dict[str, Any]:
        """For JSON; machine and versions where there is an answer."""
        found = asdict(self)
        del found["front"], found["number"]  # the document has the rows' numbers
        if self.machine is None:
            del found["machine"], found["versions"]
        return found
