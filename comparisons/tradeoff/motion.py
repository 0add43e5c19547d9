"""The trade of a motion: time step and integrator against error and time, on one lattice.

Of P4 (or the probe that moves most), over the whole run and against the finest reference:

    error     largest |component of u(t) − u_ref(t)| / largest |component of u_ref(t)|
    period    mean time between upward passes of the largest component through its mean
    damping   ratio ζ from the logarithmic decrement of successive maxima above the mean, ln(a₁/aₙ)/2π(n − 1)

Cost is the solver's time per simulated second. The reference is the energy-conserving midpoint rule with
`REFERENCE` steps in the period; its uncertainty its distance from half as many, an upper bound for any order
above one. Steps are the period over `divisions`, the period being the lowest mode's about the flat sheet or
about its equilibrium, the shorter of the two: a sheet that hangs is stiffer than it was flat. Where an
integrator converges with none of them its steps are halved until it does, down to the reference's. Explicit
integrators take shares of their stability limit instead. Springs, period, limit and runs are of one lattice.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import partial
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.models.context import large_in_context, running
from comparisons.models.resolve import resolve
from comparisons.models.solve import simulate
from comparisons.models.spec import Lattice
from comparisons.runs import load, manifest
from comparisons.runs.campaign import Progress, Run, carry_out
from comparisons.runs.executors import Pool, processes
from comparisons.runs.store import Finished, Store
from comparisons.tradeoff.motion_row import MotionRow, measured_row
from comparisons.tradeoff.pareto import cheapest, error_order, front, grouped
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import Table
from sheetbench.choices import INTEGRATORS
from sheetbench.errors import NoEquilibrium
from sheetbench.scenes import Scene, SceneError, Status
from sheetbench.scenes.quantities import require_positive
from sheetbench.scenes.summary import few, milliseconds

if TYPE_CHECKING:
    from lumped import Calibration

DIVISIONS = (20, 40, 100, 200, 400)  # steps in the lowest period
SHARES = (0.9, 0.45)  # of the explicit integrator's limit
REFERENCE = 3200
SHOWN = (
    "integrator",
    "step",
    "steps",
    "seconds_per_second",
    "error",
    "period_error",
    "damping",
    "front",
    "status",
)
SAMPLES = 20  # in the lowest period; no step is longer than the time between samples


@dataclass(frozen=True, repr=False)
class DynamicTradeoff(Answer):
    """A row per integrator and step, the reference that they are measured against; lowest_period [s]: about
    the flat sheet or its equilibrium, the shorter; lattice: what all runs are of."""

    file_name = "motion"
    scene: Scene
    duration: float
    lowest_period: float
    rows: tuple[MotionRow, ...]
    reference: MotionRow
    uncertainty: float | None
    reasons: tuple[str, ...] = ()
    lattice: str = ""

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
    def orders(self) -> dict[str, float | None]:
        """Observed order of the error in the step, by integrator."""
        found = {}
        for name, numbers in grouped([row.integrator for row in self.rows]).items():
            rows = [self.rows[i] for i in numbers]
            found[name] = error_order([r.step for r in rows], [r.error for r in rows], self.uncertainty)
        return found

    def document(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "scene": self.scene.document(),
            "duration": self.duration,
            "lowest_period": self.lowest_period,
            "lattice": self.lattice,
            "warnings": self.warnings,
            "rows": [row.as_dict() for row in self.rows],
            "front": self.front,
            "orders": [{"series": name, "error_order": slope} for name, slope in self.orders.items()],
            "reference": {**self.reference.as_dict(), "uncertainty": self.uncertainty},
        }

    def tables(self) -> tuple[Table, ...]:
        """A row per integrator and step."""
        front = self.front
        rows = [replace(row, front=i in front) for i, row in enumerate(self.rows)]
        caption = (
            f"Over {self.duration:g} s. cost: per simulated second; period: off by; damping: of critical"
        )
        return (Table.of(MotionRow, rows, caption, "motion", fields=SHOWN),)

    def figures(self) -> tuple[Picture, ...]:
        drawn = Picture("motion", "comparisons.tradeoff.motion_figure:compose", (self,))
        return (drawn,) if any(row.error for row in self.rows) else ()

    def notes(self) -> list[str]:
        known = "unknown" if self.uncertainty is None else f"{few(100 * self.uncertainty)} %"
        names = [f"{row.integrator} with steps of {milliseconds(row.step)}" for row in self.rows]
        seconds = [row.seconds_per_second for row in self.rows]
        return [
            f"{self.lattice}; lowest period {self.lowest_period:.4g} s; uncertainty of the reference {known}",
            *self.reasons,
            *cheapest(names, [row.error for row in self.rows], seconds, " a simulated second"),
            *self.warnings,
        ]

    def complaints(self) -> tuple[str, ...]:
        return folded([*self.rows, self.reference])

    def choices(self) -> dict[str, Any]:
        return {"duration": self.duration}


def folded(rows: Sequence[MotionRow]) -> tuple[str, ...]:
    """A line for all steps of an integrator that ended alike."""
    ends: dict[tuple[str, str, str], list[MotionRow]] = {}
    for row in rows:
        if row.status != Status.CONVERGED:
            why = re.sub(r"^at [\d.e+-]+ s: ", "", row.message)
            ends.setdefault((row.integrator, row.status, why), []).append(row)
    return tuple(
        f"{integrator}, {'steps' if len(alike) > 1 else 'step'} "
        f"{', '.join(f'{1e3 * row.step:.3g}' for row in alike)} ms: {status}: {why}"
        for (integrator, status, why), alike in ends.items()
    )


def measure(
    scene: dict[str, Any],
    lattice: dict[str, Any],
    integrator: str,
    step: float,
    duration: float,
    every: float,
) -> dict[str, Any]:
    """Task: one run and what it cost; the history of the probes included."""
    asked = Scene.model_validate(scene)
    with running(large=True):  # `dynamic_tradeoff` has looked at the size
        meant = resolve(asked, Lattice.given(None, lattice), "motion")
    common: dict[str, Any] = {"integrator": integrator, "every": every, "step": step}
    simulate(meant, 2.0 * every, **common)  # warm
    history = simulate(meant, duration, **common)
    return {
        "status": str(history.status),
        "message": history.message,
        "steps": history.steps,
        "solve_seconds": history.solve_seconds,
        "time": history.time,
        "probes": history.probes,
        "load_average": load.average(),
        "machine": manifest.machine(),
        "versions": {"sheetbench": manifest.version(), **manifest.versions()},
    }


@large_in_context
def dynamic_tradeoff(
    scene: Scene,
    duration: float,
    store: Store,
    *,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    integrators: Sequence[str] = tuple(sorted(INTEGRATORS)),
    divisions: Sequence[int] = DIVISIONS,
    reference: int = REFERENCE,
    workers: int = 1,
    pool: Pool = processes,
    retry: bool = False,
    large: bool = False,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> DynamicTradeoff:
    """Measure every integrator at every step on one lattice.

    retry: what failed or was lost before is run again. large: even if it takes more memory than there is.
    Raises BadInput for an integrator that does not exist. A run that diverges is a row with its status.
    """
    import lumped

    require_positive("duration", duration, "s")
    for name in integrators:
        lumped.require_integrator(name)
    meant = resolve(scene, lattice, "motion")
    springs = meant.springs
    period = shortest_period(scene, springs)

    def run(integrator: str, step: float, timed: bool) -> Run:
        arguments = {
            "scene": scene.document(),
            "lattice": meant.spec.settings,
            "integrator": integrator,
            "step": step,
            "duration": duration,
            "every": period / SAMPLES,
        }
        return Run("motion", arguments, f"{integrator} {step:.3g} s", timed)

    judges = [run("midpoint", period / n, False) for n in (reference, reference // 2)]
    asked = []
    for name in integrators:
        if lumped.INTEGRATORS[name].explicit:
            limit = explicit_limit(name, scene, springs)
            asked += [run(name, share * limit, True) for share in SHARES]
        else:
            asked += [run(name, period / n, True) for n in divisions]
    carried = partial(carry_out, store=store, workers=workers, pool=pool, progress=progress)
    truth, half, *found = carried([*judges, *asked], retry=retry)
    finer = 2 * max(divisions)
    while finer <= reference and (names := _unsolved(asked, found)):
        more = [run(name, period / finer, True) for name in names]
        found += carried(more)
        asked += more
        finer *= 2
    rows = [measured_row(r, outcome, truth, duration) for r, outcome in zip(asked, found, strict=True)]
    return DynamicTradeoff(
        scene,
        duration,
        period,
        tuple(sorted(rows, key=lambda row: integrators.index(row.integrator))),
        measured_row(judges[0], truth, truth, duration),
        measured_row(judges[1], half, truth, duration).error,
        tuple(f"{name.removesuffix('_reason')}: {why}" for name, why in meant.reasons.items()),
        f"lumped {springs.title}",
    )


def _unsolved(asked: Sequence[Run], found: Sequence[Finished]) -> list[str]:
    """The implicit integrators that converged with no step so far."""
    import lumped

    ended: dict[str, set[str]] = {}
    for one, outcome in zip(asked, found, strict=True):
        ended.setdefault(one.arguments["integrator"], set()).add(outcome.status)
    implicit = [name for name in ended if not lumped.INTEGRATORS[name].explicit]
    return [name for name in implicit if not ended[name] & {Status.CONVERGED, Status.REFUSED}]


def shortest_period(scene: Scene, springs: Calibration) -> float:
    """The lowest mode's period [s] about the flat sheet or about its equilibrium, the shorter."""
    import lumped

    found = [lumped.modes(scene, springs, 1, springs.masses)]
    with suppress(NoEquilibrium, SceneError):  # where there is none, the flat sheet's it is
        found.append(lumped.modes(scene, springs, 1, springs.masses, "deformed"))
    return 1.0 / max(float(modes.frequencies[0]) for modes in found)


def explicit_limit(integrator: str, scene: Scene, springs: Calibration) -> float:
    """Stability limit [s] of an explicit integrator about the flat sheet."""
    import lumped

    problem = lumped.build_problem(scene, springs)
    system, flat = lumped.System(scene, problem), np.zeros_like(problem.loads.dead)
    limit = lumped.INTEGRATORS[integrator].limit(system, flat)
    assert limit is not None
    return limit.step
