"""Habibi et al.'s dynamics again: gravity on at t = 0, test 1 oscillates and settles.

Published are the inputs of test 1, a plot of ux, uy and uz of P4 over time without numbers, and the time that
a simulation took. The dampers are not published: those of our scene `two-edges-settling` are taken. Two
lattices are run: `consistent` springs, and the published k with √(D/k) between the layers, equal masses and
full springs along edges, as theirs.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

import lumped
from comparisons.models.context import context
from comparisons.reproduction.answers import (
    masses,
    matched_layer_distance,
    published_lattice,
    published_springs,
)
from comparisons.reproduction.published import published_inputs
from sheetbench.answers.history import History
from sheetbench.scenes import Scene, load

SCENE, PROBE = "two-edges-settling", "P4"
DURATION = 2.0  # s
WARMING = 0.01  # s, of a run whose time counts for nothing
SETTLED = 0.05  # of the static displacement


@dataclass(frozen=True)
class Settling:
    """The scene, by each lattice's name its run, and where its static equilibrium has P4, (3,) [m]."""

    scene: Scene
    runs: dict[str, History]
    rest: dict[str, np.ndarray]

    def settled(self, model: str) -> float | None:
        """When uz of P4 is last farther than SETTLED of its static value from it [s], None if that is at the
        end of the run."""
        run, rest = self.runs[model], self.rest[model][2]
        away = np.flatnonzero(np.abs(run.probes[PROBE][:, 2] - rest) > SETTLED * abs(rest))
        last = int(away[-1]) if len(away) else 0
        return float(run.time[last]) if last + 1 < len(run.time) else None

    def largest(self, model: str) -> float:
        """Return how far uz of P4 swings, of its static value."""
        return float(np.abs(self.runs[model].probes[PROBE][:, 2]).max() / abs(self.rest[model][2]))

    def seconds(self, model: str) -> float:
        """Return what the run took on warm code, set-up and all."""
        run = self.runs[model]
        return run.setup_seconds + run.solve_seconds

    def faster(self, model: str) -> float:
        """Return how many times longer the published simulation took."""
        return published_inputs()["run_time"] / self.seconds(model)

    def as_dict(self) -> dict[str, Any]:
        """For JSON: seconds and metres."""
        runs = {
            model: {**run.document(), "settled": self.settled(model), "rest": self.rest[model]}
            for model, run in self.runs.items()
        }
        published = published_inputs()["run_time"]
        return {"scene": self.scene.document(), "published_seconds": published, "runs": runs}


def settling(duration: float = DURATION) -> Settling:
    """Both runs, and where they ought to end. Raises NoEquilibrium where a lattice has no stable one."""
    scene, distance = load(SCENE), matched_layer_distance()
    consistent = lumped.calibrate(scene.sheet, scene.material, grid=masses(), method="consistent")
    lattices: dict[str, tuple[lumped.Calibration, Literal["tributary", "full"]]] = {
        "lumped": (consistent, "tributary"),
        published_lattice(distance): (published_springs(distance), "full"),
    }
    runs, rest = {}, {}
    small = lumped.calibrate(scene.sheet, scene.material, grid=(3, 3, 2), method="consistent")
    lumped.simulate(scene, small, WARMING)  # what is loaded or compiled is in no run's time
    at = np.array([scene.probes[PROBE]])
    for name, (springs, weights) in lattices.items():
        context().progress(f"simulating the settling sheet: {name}")
        runs[name] = lumped.simulate(scene, springs, duration, weights=weights)
        still = lumped.solve(scene, springs, weights=weights)
        rest[name] = still.require_stable().displacement(at)[0]
    return Settling(scene, runs, rest)
