"""Models of one motion with their errors and costs: the answer of `sheetbench tradeoff --duration`."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import inf
from typing import Any

from comparisons.runs import load
from comparisons.sweep.front import cheapest, error_order, front, grouped
from comparisons.tradeoff.motion_row import MotionRow
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import Table
from sheetbench.scenes import Scene, Status, comparable
from sheetbench.scenes.summary import few, milliseconds

SHOWN = (
    "model",
    "size",
    "integrator",
    "step",
    "steps",
    "unknowns",
    "seconds_per_second",
    "peak_memory_bytes",
    "error",
    "step_error",
    "period_error",
    "damping",
    "front",
    "status",
)


@dataclass(frozen=True, repr=False)
class DynamicTradeoff(Answer):
    """A row per model, size, integrator and step, and the reference that they are measured against.

    lowest_period [s]: the lattice's about the flat sheet or its equilibrium, the shorter; uncertainty: of the
    reference by its mesh and its steps, a fraction; lattices: what their runs are of; step_uncertainty: of
    the runs that errors of steps are measured against.
    """

    file_name = "motion"
    scene: Scene
    duration: float
    lowest_period: float
    rows: tuple[MotionRow, ...]
    reference: MotionRow
    uncertainty: float | None
    reasons: tuple[str, ...] = ()
    lattices: tuple[str, ...] = ()
    step_uncertainty: float = 0.0

    @property
    def warnings(self) -> list[str]:
        """What to hold against the times."""
        return load.warnings([row.load_average for row in self.rows])

    @property
    def front(self) -> list[int]:
        """Rows on the Pareto front of error and time per simulated second."""
        seconds = [row.seconds_per_second or inf for row in self.rows]
        return front([row.error for row in self.rows], seconds, self.uncertainty or 0.0)

    @property
    def series(self) -> dict[str, list[int]]:
        """Row numbers by lattice and integrator, and by other model."""
        return grouped([row.name if row.step_error is not None else row.model for row in self.rows])

    @property
    def orders(self) -> dict[str, float | None]:
        """Observed order in the step of what the steps of a lattice miss, by series."""
        found = {}
        for name, numbers in self.series.items():
            rows = [self.rows[i] for i in numbers if self.rows[i].step_error is not None]
            if rows:
                errors = [row.step_error for row in rows]
                found[name] = error_order([row.step for row in rows], errors, self.step_uncertainty)
        return found

    def document(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "scene": self.scene.document(),
            "duration": self.duration,
            "lowest_period": self.lowest_period,
            "lattices": self.lattices,
            "warnings": self.warnings,
            "rows": [row.as_dict() for row in self.rows],
            "front": self.front,
            "orders": [{"series": name, "step_error_order": slope} for name, slope in self.orders.items()],
            "reference": {**self.reference.as_dict(), "uncertainty": self.uncertainty},
            "step_uncertainty": self.step_uncertainty,
        }

    def tables(self) -> tuple[Table, ...]:
        """A row per run."""
        front = self.front
        rows = [replace(row, front=i in front) for i, row in enumerate(self.rows)]
        caption = (
            f"Motion over {self.duration:g} s. cost: time per simulated second; step error: the part by "
            "the lattice's steps; period: its error; damping: damping ratio"
        )
        return (Table.of(MotionRow, rows, caption, "motion", fields=SHOWN),)

    def figures(self) -> tuple[Picture, ...]:
        drawn = Picture("motion", "comparisons.tradeoff.motion_figure:compose", (self,))
        return (drawn,) if any(row.error for row in self.rows) else ()

    def notes(self) -> list[str]:
        known = "unknown" if self.uncertainty is None else f"{few(100 * self.uncertainty)} %"
        lattices = " · ".join(self.lattices)
        of = f"{self.reference.model} with {self.reference.size} elements"
        return [
            f"errors: at the probes, against the {of}; uncertainty of that reference: {known}",
            *([f"{lattices}; lowest period {self.lowest_period:.4g} s"] if lattices else []),
            *self.reasons,
            *self._cheapest(),
            *self.warnings,
        ]

    def result(self) -> str:
        return " ".join(self._cheapest()) or super().result()

    def _cheapest(self) -> list[str]:
        names = [f"{row.name} with steps of {milliseconds(row.step or 0.0)}" for row in self.rows]
        seconds = [row.seconds_per_second for row in self.rows]
        bar = inf if self.uncertainty is None else self.uncertainty
        errors = [row.error for row in self.rows]
        return cheapest(names, errors, seconds, " per simulated second", bar)

    def complaints(self) -> tuple[str, ...]:
        return folded([*self.rows, self.reference])

    def choices(self) -> dict[str, Any]:
        return {"duration": self.duration}

    @property
    def succeeded(self) -> bool:
        """Whether there is a reference to measure against."""
        return comparable(self.reference.status, 1.0)


def folded(rows: Sequence[MotionRow]) -> tuple[str, ...]:
    """A line for all steps of a model that ended alike."""
    ends: dict[tuple[str, str, str], list[MotionRow]] = {}
    for row in rows:
        if row.status != Status.CONVERGED:
            why = re.sub(r"^(at [\d.e+-]+ s:|from [\d.e+-]+ s on) ", "", row.message)
            ends.setdefault((row.name, row.status, why), []).append(row)
    return tuple(f"{name}{_steps(alike)}: {status}: {why}" for (name, status, why), alike in ends.items())


def _steps(rows: Sequence[MotionRow]) -> str:
    fixed = [f"{1e3 * row.step:.3g}" for row in rows if row.step is not None]
    return f", {'steps' if len(fixed) > 1 else 'step'} {', '.join(fixed)} ms" if fixed else ""
