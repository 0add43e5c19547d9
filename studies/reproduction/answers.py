"""Answers of our models to Habibi et al.'s tests, with the published inputs.

The models are the lattice of `consistent` springs, the shell with its error bar, and two lattices like the
published one: the published k for all springs, equal masses, full springs along edges. Its layer distance is
not published; here it is the sheet's thickness, and √(D/k), which gives the sheet's bending stiffness
(`matched_layer_distance`). The direction in which the rod of test 2 bends is not published either.

The published displacement tables are transformed to the axes of our scenes, without obvious misprints. The y
axis of the published test 1 is reversed, so −uy is taken. Test 1 is symmetric about the diagonal of the
sheet, which exchanges x and y, P2 and P3: a uy with another sign than the mirrored ux is a misprint and is
left out.
"""

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
from sheetbench.scenes import Scene, load
from sheetbench.scenes.meaning.parameters import put
from studies.reproduction.published import PROBES, published_displacements, published_inputs

COMPONENTS = ("ux", "uy", "uz")
SOURCES = ("model", "experiment")
SCENES = {1: "two-edges-clamped", 2: "curved-edge"}
_MIRRORED = [0, 2, 1, 3]  # mirror images of test 1's probes about the diagonal


def scene(test: int, sense: int = 1) -> Scene:
    """Return the scene of a test with the published inputs; sense: sign of the curvature of test 2's rod, 1
    for raised ends, because only its magnitude is published."""
    loaded = load(SCENES[test])
    return put(loaded, "curvature_x0", sense * published_inputs()["curvature"]) if test == 2 else loaded


def published(test: int, source: str) -> np.ndarray:
    """Return published displacements (4, 3) [m] of the probes in the scene's axes, NaN for misprints."""
    values = published_displacements()
    table = np.array([[values[test, source, name, probe] for name in COMPONENTS] for probe in PROBES])
    if test == 1:
        table[:, 1] *= -1.0
        table[table[:, 1] * table[_MIRRORED, 0] < 0.0, 1] = np.nan
    return table


RODS = {0: "–", 1: "ends up", -1: "ends down"}  # by the sense of test 2's rod
SETS = ((1, 0), (2, 1), (2, -1))  # test and sense of the rod


def masses() -> tuple[int, int, int]:
    """Return the published grid."""
    inputs = published_inputs()
    side = int(inputs["masses_per_side"])
    return side, side, int(inputs["layers"])


def matched_layer_distance() -> float:
    """Return √(D/k) [m], the layer distance that gives the published k the sheet's bending stiffness."""
    inputs = published_inputs()
    bending = inputs["young"] * inputs["thickness"] ** 3 / (12.0 * (1.0 - inputs["poisson"] ** 2))
    return sqrt(bending / inputs["k"])


@dataclass(frozen=True)
class ReproducedTest:
    """The answers to a test; sense: 1 if the rod of test 2 raises its ends, -1 if it lowers them, else 0."""

    test: int
    sense: int
    comparison: Comparison

    @property
    def name(self) -> str:
        """Name of the test's tables and files."""
        return f"test-{self.test}" + {0: "", 1: "-up", -1: "-down"}[self.sense]

    @property
    def title(self) -> str:
        """The test and its rod in words."""
        return f"Test {self.test}" + (f", the rod's {RODS[self.sense]}" if self.sense else "")


def answer(test: int, sense: int, elements: Elements) -> ReproducedTest:
    """Solve a test by every model."""
    case = scene(test, sense or 1)
    comparison = compare(case, Lattice(masses(), "consistent"), elements=elements)
    published_lattices = []
    for distance in (published_inputs()["thickness"], matched_layer_distance()):
        name = published_lattice(distance)
        context().progress(Work(f"solving {name}"))
        springs = published_springs(distance)
        published_lattices.append(replace(lumped.solve(case, springs, weights="full"), model=name))
    solutions = (*comparison.solutions, *published_lattices)
    return ReproducedTest(test, sense, replace(comparison, solutions=solutions))


def published_lattice(distance: float) -> str:
    """Return the name of a lattice of the published k with a layer distance [m]."""
    return f"k{published_inputs()['k']:g}-lz{1e3 * distance:.3g}"


def published_springs(distance: float) -> lumped.Calibration:
    """Return springs that all have the published k, with a layer distance [m]."""
    first, k = scene(1), published_inputs()["k"]
    return lumped.calibrate(
        first.sheet, first.material, grid=masses(), method="uniform", k=k, layer_distance=distance
    )
