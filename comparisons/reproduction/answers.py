"""Answers of our models to Habibi et al.'s tests, with the published inputs.

Beside the lattice of `consistent` springs and the shell with its error bar stand lattices as
theirs: k as published for all springs, equal masses, full springs along edges. Their layer distance is not
published; it is the sheet's thickness in one, √(D/k) in the other, with which it bends like the sheet
(`matched_layer_distance`). Whether the rod of test 2 lifts its ends is not published either.

Their displacement tables are brought to the axes of our scenes, without obvious misprints. The frame of the
published test 1 has y pointing the other way, so there −uy is taken. That test is its own mirror image about
the diagonal of the sheet, which exchanges x and y, P2 and P3: a uy whose sign is not that of the mirrored ux
is a misprint, and left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

import lumped
from comparisons.comparison.answer import Comparison
from comparisons.comparison.comparison import compare
from comparisons.models.context import context
from comparisons.models.grids import Elements
from comparisons.models.spec import Lattice
from comparisons.pictures.work import Work
from comparisons.reproduction.published import PROBES, published_displacements, published_inputs
from sheetbench.answers.solution import Solution
from sheetbench.scenes import Scene, load
from sheetbench.scenes.meaning.parameters import put

COMPONENTS = ("ux", "uy", "uz")
SOURCES = ("model", "experiment")
SCENES = {1: "two-edges-clamped", 2: "curved-edge"}
_MIRRORED = [0, 2, 1, 3]  # the probes of test 1 beyond its diagonal


def scene(test: int, sense: int = 1) -> Scene:
    """Return the scene of a test with the published inputs; sense: 1 where the rod of test 2 lifts its ends,
    or -1: only the size of its curvature is published."""
    loaded = load(SCENES[test])
    return put(loaded, "curvature_x0", sense * published_inputs()["curvature"]) if test == 2 else loaded


def published(test: int, source: str) -> np.ndarray:
    """Displacements (4, 3) [m] of the probes in the scene's axes, nan where the print cannot be meant."""
    given = published_displacements()
    table = np.array([[given[test, source, name, probe] for name in COMPONENTS] for probe in PROBES])
    if test == 1:
        table[:, 1] *= -1.0
        table[table[:, 1] * table[_MIRRORED, 0] < 0.0, 1] = np.nan
    return table


RODS = {0: "–", 1: "ends up", -1: "ends down"}  # by the sense of test 2's rod
SETS = ((1, 0), (2, 1), (2, -1))  # tests, and the sense of the rod


def masses() -> tuple[int, int, int]:
    """Return the published grid."""
    given = published_inputs()
    side = int(given["masses_per_side"])
    return side, side, int(given["layers"])


def matched_layer_distance() -> float:
    """√(D/k) [m], with which a lattice of the published k bends like the published sheet."""
    given = published_inputs()
    bending = given["young"] * given["thickness"] ** 3 / (12.0 * (1.0 - given["poisson"] ** 2))
    return sqrt(bending / given["k"])


@dataclass(frozen=True)
class ReproducedTest:
    """The answers to a test; sense: 1 where the rod of test 2 lifts its ends, -1 where it lowers them."""

    test: int
    sense: int
    comparison: Comparison

    @property
    def name(self) -> str:
        """Of its tables and files."""
        return f"test-{self.test}" + {0: "", 1: "-up", -1: "-down"}[self.sense]

    @property
    def title(self) -> str:
        """In words."""
        return f"Test {self.test}" + (f", the rod's {RODS[self.sense]}" if self.sense else "")


def answer(test: int, sense: int, elements: Elements) -> ReproducedTest:
    """Return a test by every model."""
    case = scene(test, sense or 1)
    comparison = compare(case, Lattice(masses(), "consistent"), elements=elements)
    of_seed = []
    for distance in (published_inputs()["thickness"], matched_layer_distance()):
        name = published_lattice(distance)
        context().progress(Work(f"solving {name}"))
        springs = published_springs(distance)
        of_seed.append(replace(lumped.solve(case, springs, weights="full"), model=name))
    return ReproducedTest(test, sense, replace(comparison, solutions=(*comparison.solutions, *of_seed)))


def published_lattice(distance: float) -> str:
    """Return what a lattice of the published k with a layer distance [m] is called."""
    return f"k{published_inputs()['k']:g}-lz{1e3 * distance:.3g}"


def published_springs(distance: float) -> lumped.Calibration:
    """Return the published k for every spring, with a layer distance [m]."""
    first, k = scene(1), published_inputs()["k"]
    return lumped.calibrate(
        first.sheet, first.material, grid=masses(), method="uniform", k=k, layer_distance=distance
    )


def of_model(answer: ReproducedTest, model: str) -> Solution:
    """Return the solution of a model by its name."""
    return next(one for one in answer.comparison.solutions if one.model == model)
