"""Sheets that differ in a few numbers, and what they say of the tests of Habibi et al.

sheet     `consistent` springs on the published grid: a plate of the published thickness and ν; `young` varies
lattice   that of Habibi et al.: one k for all springs, equal masses, full springs along edges; `k` and
          `layer_distance` vary

Of both, `curvature` is that of the rod, and `tilt` [rad] turns the supports as one, about the rod's middle
tangent, or about the horizontal through the clamped corner across the sheet's diagonal; tilt > 0 lets the
sheet start off downwards. (Two clamps that are turned each about its own edge cannot both be obeyed at the
corner they share.) In the turned frame the sheet is that of the scene under gravity turned back:

    u = R (X + u' − a) + a − X,    g' = Rᵀ g,    R e = e cos τ − e_z sin τ,

with a the point that stays and e the horizontal direction into the sheet.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

import lumped
from comparisons.identification.prediction import NotReached, Prediction
from comparisons.identification.unknowns import Unknown
from comparisons.reproduction.answers import masses
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import EDGES, Gravity, Scene, Solution, Status
from sheetbench.scenes.habibi import published_inputs
from sheetbench.scenes.parameters import put

STEP = 1e-4  # in x, for differences of solutions that are accurate to about 1e-9
UNITS = {"young": "Pa", "k": "N/m", "layer_distance": "m", "tilt": "rad", "curvature": "1/m"}
KINDS = ("sheet", "lattice")
RODS = {0: "–", 1: "ends up", -1: "ends down"}

Values = Mapping[str, float]


class Sheets:
    """All sheets of a kind under one or two tests: predictors of `comparisons.identification`.

    kind: one of KINDS; scenes: of the tests, with what does not vary; grid: masses along x, y, layers.
    """

    def __init__(self, kind: str, scenes: Sequence[Scene], grid: tuple[int, int, int] | None = None) -> None:
        self.kind, self.scenes, self.grid = kind, tuple(scenes), grid or masses()

    def unknown(self, name: str, start: float) -> Unknown:
        """A number that is sought from `start` on: k, E and lz by their logarithms, lz up to the distance of
        masses in a layer."""
        side = max(self.scenes[-1].sheet.lengths)
        if name == "tilt":
            return Unknown(name, UNITS[name], start, -0.5 * np.pi, 0.5 * np.pi, 1.0)
        if name == "curvature":
            return Unknown(name, UNITS[name], start, -2.0 * np.pi / side, 2.0 * np.pi / side, 1.0 / side)
        largest = side / (self.grid[0] - 1) if name == "layer_distance" else np.inf
        return Unknown(name, UNITS[name], start, 0.0, largest)

    def __call__(self, unknowns: Sequence[Unknown], x: np.ndarray, points: np.ndarray) -> Prediction:
        """What they say of the tests' probes, one test after the other, with differences by x. Raises
        NotReached where one of them has no stable equilibrium."""
        inwards = STEP * np.array(
            [-1.0 if at >= one.bounds()[1] else 1.0 for one, at in zip(unknowns, x, strict=True)]
        )
        unsolved = [
            {one.name: one.value(at) for one, at in zip(unknowns, x + step, strict=True)}
            for step in np.vstack([np.zeros(len(x)), np.diag(inwards)])
        ]
        here, *beside = self.displacements(unsolved)
        if any(np.isnan(moved).any() for moved in (here, *beside)):
            raise NotReached("no stable equilibrium")
        return Prediction(here, [(moved - here) / step for moved, step in zip(beside, inwards, strict=True)])

    def displacements(self, many: Sequence[Values]) -> list[np.ndarray]:
        """Displacements (probes, 3) [m] for each set of values, one test after the other; nan where there is
        no stable equilibrium."""
        solved = self.solutions(many)
        tables = []
        for values, solutions in zip(many, solved, strict=True):
            moved = []
            for scene, solution in zip(self.scenes, solutions, strict=True):
                here = turned_back(
                    scene, solution.displacement(scene.probe_points()), values.get("tilt", 0.0)
                )
                moved.append(here if solution.status is Status.CONVERGED else np.full_like(here, np.nan))
            tables.append(np.vstack(moved))
        return tables

    def solutions(self, many: Sequence[Values]) -> list[list[Solution]]:
        """The solutions for each set of values, one a test, in the frame that turns with the supports."""
        scenes = [_with_values(scene, values) for values in many for scene in self.scenes]
        own: list[dict[str, Any]] = [{"method": "consistent"} for _ in scenes]
        if self.kind == "lattice":
            published = {"method": "uniform", "k": published_inputs()["k"]}
            given = [{key: v[key] for key in ("k", "layer_distance") if key in v} for v in many]
            own = [published | values for values in given for _ in self.scenes]
        springs = [
            lumped.calibrate(scene.sheet, scene.material, grid=self.grid, **options)
            for scene, options in zip(scenes, own, strict=True)
        ]
        weights: Any = "full" if self.kind == "lattice" else "tributary"
        with one_blas_thread(), ThreadPoolExecutor(os.cpu_count()) as pool:
            solutions = list(pool.map(partial(lumped.solve, weights=weights), scenes, springs))
        count = len(self.scenes)
        return [solutions[i : i + count] for i in range(0, len(solutions), count)]


def _with_values(scene: Scene, values: Values) -> Scene:
    """The scene with these values, in the frame that turns with the supports."""
    if "young" in values:
        scene = put(scene, "young", values["young"])
    if "curvature" in values:
        scene = put(scene, "curvature_x0", values["curvature"])
    if values.get("tilt") and scene.gravity is not None:
        pull = _turn(scene, values["tilt"]).inv().apply(scene.gravity.acceleration)
        x, y, z = map(float, pull)
        scene = scene.replace(gravity=Gravity(acceleration=(x, y, z)))
    return scene


def turned_back(scene: Scene, displacement: np.ndarray, tilt: float) -> np.ndarray:
    """Displacements (probes, 3) [m] of a frame that has turned, as seen from where it stood."""
    if not tilt:
        return displacement
    flat = np.column_stack([scene.probe_points(), np.zeros(len(displacement))])
    middle = 0.5 * np.array([*scene.sheet.lengths, 0.0])
    outward = _outward(scene)
    stays = np.where(outward == 0.0, middle, middle * (1.0 + outward))
    moved: np.ndarray = _turn(scene, tilt).apply(flat + displacement - stays) + stays - flat
    return moved


def _outward(scene: Scene) -> np.ndarray:
    """Out of the sheet over the supported edges, (3,), each component -1, 0 or 1."""
    return np.sum([EDGES[support.edge].outward for support in scene.supports], axis=0)


def _turn(scene: Scene, tilt: float) -> Rotation:
    inward = -_outward(scene) / np.linalg.norm(_outward(scene))
    return Rotation.from_rotvec(tilt * np.cross([0.0, 0.0, 1.0], inward))
