"""The trade of a motion: time step and integrator against error and time, on one lattice.

Of P4 (or the probe that moves most), over the whole run and against the finest reference:

    error     largest |component of u(t) − u_ref(t)| / largest |component of u_ref(t)|
    period    mean time between upward passes of the largest component through its mean
    damping   ratio ζ from the logarithmic decrement of successive maxima above the mean, ln(a₁/aₙ)/2π(n − 1)

Cost is the solver's time per simulated second. The reference is the energy-conserving midpoint rule with
`REFERENCE` steps in the lowest period; its uncertainty its distance from half as many, an upper bound for any
order above one. Steps are the lowest period over `divisions`; the explicit integrator takes shares of its
stability limit instead.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from comparisons.models.grids import Asked, scene_grid
from comparisons.models.registry import simulate
from comparisons.report.report import Report
from comparisons.report.table import Column, Table
from comparisons.runs import manifest
from comparisons.runs.campaign import Progress, Run, carry_out
from comparisons.runs.executors import Pool, processes
from comparisons.runs.store import Finished, Store
from comparisons.tradeoff.pareto import front, grouped, order
from sheetbench.scenes import Scene, Status
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grid import Grid

DIVISIONS = (20, 40, 100, 200, 400)  # steps in the lowest period
SHARES = (0.9, 0.45)  # of the explicit integrator's limit
REFERENCE = 3200
SAMPLES = 20  # in the lowest period; no step is longer than the time between samples


@dataclass(frozen=True)
class DynamicTradeoff:
    """rows: a dictionary per integrator and step, as `measure` leaves it, with errors; lowest period [s]."""

    scene: Scene
    duration: float
    lowest_period: float
    rows: tuple[dict[str, Any], ...]
    reference: dict[str, Any]
    uncertainty: float | None

    @property
    def front(self) -> list[int]:
        """Rows on the Pareto front of error and time per simulated second."""
        seconds = [row["seconds_per_second"] or float("inf") for row in self.rows]
        return front([row["error"] for row in self.rows], seconds, self.uncertainty or 0.0)

    @property
    def orders(self) -> list[dict[str, Any]]:
        """Observed order of the error in the step, per integrator."""
        found = []
        for name, numbers in grouped([row["integrator"] for row in self.rows]).items():
            rows = [
                self.rows[i] for i in numbers if (self.rows[i]["error"] or 0.0) > 3 * (self.uncertainty or 0)
            ]
            slope = order([r["step"] for r in rows], [r["error"] for r in rows])
            found.append({"series": name, "error_order": slope})
        return found

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "scene": self.scene.document(),
            "duration": self.duration,
            "lowest_period": self.lowest_period,
            "rows": list(self.rows),
            "front": self.front,
            "orders": self.orders,
            "reference": {**self.reference, "uncertainty": self.uncertainty},
        }

    def report(self) -> Report:
        """What `sheetbench tradeoff --duration` shows."""
        known = "unknown" if self.uncertainty is None else f"{100 * self.uncertainty:.2g} %"
        return Report(
            name="motion",
            title=self.scene.name,
            subtitle=self.scene.title,
            document=self.as_dict(),
            tables=(self.table(),),
            notes=(f"lowest period {self.lowest_period:.4g} s; uncertainty of the reference {known}",),
            complaints=tuple(
                f"{row['integrator']}, step {row['step']:.3g} s: {row['status']}: {row['message']}"
                for row in self.rows
                if row["status"] != "converged"
            ),
            scene=self.scene,
            settings={"duration": self.duration},
        )

    def table(self) -> Table:
        """A row per integrator and step."""
        chosen = set(self.front)
        found = tuple(
            (
                row["integrator"],
                row["step"],
                row["steps"],
                row["seconds_per_second"],
                row["error"],
                row["period_error"],
                row["damping"],
                "yes" if i in chosen else "",
                row["status"],
            )
            for i, row in enumerate(self.rows)
        )
        columns = (
            Column("integrator"),
            Column("step", "s", "ms", 1e3, ".4g"),
            Column("steps", form="d", detail=True),
            Column("cost", "s/s", "s/s", 1.0, ".3g"),
            Column("error", "", "%", 100.0, ".3g"),
            Column("period", "", "%", 100.0, "z.3f"),
            Column("damping", "", "%", 100.0, "z.3f"),
            Column("front"),
            Column("status", detail=True),
        )
        caption = (
            f"Over {self.duration:g} s. cost: per simulated second; period: off by; damping: of critical"
        )
        return Table(caption, columns, found, "motion")


def measure(
    scene: dict[str, Any], grid: list[int], integrator: str, step: float, duration: float, every: float
) -> dict[str, Any]:
    """Task: one run and what it cost; the history of the probes included."""
    asked = Scene.model_validate(scene)
    common: dict[str, Any] = {"grid": (grid[0], grid[1], grid[2]), "integrator": integrator, "every": every}
    simulate(asked, 2.0 * every, **common, step=step)  # warm
    history = simulate(asked, duration, **common, step=step)
    return {
        "status": str(history.status),
        "message": history.message,
        "steps": history.steps,
        "solve_seconds": history.solve_seconds,
        "time": history.time,
        "probes": history.probes,
        "machine": manifest.machine(),
        "versions": {"sheetbench": manifest.version(), **manifest.versions()},
    }


def dynamic_tradeoff(
    scene: Scene,
    duration: float,
    store: Store,
    *,
    grid: Asked = None,
    integrators: Sequence[str] = ("generalised-alpha", "midpoint", "projective", "verlet"),
    divisions: Sequence[int] = DIVISIONS,
    reference: int = REFERENCE,
    workers: int = 1,
    pool: Pool = processes,
    retry: bool = False,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> DynamicTradeoff:
    """Measure every integrator at every step on a lattice of consistent springs.

    retry: what failed or was lost before is run again.
    Raises BadInput for an integrator that does not exist. A run that diverges is a row with its status.
    """
    import lumped
    from lumped import INTEGRATORS

    if unknown := [name for name in integrators if name not in INTEGRATORS]:
        raise BadInput(f"integrator = {unknown[0]!r}: choose from {', '.join(INTEGRATORS)}")
    shape = scene_grid(scene, grid)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=shape)
    period = 1.0 / float(lumped.modes(scene, springs, 1).frequencies[0])
    every = period / SAMPLES

    def run(integrator: str, step: float, timed: bool) -> Run:
        arguments = {
            "scene": scene.document(),
            "grid": list(shape),
            "integrator": integrator,
            "step": step,
            "duration": duration,
            "every": every,
        }
        return Run("motion", arguments, f"{integrator} {step:.3g} s", timed)

    judges = [run("midpoint", period / n, False) for n in (reference, reference // 2)]
    asked = []
    for name in integrators:
        if INTEGRATORS[name].explicit:
            limit = explicit_limit(scene, shape)
            asked += [run(name, share * limit, True) for share in SHARES]
        else:
            asked += [run(name, period / n, True) for n in divisions]
    found = carry_out([*judges, *asked], store, workers=workers, pool=pool, retry=retry, progress=progress)
    truth = found[0]
    rows = tuple(_row(r, outcome, truth, duration) for r, outcome in zip(asked, found[2:], strict=True))
    uncertainty = _row(judges[1], found[1], truth, duration)["error"]
    return DynamicTradeoff(
        scene, duration, period, rows, _row(judges[0], truth, truth, duration), uncertainty
    )


def explicit_limit(scene: Scene, grid: Grid) -> float:
    """Stability limit [s] of the explicit integrator about the flat sheet."""
    import lumped

    problem = lumped.pose(scene, lumped.calibrate(scene.sheet, scene.material, grid=grid))
    return lumped.step_limit(lumped.System(scene, problem), np.zeros_like(problem.loads.dead)).step


def _row(run: Run, outcome: Finished, truth: Finished, duration: float) -> dict[str, Any]:
    """The row of a run: what was asked, cost, and errors against the reference's history."""
    found: dict[str, Any] = {
        "integrator": run.arguments["integrator"],
        "step": run.arguments["step"],
        "steps": outcome.row.get("steps"),
        "status": outcome.status,
        "message": outcome.message,
        "seconds_per_second": None,
        **dict.fromkeys(("error", "period", "period_error", "damping", "damping_error")),
    }
    if outcome.status != Status.CONVERGED or truth.status != Status.CONVERGED:
        return found
    u, reference = (_history(o) for o in (outcome, truth))
    time = np.array(truth.row["time"])
    axis = int(np.argmax(np.abs(reference).max(axis=0)))
    period, damping = oscillation(time, u[:, axis])
    true_period, true_damping = oscillation(time, reference[:, axis])
    found |= {
        "seconds_per_second": outcome.row["solve_seconds"] / duration,
        "error": float(np.abs(u - reference).max() / np.abs(reference).max()),
        "period": period,
        "damping": damping,
        "machine": outcome.row["machine"],
        "versions": outcome.row["versions"],
    }
    if period is not None and true_period is not None:
        found["period_error"] = period / true_period - 1.0
    if damping is not None and true_damping is not None:
        found["damping_error"] = damping - true_damping
    return found


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
