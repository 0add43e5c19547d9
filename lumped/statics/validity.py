"""What makes an equilibrium doubtful: lost digits, layers thinner than the grid's cells, slender cells.

digits     a link's elongation is rounded as the scalar product of its rest vector and its ends' relative
           displacement Δu is, its force by k Δu ε: K⁻¹ times random forces of that size tells, at a few
           solves with the factors at hand, how far rounding may move the equilibrium: twenty to tens of
           thousands of times as far as it does in the maps of docs/stability.md. (The condition number,
           which the message gives too, bounds it yet more loosely.) What it has moved shows, mostly within
           ten times, in K⁻¹ times the unbalanced force that is left.
layers     A thin sheet that curves by κ both ways keeps its stretching within lines and borders of width

               δ = √(h/κ) / (12 (1 − ν²))^¼         (e.g. Calladine, Theory of Shell Structures, 1983)

           A grid of cells longer than 2 δ makes it stretch over whole cells instead: what it then finds is
           an equilibrium of this grid, too stiff, and not the sheet's. κ is √|κ₁κ₂|, and a sheet that
           bends one way only has next to no energy in the layers' mean stretch. In the studies of
           docs/stability.md all that are off by more than 5 % for this reason are reported, and a few others.
slender    masses of cells many times as long as wide, as strong grading makes them at a clamp, move to and
           fro along them where the sheet is bent sharply: unstable, within 0.1 % of the sheet's equilibrium

Each is reported with the place on the sheet where it is worst and what to change.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from lumped.springs.all_families import Survey
from lumped.statics.faults import place
from lumped.statics.problem import LatticeState, Problem
from lumped.statics.soundness import carried_by_links, sharpest_bend
from sheetbench.answers.solution import Status
from sheetbench.numerics.cache import frozen
from sheetbench.numerics.continuation.path import Fault
from sheetbench.numerics.direct import SOLVED, Factor
from sheetbench.scenes.language.summary import few

DOUBTFUL, LOST = 1e-2, 0.05  # displacement by rounding over the largest: that it may be, that it is
BEYOND_DOUBT = 1e-6  # of one sample: no other one is ten thousand times as large
SAMPLES = 3
SLENDER = 9.0  # length over width of a cell; 9.5 is the least that gave way, in strips bent through 80°
RESOLVED = 2.0  # cells' length over the width of a layer
FREE_OF_STRETCH = 0.025  # share of energy in the layers' mean stretch below which there is nothing to resolve


def digits(problem: Problem, state: LatticeState, factor: Factor | None) -> Fault | None:
    """Where the rounding of the internal force may move the equilibrium by more than DOUBTFUL: how far, and
    `singular` where the unbalanced force that it has left does move it by more than LOST."""
    largest = float(np.abs(state.u).max())
    if factor is None or largest == 0.0:
        return None
    links, share = problem.assembly.links, 0.0
    carried = carried_by_links(state.u, links.nodes, links.stiffness)
    for sample in _noise(state.u.shape):
        moved = problem.expand(factor.solve_unrefined(problem.reduce(carried * sample)))
        share = max(share, problem.assembly.rounding * float(np.abs(moved).max()) / largest)
        if share < BEYOND_DOUBT:
            return None
    if not share > DOUBTFUL:
        return None
    unbalanced = problem.forces(state, state.load_factor).reduced
    left = float(np.abs(problem.expand(factor.solve(unbalanced, SOLVED))).max()) / largest
    return Fault(
        Status.SINGULAR if left > LOST else Status.CONVERGED,
        f"rounding may move the masses by {share:.1g} of the largest displacement: use fewer, or thicker, "
        "cells",
    )


@lru_cache(maxsize=4)
def _noise(shape: tuple[int, ...]) -> np.ndarray:
    """The random forces: the same for all lattices of a size."""
    return frozen(np.random.default_rng(0).standard_normal((SAMPLES, *shape)))


def layers(problem: Problem, state: LatticeState, found: Survey) -> str:
    """Return a sentence where the sheet's stretching lies in layers thinner than the grid's cells, else
    nothing; found: of the springs at a state."""
    assembly, u, scene = problem.assembly.at(state.load_factor), state.u, problem.scene
    lattice = assembly.lattice
    if _stretch_share(assembly, u, found) < FREE_OF_STRETCH:
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
        f"not unique to the sheet but to this grid: cells {few(ratio)} times as long as the layer in which "
        f"it stretches ({few(1e3 * width)} mm near {where}); refine the grid until the answer stays"
    )


def slender_cells(lattice: Lattice) -> str:
    """Return a sentence where an unstable lattice has cells so long and narrow that they may give way."""
    x, y = (line.widths for line in lattice.lines)
    times = max(x.max() / y.min(), y.max() / x.min())
    if times < SLENDER:
        return ""
    return (
        f"cells are up to {few(times)} times as long as wide, and may give way where the sheet does not: use "
        "less grading, or more masses across"
    )


def _stretch_share(assembly: Assembly, u: np.ndarray, found: Survey) -> float:
    """Energy of the layers' mean stretch over all that is stored: as the in-plane links have it, of
    neo-Hookean layers, whose links know no shear, that of all layers displaced as their mean."""
    total, stretch = sum(found.energies.values()), found.stretch
    if not total > 0.0:
        return 0.0
    if assembly.any_strain:
        columns, mean = assembly.lattice.columns(), u.copy()
        mean[columns] = u[columns].mean(axis=2, keepdims=True)
        energies = assembly.survey(mean).energies
        stretch = energies["axial"] + energies["rubber"]
    return stretch / total
