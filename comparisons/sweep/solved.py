"""The table of solves: a model on a scene that is wanted is an `Ask`, its row a `Solved`.

A scene goes down once with all that is wanted of it, and rows come up (`sweep`); what a campaign's store has
is not solved again. Every question that solves several models is a reading of these rows: error bars
(`comparisons.sweep.limits`), errors and fronts (`comparisons.sweep.front`).
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

if TYPE_CHECKING:  # multiprocessing and sqlite3 are a fortieth of what `compare` takes
    from comparisons.sweep.campaign import CampaignKeywords, Run
    from comparisons.sweep.store import Store

TASK = "comparisons.sweep.task:solve"


@dataclass(frozen=True)
class Ask:
    """A solve that is wanted: at rest, or over a `duration` [s] of motion, sampled `every` so often [s].

    repeats: timed solves at least, 0 where the time does not matter; columns: further ones of
    `comparisons.sweep.columns`; run: what a motion's `simulate` takes, as integrator, step and error;
    version: of an external code, under which the row is kept; tags: what was varied, for the reader of the
    row; label: what people read, unless it is the model's.
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
        """The run of a campaign that makes the row."""
        from comparisons.sweep.campaign import Run

        own = {"repeats": self.repeats, "columns": list(self.columns), "duration": self.duration}
        own |= {"every": self.every, "run": dict(self.run), "version": self.version}
        given = {name: value for name, value in own.items() if value}
        arguments = {"scene": self.scene.document(), "model": self.spec.model, "settings": self.spec.settings}
        if (digest := plugins.digest(self.spec.model)) is not None:
            given["digest"] = digest
        return Run(TASK, arguments | given, self.label or self.spec.label, self.repeats > 0)

    @property
    def layered(self) -> bool:
        """Whether the elements are quadratic and have the layer of `fem_reference.edge_layer`."""
        if isinstance(self.spec, External):
            return bool(getattr(plugins.plugin(self.spec.model), "layered", False))
        return isinstance(self.spec, Elements)


@dataclass(frozen=True)
class Solved:
    """A row: what was wanted, how it ended, and what `comparisons.sweep.task.solve` found, plain data in SI
    units, nothing but a traceback where there was a fault; started, finished:
    UTC; run_seconds: what the run took in all."""

    ask: Ask
    status: str
    message: str = ""
    row: Mapping[str, Any] = field(default_factory=dict)
    started: str = ""
    finished: str = ""
    run_seconds: float | None = None

    @property
    def usable(self) -> bool:
        """Whether it may be compared with others: an equilibrium under the whole load, or a motion to its
        end."""
        return "probes" in self.row and comparable(self.status, self.row.get("load_factor", 1.0))

    @property
    def stable(self) -> bool:
        """Whether it is a stable, physical equilibrium under the whole load."""
        return self.usable and self.status == Status.CONVERGED

    @property
    def document(self) -> dict[str, Any]:
        """The solver's own document of its answer."""
        return {key: v for key, v in self.row.items() if key not in ("columns", "cost", "traceback")}

    @property
    def label(self) -> str:
        """The solver's own, with its settings, or what was wanted."""
        return str(self.row.get("label", self.ask.label or self.ask.spec.label))

    @property
    def ending(self) -> str:
        """How it ended, in a clause."""
        return ": ".join(filter(None, [self.label, self.status, self.message]))

    @property
    def u(self) -> np.ndarray:
        """Displacement (n, 3) [m] at the probes, in motion at all samples."""
        probes = [np.array(values, dtype=float) for values in self.row["probes"].values()]
        return np.array(probes) if self.ask.duration is None else np.concatenate(probes)

    @property
    def field(self) -> np.ndarray:
        """Displacement (n, 3) [m] all over the sheet, where the column `field` was wanted."""
        return np.array(self.row["columns"]["field"], dtype=float)

    @property
    def counts(self) -> list[int]:
        """Cells along x and y; nothing where the settings do not tell."""
        settings = self.row.get("settings") or self.ask.spec.settings
        if isinstance(self.ask.spec, Elements):
            return self.ask.spec.counts(self.ask.scene)[:2]
        return list(settings.get("elements") or [n - 1 for n in settings.get("grid", ())])[:2]

    @property
    def size(self) -> float:
        """Mean size [m] of a cell."""
        return float(np.sqrt(np.prod(self.ask.scene.sheet.lengths) / np.prod(self.counts)))

    @property
    def samples(self) -> tuple[float, ...]:
        """Times [s] of the solve alone, every one."""
        return tuple(self.conditions.get("samples", ()))

    @property
    def seconds(self) -> float | None:
        """Median of the samples [s]."""
        return median(self.samples) if self.samples else None

    @property
    def conditions(self) -> dict[str, Any]:
        """What the solve took, and of which machine (`comparisons.sweep.load`)."""
        return self.row.get("cost") or {}

    @property
    def history(self) -> History | None:
        """The motion, None where it did not reach its end."""
        if not self.usable:
            return None
        names = (one.name for one in fields(History) if one.name in self.row)
        found: dict[str, Any] = {name: self.row[name] for name in names}
        for name in ("probes", "energies", "reactions", "actuators"):
            found[name] = {key: np.array(values) for key, values in found[name].items()}
        return History(**found | {"status": Status(self.status), "time": np.array(found["time"])})


def sweep(asks: Sequence[Ask], store: Store, **how: Unpack[CampaignKeywords]) -> list[Solved]:
    """Return a row for every solve that is wanted, in their order, through a campaign's store; how: as
    `comparisons.sweep.campaign.carry_out` takes it."""
    from comparisons.sweep.campaign import carry_out

    done = carry_out([ask.task for ask in asks], store, **how)
    return [
        Solved(ask, one.status, one.message, one.row, one.started, one.finished, one.seconds)
        for ask, one in zip(asks, done, strict=True)
    ]
