"""Validity of an equilibrium: lost digits, layers thinner than the grid's cells, slender cells.

digits     a link's elongation is rounded like the scalar product of its rest vector and its ends' relative
           displacement Δu, its force by k Δu ε: K⁻¹ times random forces of size k Δu ε estimates, at a few
           solves with existing factors, the displacement by rounding: twenty to tens of thousands of times
           the real one in the maps of docs/stability.md. The real one follows, mostly within a factor of ten,
           from K⁻¹ times the remaining unbalanced force.
layers     A thin sheet that curves by κ both ways keeps its stretching within lines and borders of width

               δ = √(h/κ) / (12 (1 − ν²))^¼         (e.g. Calladine, Theory of Shell Structures, 1983)

           A grid of cells longer than 2 δ makes it stretch over whole cells instead: the solution is then
           an equilibrium of this grid, too stiff, and not the sheet's. κ is √|κ₁κ₂|, and a sheet that
           bends one way only has next to no energy in the layers' mean stretch. All solutions in the studies
           of docs/stability.md that are off by more than 5 % for this reason are reported, and a few others.
slender    masses of cells many times as long as wide, as strong grading makes them at a clamp, move to and
           fro along them where the sheet is bent sharply: unstable, within 0.1 % of the sheet's equilibrium

Each is reported with the place on the sheet where it is worst and a change that helps.
"""

import math
from functools import lru_cache

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from lumped.springs.all_families import Survey
from lumped.statics.faults import place
from lumped.statics.problem import LatticeState, Problem
from lumped.statics.soundness import link_force_sums, sharpest_bend
from sheetbench.answers.solution import Status
from sheetbench.numerics.cache import frozen
from sheetbench.numerics.continuation.path import Fault
from sheetbench.numerics.direct import SOLVED, Factor
from sheetbench.scenes.language.summary import few

DOUBTFUL, LOST = 1e-2, 0.05  # displacement by rounding over the largest: the estimate, and the real one
NEGLIGIBLE = 1e-6  # estimate of one sample: no other sample's is ten thousand times as large
SAMPLES = 3
SLENDER = (
    9.0  # length over width of a cell; 9.5 is the least that became unstable, in strips bent through 80°
)
RESOLVED = 2.0  # cells' length over the width of a layer
FREE_OF_STRETCH = 0.025  # share of energy in the layers' mean stretch below which there is nothing to resolve


def lost_digits(problem: Problem, state: LatticeState, factor: Factor | None) -> Fault | None:
    """Return a fault if the estimated displacement caused by rounding of the internal force exceeds DOUBTFUL.
    Its status is `singular` if the remaining unbalanced force displaces the equilibrium by more than LOST."""
    largest = float(np.abs(state.u).max())
    if factor is None or largest == 0.0:
        return None
    links, share = problem.assembly.links, 0.0
    carried = link_force_sums(state.u, links.nodes, links.stiffness)
    for sample in _noise(state.u.shape):
        moved = problem.expand(factor.solve_unrefined(problem.reduce(carried * sample)))
        share = max(share, problem.assembly.rounding * float(np.abs(moved).max()) / largest)
        if share < NEGLIGIBLE:
            return None
    if not share > DOUBTFUL:
        return None
    unbalanced = problem.forces(state, state.load_factor).reduced
    actual = float(np.abs(problem.expand(factor.solve(unbalanced, SOLVED))).max()) / largest
    return Fault(
        Status.SINGULAR if actual > LOST else Status.CONVERGED,
        f"rounding may move the masses by {share:.1g} of the largest displacement: use fewer, or thicker, "
        "cells",
    )


@lru_cache(maxsize=4)
def _noise(shape: tuple[int, ...]) -> np.ndarray:
    """Return random forces (SAMPLES, *shape), equal for all lattices of a size."""
    return frozen(np.random.default_rng(0).standard_normal((SAMPLES, *shape)))


def thin_layers(problem: Problem, state: LatticeState, survey: Survey) -> str:
    """Return a sentence if the sheet's stretching lies in layers thinner than the grid's cells, else "";
    survey: of the springs at a state."""
    assembly, u, scene = problem.assembly.at(state.load_factor), state.u, problem.scene
    lattice = assembly.lattice
    if _stretch_share(assembly, u, survey) < FREE_OF_STRETCH:
        return ""
    x, y = lattice.lines
    bent, longest, j, i = sharpest_bend(*lattice.plan, u, x.widths, y.widths)
    if not bent > 0.0:
        return ""
    h, nu = scene.sheet.thickness, scene.material.poisson
    width = longest * math.sqrt(h / bent) / (12.0 * (1.0 - nu**2)) ** 0.25
    ratio = longest / width
    if ratio < RESOLVED:
        return ""
    where = place(lattice, int(lattice.columns()[j, i, 0]))
    return (
        f"the answer may depend on the grid: cells {few(ratio)} times as long as the layer where the sheet "
        f"stretches ({few(1e3 * width)} mm near {where}); refine the grid until the answer stays equal"
    )


def slender_cells(lattice: Lattice) -> str:
    """Return a sentence if slender cells may be the cause of a lattice's instability, else ""."""
    x, y = (line.widths for line in lattice.lines)
    times = max(x.max() / y.min(), y.max() / x.min())
    if times < SLENDER:
        return ""
    return (
        f"cells are up to {few(times)} times as long as wide, and may buckle where the sheet does not: use "
        "less grading, or more masses across"
    )


def _stretch_share(assembly: Assembly, u: np.ndarray, survey: Survey) -> float:
    """Return the energy of the layers' mean stretch over the total energy: by the in-plane links, or for
    rubber layers, whose links have no shear, by the energy of all layers displaced as their mean."""
    total, stretch = sum(survey.energies.values()), survey.stretch
    if not total > 0.0:
        return 0.0
    if assembly.any_strain:
        columns, mean = assembly.lattice.columns(), u.copy()
        mean[columns] = u[columns].mean(axis=2, keepdims=True)
        energies = assembly.survey(mean).energies
        stretch = energies["axial"] + energies["rubber"]
    return stretch / total
