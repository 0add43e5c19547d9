"""Reproduction of Habibi et al.'s simulation: gravity on at t = 0, test 1 oscillates and settles.

The publication has the inputs of test 1, a plot of ux, uy and uz of P4 over time without numbers, and the run
time of a simulation. The dampers are not published; here they are taken from the scene `two-edges-settling`.
Two lattices are run: `consistent` springs, and the published k with √(D/k) between the layers, equal masses
and full springs along edges, as published.
"""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

import lumped
from comparisons.models.context import context
from sheetbench.answers.history import History
from sheetbench.scenes import Scene, load
from studies.reproduction.answers import (
    masses,
    matched_layer_distance,
    published_lattice,
    published_springs,
)
from studies.reproduction.published import published_inputs

SCENE, PROBE = "two-edges-settling", "P4"
DURATION = 2.0  # s
WARM_UP = 0.01  # s, duration of an untimed run
SETTLED = 0.05  # of the static displacement


@dataclass(frozen=True)
class Settling:
    """The scene, and by lattice its run and the static displacement of P4 (3,) [m]."""

    scene: Scene
    runs: dict[str, History]
    rest: dict[str, np.ndarray]

    def settled(self, model: str) -> float | None:
        """Return the last time [s] at which uz of P4 differs from its static value by more than SETTLED of
        it, None if that is the end of the run."""
        run, rest = self.runs[model], self.rest[model][2]
        unsettled = np.flatnonzero(np.abs(run.probes[PROBE][:, 2] - rest) > SETTLED * abs(rest))
        last = int(unsettled[-1]) if len(unsettled) else 0
        return float(run.time[last]) if last + 1 < len(run.time) else None

    def largest(self, model: str) -> float:
        """Return the largest uz of P4 over its static value."""
        return float(np.abs(self.runs[model].probes[PROBE][:, 2]).max() / abs(self.rest[model][2]))

    def seconds(self, model: str) -> float:
        """Return the run's time on warm code, set-up included [s]."""
        run = self.runs[model]
        return run.setup_seconds + run.solve_seconds

    def faster(self, model: str) -> float:
        """Return the published run time over this run's time."""
        return published_inputs()["run_time"] / self.seconds(model)

    def as_dict(self) -> dict[str, Any]:
        """Return the runs as JSON data, in seconds and metres."""
        runs = {
            model: {**run.document(), "settled": self.settled(model), "rest": self.rest[model]}
            for model, run in self.runs.items()
        }
        published = published_inputs()["run_time"]
        return {"scene": self.scene.document(), "published_seconds": published, "runs": runs}


def settling(duration: float = DURATION) -> Settling:
    """Run both lattices and solve their static equilibria. Raises NoEquilibrium if one has no stable one."""
    scene, distance = load(SCENE), matched_layer_distance()
    consistent = lumped.calibrate(scene.sheet, scene.material, grid=masses(), method="consistent")
    lattices: dict[str, tuple[lumped.Calibration, Literal["tributary", "full"]]] = {
        "lumped": (consistent, "tributary"),
        published_lattice(distance): (published_springs(distance), "full"),
    }
    runs, rest = {}, {}
    small = lumped.calibrate(scene.sheet, scene.material, grid=(3, 3, 2), method="consistent")
    lumped.simulate(scene, small, WARM_UP)  # keeps loading and compiling out of the timed runs
    at = np.array([scene.probes[PROBE]])
    for name, (springs, weights) in lattices.items():
        context().progress(f"simulating the settling sheet: {name}")
        runs[name] = lumped.simulate(scene, springs, duration, weights=weights)
        static = lumped.solve(scene, springs, weights=weights)
        rest[name] = static.require_stable().displacement(at)[0]
    return Settling(scene, runs, rest)
