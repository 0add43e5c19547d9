"""A row of a motion's trade: model, integrator, step, how its run ended, what it cost, how far off it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Annotated, Any

from comparisons.models.spec import counted
from comparisons.motion.measures import difference, largest, measured_alike
from comparisons.motion.run import history_of
from comparisons.runs.campaign import Run
from comparisons.runs.store import Finished
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, Unit

OF_AN_ANSWER = ("unknowns", "peak_memory_bytes", "load_average", "machine", "versions")


@dataclass(frozen=True)
class MotionRow:
    """A run of a model's motion beside the reference's.

    size: the grid, or the elements; step [s]: fixed, or the mean of steps that keep to an error;
    seconds_per_second: the solver's time in a simulated second; error: the largest of the displacement's,
    a fraction of the reference's largest; step_error: likewise against the same lattice in fine steps;
    period [s] and damping ratio as `comparisons.motion.measures` has them, and how far they are off: the
    period by a fraction, the damping by a difference. None where a run has no answer, or does not swing.
    """

    model: str
    size: str
    integrator: str
    step: Annotated[float | None, MILLISECONDS(".3g")]
    status: Annotated[str, Column(detail=True)]
    message: str
    unknowns: Annotated[int | None, NUMBER("d", detail=True)] = None
    steps: Annotated[int | None, NUMBER("d", detail=True)] = None
    seconds_per_second: Annotated[float | None, Unit("s/s", "s/s")(".3g", "cost")] = None
    peak_memory_bytes: Annotated[float | None, Unit("B", "MB", 1e-6)(".1f", "memory")] = None
    error: Annotated[float | None, PERCENT(".3g")] = None
    step_error: Annotated[float | None, PERCENT(".2g", "step error")] = None
    period: float | None = None
    period_error: Annotated[float | None, PERCENT("z.2f", "period")] = None
    damping: Annotated[float | None, PERCENT("z.2f")] = None
    damping_error: float | None = None
    load_average: float | None = None
    machine: Mapping[str, Any] | None = None
    versions: Mapping[str, Any] | None = None
    front: Annotated[bool, Column(words=("yes", ""))] = False

    @property
    def name(self) -> str:
        """The model with its size, and the integrator where there is a choice."""
        return " ".join(filter(None, [self.model, self.size, self.integrator]))

    def as_dict(self) -> dict[str, Any]:
        """For JSON; machine and versions where there is an answer."""
        found = asdict(self)
        del found["front"]  # the document has the rows' numbers
        if self.machine is None:
            del found["machine"], found["versions"]
        return found


def measured_row(run: Run, outcome: Finished, truth: Finished, own: Finished | None = None) -> MotionRow:
    """The row of a run: its settings, cost, and errors; own: the same lattice in fine steps."""
    settings, requested = run.arguments["settings"], run.arguments["run"]
    row, history, reference = outcome.row, history_of(outcome), history_of(truth)
    steps, duration = row.get("steps"), run.arguments["duration"]
    found = MotionRow(
        model=run.arguments["model"],
        size=counted(settings.get("grid") or settings.get("elements") or ""),
        integrator=requested.get("integrator", ""),
        step=requested.get("step") or (duration / steps if history is not None and steps else None),
        status=outcome.status,
        message=outcome.message,
        steps=steps,
    )
    if history is None or reference is None:
        return found
    off, (mine, theirs) = difference(history, reference), measured_alike(history, reference)
    fine = None if own is None else history_of(own)
    damping_error = None if mine.damping is None or theirs.damping is None else mine.damping - theirs.damping
    return replace(
        found,
        **{name: row[name] for name in OF_AN_ANSWER},
        seconds_per_second=history.solve_seconds / duration,
        error=off["largest"],
        step_error=None if fine is None else largest(history, fine),
        period=mine.period,
        period_error=off["period"],
        damping=mine.damping,
        damping_error=damping_error,
    )
