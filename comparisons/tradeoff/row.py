"""A row of a trade-off: a model with its settings, how its solve ended, what it cost, how far off it is."""

from __future__ import annotations

import statistics
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from comparisons.external.plugins import shown_name
from comparisons.models.spec import counted, spec_of
from comparisons.runs.campaign import Run
from comparisons.runs.store import Finished
from sheetbench.scenes import Scene

# in the JSON where they are known
_OF_AN_ANSWER = ("load_factor", "model_error", "load_average", "probes", "machine", "versions", "traceback")


@dataclass(frozen=True)
class TradeoffRow:
    """What `timing.measure` found of a solve, and its errors, None where there is nothing to measure.

    A run that ended without an answer has its settings and its status. series: the family whose order is
    looked for; cell_size [m]: where the settings tell; solve_seconds: every sample; error, field_error:
    fractions; bar: by which the model says that it may be off, likewise; model_error: what it leaves out on
    every mesh, of a reference; started, finished: UTC.
    """

    model: str
    label: str
    settings: Mapping[str, Any]
    status: str
    message: str
    series: str
    cell_size: float | None
    started: str
    finished: str
    unknowns: int | None = None
    iterations: int | None = None
    solve_seconds: tuple[float, ...] = ()
    setup_seconds: float | None = None
    peak_memory_bytes: int | None = None
    error: float | None = None
    field_error: float | None = None
    bar: float | None = None
    model_error: float | None = None
    load_factor: float | None = None
    probes: Mapping[str, Any] | None = None
    load_average: float | None = None
    machine: Mapping[str, Any] | None = None
    versions: Mapping[str, Any] | None = None
    traceback: str | None = None

    @property
    def seconds(self) -> float | None:
        """Median of the solve's samples [s]."""
        return statistics.median(self.solve_seconds) if self.solve_seconds else None

    @property
    def size(self) -> str:
        """The grid, or both of a pair, or the elements, as requested; nothing where there are none."""
        sizes = (self.settings.get(name) for name in ("coarser", "grid", "elements"))
        return ":".join(counted(size) for size in sizes if size is not None)

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        found = asdict(self)
        known = {key: value for key, value in found.items() if key not in _OF_AN_ANSWER or value is not None}
        return known | {"solve_seconds": {"median": self.seconds, "samples": self.solve_seconds}}


def measured_row(
    scene: Scene, run: Run, outcome: Finished, error: float | None = None, field_error: float | None = None
) -> TradeoffRow:
    """The row of a run, with its errors."""
    model, settings = shown_name(run.arguments["model"]), run.arguments["settings"]
    found = {key: value for key, value in outcome.row.items() if key not in ("field", "solve_seconds")}
    if_known = {
        "model": model,
        "label": run.label,
        "settings": settings,
        **found,
        "status": outcome.status,
        "message": outcome.message,
        "solve_seconds": tuple(outcome.row.get("solve_seconds", {}).get("samples", ())),
    }
    return TradeoffRow(
        **if_known,
        series=spec_of(run.arguments["model"], settings).series,
        cell_size=cell_size(scene, settings),
        started=outcome.started,
        finished=outcome.finished,
        error=error,
        field_error=field_error,
    )


def cell_size(scene: Scene, settings: Mapping[str, Any]) -> float | None:
    """Size h [m] of a cell along the shorter side, where the settings tell."""
    shorter = min(scene.sheet.lengths)
    if (grid := settings.get("grid")) is not None:
        masses = min(grid[:2]) if isinstance(grid, list | tuple) else grid
        return shorter / (masses - 1)
    if (elements := settings.get("elements")) is not None:
        return shorter / (min(elements) if isinstance(elements, list | tuple) else elements)
    return None
