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
from math import inf
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models.candidate import Candidate
from comparisons.models.grading import Grading, grading_of, plain
from comparisons.models.grids import Asked, scene_grid
from comparisons.models.registry import check, simulate
from comparisons.report.look import Look
from comparisons.report.report import Picture, Report
from comparisons.report.table import Column, Table
from comparisons.runs import manifest
from comparisons.runs.campaign import Progress, Run, carry_out
from comparisons.runs.executors import Pool, processes
from comparisons.runs.store import Store
from comparisons.tradeoff.motion_row import MotionRow, measured_row
from comparisons.tradeoff.pareto import error_order, front, grouped
from sheetbench.choices import INTEGRATORS
from sheetbench.scenes import Scene, Status
from sheetbench.scenes.errors import require_choice
from sheetbench.scenes.grading import Graded
from sheetbench.scenes.grid import Grid
from sheetbench.scenes.quantities import require_positive

DIVISIONS = (20, 40, 100, 200, 400)  # steps in the lowest period
SHARES = (0.9, 0.45)  # of the explicit integrator's limit
REFERENCE = 3200
SAMPLES = 20  # in the lowest period; no step is longer than the time between samples


@dataclass(frozen=True)
class DynamicTradeoff:
    """A row per integrator and step, the reference that they are measured against; lowest period [s]."""

    scene: Scene
    duration: float
    lowest_period: float
    rows: tuple[MotionRow, ...]
    reference: MotionRow
    uncertainty: float | None
    reasons: tuple[str, ...] = ()

    @property
    def front(self) -> list[int]:
        """Rows on the Pareto front of error and time per simulated second."""
        seconds = [row.seconds_per_second or inf for row in self.rows]
        return front([row.error for row in self.rows], seconds, self.uncertainty or 0.0)

    @property
    def orders(self) -> dict[str, float | None]:
        """Observed order of the error in the step, by integrator."""
        found = {}
        for name, numbers in grouped([row.integrator for row in self.rows]).items():
            rows = [self.rows[i] for i in numbers]
            found[name] = error_order([r.step for r in rows], [r.error for r in rows], self.uncertainty)
        return found

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "scene": self.scene.document(),
            "duration": self.duration,
            "lowest_period": self.lowest_period,
            "rows": [row.as_dict() for row in self.rows],
            "front": self.front,
            "orders": [{"series": name, "error_order": slope} for name, slope in self.orders.items()],
            "reference": {**self.reference.as_dict(), "uncertainty": self.uncertainty},
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
            notes=(
                *self.reasons,
                f"lowest period {self.lowest_period:.4g} s; uncertainty of the reference {known}",
            ),
            pictures=(Picture(("motion.png", "motion.pdf"), self._draw),)
            if any(r.error for r in self.rows)
            else (),
            complaints=tuple(
                f"{row.integrator}, step {row.step:.3g} s: {row.status}: {row.message}"
                for row in self.rows
                if row.status != Status.CONVERGED
            ),
            scene=self.scene,
            settings={"duration": self.duration},
        )

    def _draw(self, paths: Sequence[Path], look: Look) -> None:
        from comparisons.tradeoff.motion_figure import draw

        draw(self, paths, look)

    def table(self) -> Table:
        """A row per integrator and step."""
        chosen = set(self.front)
        found = tuple(
            (
                row.integrator,
                row.step,
                row.steps,
                row.seconds_per_second,
                row.error,
                row.period_error,
                row.damping,
                "yes" if i in chosen else "",
                row.status,
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
    scene: dict[str, Any],
    grid: list[int],
    integrator: str,
    step: float,
    duration: float,
    every: float,
    grading: Grading = None,
) -> dict[str, Any]:
    """Task: one run and what it cost; the history of the probes included."""
    asked = Scene.model_validate(scene)
    common: dict[str, Any] = {"grid": (grid[0], grid[1], grid[2]), "integrator": integrator, "every": every}
    common |= {"grading": grading, "large": True}  # `dynamic_tradeoff` has looked at the size
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
    grading: Grading = None,
    integrators: Sequence[str] = tuple(sorted(INTEGRATORS)),
    divisions: Sequence[int] = DIVISIONS,
    reference: int = REFERENCE,
    workers: int = 1,
    pool: Pool = processes,
    retry: bool = False,
    large: bool = False,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> DynamicTradeoff:
    """Measure every integrator at every step on a lattice of consistent springs.

    retry: what failed or was lost before is run again. large: even if it takes more memory than there is.
    Raises BadInput for an integrator that does not exist. A run that diverges is a row with its status.
    """
    import lumped

    require_positive("duration", duration, "s")
    for name in integrators:
        require_choice("integrator", name, INTEGRATORS)
    shape = scene_grid(scene, grid)
    check(scene, Candidate("lumped", {"grid": shape, "grading": grading}), large)
    number, why = grading_of(scene, shape, grading)
    graded = number or 0.0
    springs = lumped.calibrate(scene.sheet, scene.material, grid=shape, grading=graded)
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
            **({"grading": plain(graded)} if graded else {}),
        }
        return Run("motion", arguments, f"{integrator} {step:.3g} s", timed)

    judges = [run("midpoint", period / n, False) for n in (reference, reference // 2)]
    asked = []
    for name in integrators:
        if lumped.INTEGRATORS[name].explicit:
            limit = explicit_limit(name, scene, shape, graded)
            asked += [run(name, share * limit, True) for share in SHARES]
        else:
            asked += [run(name, period / n, True) for n in divisions]
    found = carry_out([*judges, *asked], store, workers=workers, pool=pool, retry=retry, progress=progress)
    truth = found[0]
    rows = tuple(
        measured_row(r, outcome, truth, duration) for r, outcome in zip(asked, found[2:], strict=True)
    )
    uncertainty = measured_row(judges[1], found[1], truth, duration).error
    judge = measured_row(judges[0], truth, truth, duration)
    reasons = (f"grading {graded:g}: {why}",) if why else ()
    return DynamicTradeoff(scene, duration, period, rows, judge, uncertainty, reasons)


def explicit_limit(integrator: str, scene: Scene, grid: Grid, grading: Graded = 0.0) -> float:
    """Stability limit [s] of an explicit integrator about the flat sheet."""
    import lumped

    springs = lumped.calibrate(scene.sheet, scene.material, grid=grid, grading=grading)
    problem = lumped.pose(scene, springs)
    system, flat = lumped.System(scene, problem), np.zeros_like(problem.loads.dead)
    limit = lumped.INTEGRATORS[integrator].limit(system, flat)
    assert limit is not None
    return limit.step
