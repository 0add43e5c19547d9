"""A row of a motion's trade: an integrator and a step, how its run ended, what it cost, how far off it is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from itertools import pairwise
from typing import Annotated, Any

import numpy as np

from comparisons.runs.campaign import Run
from comparisons.runs.store import Finished
from sheetbench.answers.table import MILLISECONDS, NUMBER, PERCENT, Column, Unit
from sheetbench.scenes import Status


@dataclass(frozen=True)
class MotionRow:
    """A run of a lattice's motion, step [s] by step, against the reference's history.

    seconds_per_second: the solver's time in a simulated second; error: of the displacement, a fraction;
    period [s] and damping ratio as `oscillation` has them, and how far they are off: the period by a
    fraction, the damping by a difference. None where a run has no answer, or does not swing.
    """

    integrator: str
    step: Annotated[float, MILLISECONDS(".4g")]
    status: Annotated[str, Column(detail=True)]
    message: str
    steps: Annotated[int | None, NUMBER("d", detail=True)] = None
    seconds_per_second: Annotated[float | None, Unit("s/s", "s/s")(".3g", "cost")] = None
    error: Annotated[float | None, PERCENT(".3g")] = None
    period: float | None = None
    period_error: Annotated[float | None, PERCENT("z.3f", "period")] = None
    damping: Annotated[float | None, PERCENT("z.3f")] = None
    damping_error: float | None = None
    load_average: float | None = None
    machine: Mapping[str, Any] | None = None
    versions: Mapping[str, Any] | None = None
    front: Annotated[bool, Column(words=("yes", ""))] = False

    def as_dict(self) -> dict[str, Any]:
        """For JSON; machine and versions where there is an answer."""
        found = asdict(self)
        del found["front"]  # the document has the rows' numbers
        if self.machine is None:
            del found["machine"], found["versions"]
        return found


def measured_row(run: Run, outcome: Finished, truth: Finished, duration: float) -> MotionRow:
    """The row of a run: what was asked, cost, and errors against the reference's history."""
    ended = MotionRow(
        integrator=run.arguments["integrator"],
        step=run.arguments["step"],
        status=outcome.status,
        message=outcome.message,
        steps=outcome.row.get("steps"),
    )
    if outcome.status != Status.CONVERGED or truth.status != Status.CONVERGED:
        return ended
    u, reference = (_history(o) for o in (outcome, truth))
    time = np.array(truth.row["time"])
    axis = int(np.argmax(np.abs(reference).max(axis=0)))
    period, damping = oscillation(time, u[:, axis])
    true_period, true_damping = oscillation(time, reference[:, axis])
    return replace(
        ended,
        seconds_per_second=outcome.row["solve_seconds"] / duration,
        error=float(np.abs(u - reference).max() / np.abs(reference).max()),
        period=period,
        period_error=None if period is None or true_period is None else period / true_period - 1.0,
        damping=damping,
        damping_error=None if damping is None or true_damping is None else damping - true_damping,
        load_average=outcome.row.get("load_average"),
        machine=outcome.row["machine"],
        versions=outcome.row["versions"],
    )


def _history(outcome: Finished) -> np.ndarray:
    """Displacement (n, 3) [m] of P4, or of the last probe where there is none of that name."""
    probes = outcome.row["probes"]
    return np.array(probes.get("P4") or list(probes.values())[-1], dtype=float)


def oscillation(time: np.ndarray, u: np.ndarray) -> tuple[float | None, float | None]:
    """Period [s] and damping ratio of u(t) (n,), None where it does not swing often enough to tell."""
    about = u - u[len(u) // 2 :].mean()
    up = np.flatnonzero((about[:-1] < 0.0) & (about[1:] >= 0.0))
    if len(up) < 2:
        return None, None
    share = about[up] / (about[up] - about[up + 1])
    passes = time[up] + share * (time[up + 1] - time[up])
    period = float(np.mean(np.diff(passes)))
    peaks = np.array([about[a:b].max() for a, b in pairwise(up)])
    if len(peaks) < 2 or peaks.min() <= 0.0:
        return period, None
    return period, float(np.log(peaks[0] / peaks[-1]) / (2.0 * np.pi * (len(peaks) - 1)))
