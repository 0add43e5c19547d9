"""Error against cost: many models of one scene, measured alike, beside the finest reference.

    error        at the probes, as `comparisons.displacement` defines it
    field error  (∫ |u − u_ref|² dA / ∫ |u_ref|² dA)^½ over the undeformed sheet
    uncertainty  of the reference, in both measures: its distance from the same model on half as many
                 elements a side. The true one is smaller if the order of convergence is one at least.
    cost         see `comparisons.timing`

Orders: the slope of log error over log h, h the size of a cell, and of log time over log unknowns, over the
rows of a family whose errors are well above the uncertainty.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from comparisons import timing
from comparisons.campaign import Progress, Run, carry_out
from comparisons.candidates import Candidate, series
from comparisons.displacement import error as probe_error
from comparisons.executors import Pool, processes
from comparisons.models import check
from comparisons.pareto import FLOOR_FACTOR, front, grouped, order
from comparisons.store import Finished, Store
from scenes import Scene, Status, require_static

COMPARABLE = (str(Status.CONVERGED), str(Status.UNSTABLE), str(Status.STRAIN_OUTSIDE_MODEL))
REFERENCE_ELEMENTS = 32  # at least; twice as many as the finest shell among the rows


@dataclass(frozen=True)
class Tradeoff:
    """The rows of a scene with their errors, and the reference they are measured against.

    rows: as `timing.measure` leaves them, with "error", "field_error" and "series" added and the field taken
    out. reference: the same of the reference. uncertainty, field_uncertainty: fractions, None
    where the reference did not converge on both meshes.
    """

    scene: Scene
    rows: tuple[dict[str, Any], ...]
    reference: dict[str, Any]
    uncertainty: float | None
    field_uncertainty: float | None

    @property
    def front(self) -> list[int]:
        """Numbers of the rows on the Pareto front of error and time, the quickest first."""
        seconds = [_seconds(row) for row in self.rows]
        return front([row["error"] for row in self.rows], seconds, self.uncertainty or 0.0)

    @property
    def orders(self) -> list[dict[str, Any]]:
        """A row per family: order of the error in h, of the field error in h, of the time in the unknowns."""
        found = []
        for name, numbers in grouped([row["series"] for row in self.rows]).items():
            rows = [self.rows[i] for i in numbers if self.rows[i]["error"] is not None]
            sized = [row for row in rows if row["cell_size"]]
            entry: dict[str, Any] = {"series": name, "rows": len(rows)}
            for key, floor in (("error", self.uncertainty), ("field_error", self.field_uncertainty)):
                clear = [row for row in sized if row[key] > FLOOR_FACTOR * (floor or 0.0)]
                entry[f"{key}_order"] = order([r["cell_size"] for r in clear], [r[key] for r in clear])
            entry["time_order"] = order([r["unknowns"] for r in rows], [_seconds(r) for r in rows])
            found.append(entry)
        return found

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench tradeoff`."""
        return {
            "scene": self.scene.model_dump(mode="json", by_alias=True, exclude_none=True),
            "rows": list(self.rows),
            "front": self.front,
            "orders": self.orders,
            "reference": {
                **self.reference,
                "uncertainty": self.uncertainty,
                "field_uncertainty": self.field_uncertainty,
            },
        }


def tradeoff(
    scene: Scene,
    candidates: Sequence[Candidate],
    store: Store,
    *,
    reference: Candidate | None = None,
    repeats: int = 5,
    workers: int = 1,
    pool: Pool = processes,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> Tradeoff:
    """Measure every candidate on a scene, through the campaign's store.

    reference: by default the shell with twice as many elements as the finest shell among the candidates, and
    32 at least; its `elements` must be even. Raises SceneError for a scene without a static answer and
    BadInput for a model or setting that does not exist. A solve that fails is a row with its status.
    """
    require_static(scene)
    for candidate in candidates:
        check(candidate.model, candidate.settings)
    fine = reference or _finest(candidates)
    check(fine.model, fine.settings)
    half = Candidate(fine.model, {**fine.settings, "elements": fine.settings["elements"] // 2})
    asked = [timing.run(scene, c.model, c.settings, timed=False) for c in (fine, half)]
    asked += [timing.run(scene, c.model, c.settings, repeats) for c in candidates]
    outcomes = carry_out(asked, store, workers=workers, pool=pool, progress=progress)
    return assemble(scene, asked, outcomes)


def assemble(scene: Scene, asked: Sequence[Run], outcomes: Sequence[Finished]) -> Tradeoff:
    """The trade-off of finished runs: the reference, the same on half as many elements, then the rows."""
    weights = timing.field_points(scene.sheet)[1]
    truth, coarser = outcomes[:2]
    rows = []
    for run, outcome in zip(asked[2:], outcomes[2:], strict=True):
        errors = _errors(outcome, truth, weights)
        rows.append(_row(scene, run, outcome) | dict(zip(("error", "field_error"), errors, strict=True)))
    uncertainty, field_uncertainty = _errors(coarser, truth, weights)
    return Tradeoff(scene, tuple(rows), _row(scene, asked[0], truth), uncertainty, field_uncertainty)


def _finest(candidates: Sequence[Candidate]) -> Candidate:
    shells = [c.settings.get("elements", 16) for c in candidates if c.model == "shell"]
    return Candidate("shell", {"elements": max([REFERENCE_ELEMENTS, *(2 * n for n in shells)])})


def _errors(outcome: Finished, truth: Finished, weights: np.ndarray) -> tuple[float | None, float | None]:
    if not (_comparable(outcome) and _comparable(truth)):
        return None, None
    u, ref = (np.array(list(o.row["probes"].values()), dtype=float) for o in (outcome, truth))
    field, field_ref = (np.array(o.row["field"], dtype=float) for o in (outcome, truth))
    size = float(weights @ np.sum(field_ref**2, axis=1))
    off = float(weights @ np.sum((field - field_ref) ** 2, axis=1))
    return probe_error(u, ref), float(np.sqrt(off / size)) if size > 0.0 and np.isfinite(off) else None


def _comparable(outcome: Finished) -> bool:
    return outcome.status in COMPARABLE and outcome.row["load_factor"] == 1.0


def _row(scene: Scene, run: Run, outcome: Finished) -> dict[str, Any]:
    """The row of an outcome; a run that ended without an answer has what was asked and its status."""
    model, settings = run.arguments["model"], run.arguments["settings"]
    blank = {
        "model": model,
        "label": run.label,
        "settings": settings,
        "unknowns": None,
        "iterations": None,
        "solve_seconds": {"median": None, "samples": []},
        "setup_seconds": None,
        "peak_memory_bytes": None,
    }
    found = {key: value for key, value in outcome.row.items() if key != "field"}
    return {
        **blank,
        **found,
        "status": outcome.status,
        "message": outcome.message,
        "series": series(model, settings),
        "cell_size": cell_size(scene, settings),
        "started": outcome.started,
        "finished": outcome.finished,
    }


def cell_size(scene: Scene, settings: dict[str, Any]) -> float | None:
    """Size h [m] of a cell along the shorter side, where the settings tell."""
    shorter = min(scene.sheet.lengths)
    if (grid := settings.get("grid")) is not None:
        masses = min(grid[:2]) if isinstance(grid, list | tuple) else grid
        return shorter / (masses - 1)
    if (elements := settings.get("elements")) is not None:
        return shorter / (min(elements) if isinstance(elements, list | tuple) else elements)
    return None


def _seconds(row: dict[str, Any]) -> float:
    median = row["solve_seconds"]["median"]
    return float("inf") if median is None else float(median)
