"""Rows of a trade-off, at rest and in motion: a model, how its solve ended, its cost and errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Annotated, Any

import numpy as np

from comparisons.comparison.measures import difference, largest, measured_alike
from comparisons.external.plugins import shown_name
from comparisons.sweep.solved import Solved
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, TableUnit
from sheetbench.scenes.language.summary import milliseconds

MEMORY = TableUnit("B", "MB", 1e-6)
FRONT = Column("front", words=("yes", ""))
OWN = ("label", "status", "message", "cell_size", "started", "finished", "error")
MEASURED = ("unknowns", "iterations", "setup_seconds", "peak_memory_bytes")
# in the JSON where they are known
_OF_AN_ANSWER = ("load_factor", "model_error", "load_average", "probes", "machine", "versions", "traceback")
TRADED = (
    *(NUMBER("d", "row"), Column("model", prose=True), "size", NUMBER("d", "unknowns")),
    *(NUMBER("d", "factorisations", detail=True), MILLISECONDS(".1f", "set-up", detail=True)),
    *(MILLISECONDS(".2f", "solve"), MILLISECONDS(".2f", "from", detail=True)),
    *(MILLISECONDS(".2f", "to", detail=True), MEMORY(".1f", "memory"), PERCENT(".3g", "error")),
    *(FRONT, Column("status", detail=True)),
)


@dataclass(frozen=True)
class TradeoffRow(Solved):
    """A row of the table of solves, at rest, with its error, a fraction, None where there is nothing to
    measure."""

    error: float | None = None

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
        return (spec.series, spec.size, unknowns, iterations, *times, memory, self.error)

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
class MotionRow:
    """A run of a model's motion beside the reference's.

    size: the grid, or the elements; step [s]: fixed, or the mean of steps that keep to an error;
    seconds_per_second: the solver's time in a simulated second; error: the largest of the displacement's,
    a fraction of the reference's largest; step_error: likewise against the same lattice in fine steps;
    period [s] and damping ratio as `comparisons.comparison.measures` has them, and how far they are off: the
    period by a fraction, the damping by a difference. None where a run has no answer, or does not swing.
    """

    model_error, samples = None, ()
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
        return f"{self.run} with steps of {milliseconds(self.step)}" if self.step else self.run

    @property
    def sized(self) -> tuple[float | None, float | None]:
        """The step [s] and what it misses."""
        return self.step, self.step_error

    @property
    def mark(self) -> str:
        return milliseconds(self.step) if self.step else self.size

    @property
    def cost(self) -> float | None:
        """The solver's time in a simulated second."""
        return self.seconds_per_second

    def as_dict(self) -> dict[str, Any]:
        """For JSON; machine and versions where there is an answer."""
        found = asdict(self)
        del found["front"]  # the document has the rows' numbers
        if self.machine is None:
            del found["machine"], found["versions"]
        return found
