"""The table of solves: a `Request` is for a model on a scene, a `Solved` is its row.

`sweep` returns the rows of requested solves; solves in a campaign's store are not repeated. Error bars
(`comparisons.sweep.limits`), errors and fronts (`comparisons.sweep.front`) are computed from rows.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, fields
from statistics import median
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from comparisons.external import plugins
from comparisons.models.spec import Elements, External, Spec
from sheetbench.answers.history import History
from sheetbench.answers.solution import Status, comparable
from sheetbench.scenes import Scene

if TYPE_CHECKING:  # imports of multiprocessing and sqlite3 take a fortieth of `compare`
    from comparisons.sweep.campaign import CampaignKeywords, Run
    from comparisons.sweep.store import Store

TASK = "comparisons.sweep.task:solve"


@dataclass(frozen=True)
class Request:
    """A requested solve: at rest, or of a motion over `duration` [s], sampled at intervals `every` [s].

    repeats: least number of timed solves, 0 without timing; columns: additional ones of
    `comparisons.sweep.columns`; run: keywords of a motion's `simulate`, as integrator, step and error;
    version: of an external code, part of the row's key; tags: varied parameters, stored with the row; label:
    shown in place of the model's.
    """

    scene: Scene
    spec: Spec
    repeats: int = 0
    columns: tuple[str, ...] = ()
    duration: float | None = None
    every: float | None = None
    run: Mapping[str, Any] = field(default_factory=dict)
    version: str | None = None
    tags: Mapping[str, Any] = field(default_factory=dict)
    label: str = ""

    @property
    def task(self) -> Run:
        """The campaign run that computes the row."""
        from comparisons.sweep.campaign import Run

        options: dict[str, Any] = {"repeats": self.repeats, "columns": list(self.columns)}
        options |= {"duration": self.duration, "every": self.every, "run": dict(self.run)}
        options |= {"version": self.version, "digest": plugins.digest(self.spec.model)}
        arguments = {"scene": self.scene.document(), "model": self.spec.model, "settings": self.spec.settings}
        arguments |= {name: value for name, value in options.items() if value}
        return Run(TASK, arguments, self.label or self.spec.label, self.repeats > 0)

    @property
    def layered(self) -> bool:
        """Whether the elements are quadratic and have the edge layer of `fem_reference.edge_layer`."""
        if isinstance(self.spec, External):
            return bool(getattr(plugins.plugin(self.spec.model), "layered", False))
        return isinstance(self.spec, Elements)


@dataclass(frozen=True)
class Solved:
    """A row of the table: the requested solve, its status, and the result of `comparisons.sweep.task.solve`.
    row: plain data in SI units, for a fault a traceback alone; started, finished: UTC; run_seconds: total
    time of the run."""

    request: Request
    status: str
    message: str = ""
    row: Mapping[str, Any] = field(default_factory=dict)
    started: str = ""
    finished: str = ""
    run_seconds: float | None = None

    @property
    def usable(self) -> bool:
        """Whether the row can be compared: an equilibrium under the whole load, or a complete motion."""
        return "probes" in self.row and comparable(self.status, self.row.get("load_factor", 1.0))

    @property
    def stable(self) -> bool:
        """Whether the answer is a stable equilibrium under the whole load, or a converged motion."""
        return self.usable and self.status == Status.CONVERGED

    @property
    def document(self) -> dict[str, Any]:
        """The solver's own document of its answer."""
        return {key: v for key, v in self.row.items() if key not in ("columns", "cost", "traceback")}

    @property
    def label(self) -> str:
        """The solver's label with its settings, without an answer the request's label."""
        return str(self.row.get("label", self.request.label or self.request.spec.label))

    @property
    def ending(self) -> str:
        """Label, status and message as a clause."""
        return ": ".join(filter(None, [self.label, self.status, self.message]))

    @property
    def u(self) -> np.ndarray:
        """Displacement (n, 3) [m] at the probes, in motion at all samples."""
        probes = [np.array(values, dtype=float) for values in self.row["probes"].values()]
        return np.array(probes) if self.request.duration is None else np.concatenate(probes)

    @property
    def field(self) -> np.ndarray:
        """Displacement (n, 3) [m] at `field_points`, for solves with the column `field`."""
        return np.array(self.row["columns"]["field"], dtype=float)

    @property
    def counts(self) -> list[int]:
        """Cells along x and y, empty if the settings have no size."""
        settings = self.row.get("settings") or self.request.spec.settings
        if isinstance(self.request.spec, Elements):
            return self.request.spec.counts(self.request.scene)[:2]
        return list(settings.get("elements") or [n - 1 for n in settings.get("grid", ())])[:2]

    @property
    def size(self) -> float:
        """Mean size of a cell [m]."""
        return float(np.sqrt(np.prod(self.request.scene.sheet.lengths) / np.prod(self.counts)))

    @property
    def samples(self) -> tuple[float, ...]:
        """Times of the timed solves, without set-up [s]."""
        return tuple(self.conditions.get("samples", ()))

    @property
    def seconds(self) -> float | None:
        """Median of the samples [s]."""
        return median(self.samples) if self.samples else None

    @property
    def conditions(self) -> dict[str, Any]:
        """Costs of the solve and its conditions (`comparisons.sweep.load`)."""
        return self.row.get("cost") or {}

    @property
    def history(self) -> History | None:
        """The motion, None if it is incomplete."""
        if not self.usable:
            return None
        values = {entry.name: self.row[entry.name] for entry in fields(History) if entry.name in self.row}
        for name in ("probes", "energies", "reactions", "actuators"):
            values[name] = {key: np.array(series) for key, series in values[name].items()}
        return History(**values | {"status": Status(self.status), "time": np.array(values["time"])})


def sweep(requests: Sequence[Request], store: Store, **campaign: Unpack[CampaignKeywords]) -> list[Solved]:
    """Return the rows of requested solves, in their order, through a campaign's store; campaign: keywords of
    `comparisons.sweep.campaign.carry_out`."""
    from comparisons.sweep.campaign import carry_out

    runs = carry_out([request.task for request in requests], store, **campaign)
    return [
        Solved(request, run.status, run.message, run.row, run.started, run.finished, run.seconds)
        for request, run in zip(requests, runs, strict=True)
    ]
