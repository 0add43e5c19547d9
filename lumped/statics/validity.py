"""What a lattice watches for in its own answers: collapsed links, inverted cells, lost digits, thin layers.

collapsed  a link shorter than 1e-6 of its rest length: its direction means nothing.
inverted   the normal of a mid-surface cell no longer points the way from the bottom layer to the top.
digits     a link's elongation is rounded as the scalar product of its rest vector and its ends' relative
           displacement Δu is, its force by k Δu ε: K⁻¹ times random forces of that size tells, at a few
           solves with the factors at hand, how far rounding may move the equilibrium: twenty to tens of
           thousands of times as far as it does in the studies of docs/stability.md. (The condition number,
           which the message gives too, bounds it yet more loosely.) What it has moved shows, mostly within
           ten times, in K⁻¹ times the unbalanced force that is left.
layers     A thin sheet that curves by κ both ways keeps its stretching within lines and borders of width

               δ = √(h/κ) / (12 (1 − ν²))^¼         (e.g. Calladine, Theory of Shell Structures, 1983)

           A grid of cells longer than 2 δ makes it stretch over whole cells instead: what it then finds is
           an equilibrium of this grid, too stiff, and not the sheet's. κ is √|κ₁κ₂|, and a sheet that
           bends one way only has next to no energy in the layers' mean stretch. In the studies of
           docs/stability.md all that are off by more than 5 % for this reason are told, and a few others.

Each is said with the place on the sheet where it is worst and what to change.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from lumped.assembly import Assembly
from lumped.lattice import Lattice
from sheetbench.scenes import Scene, Status

if TYPE_CHECKING:
    from lumped.statics.equilibrium import State
    from lumped.statics.problem import Problem

COLLAPSED = 1e-6  # of a link's rest length
DOUBTFUL, LOST = 1e-2, 0.05  # displacement by rounding over the largest: that it may be, that it is
SAMPLES = 3
RESOLVED = 2.0  # cells' length over the width of a layer
FREE_OF_STRETCH = 0.025  # share of energy in the layers' mean stretch below which there is nothing to resolve


class Fault(NamedTuple):
    """What makes a state worthless: the status it deserves and a sentence."""

    status: Status
    message: str


def broken(assembly: Assembly, u: np.ndarray) -> Fault | None:
    """The first of: a number that is not finite, a collapsed link, an inverted cell; u: (n, 3) [m]."""
    lattice = assembly.lattice
    masses = u[: lattice.mass_count]
    finite = np.isfinite(masses).all(axis=1)
    if not finite.all():
        where = place(lattice, int(np.argmin(finite)))
        return Fault(Status.NON_FINITE, f"the mass at {where} has left the range of numbers")
    for links in (assembly.links, assembly.directional):
        if len(links):
            a, b = links.nodes.T
            share = np.linalg.norm(links.offset + u[b] - u[a], axis=1) / links.rest_length
            if share.min() < COLLAPSED:
                where = place(lattice, int(a[np.argmin(share)]))
                return Fault(Status.INVERTED, f"the link at {where} has no length left: refine the grid")
    facing = _facing(lattice, masses)
    if facing.min() <= 0.0:
        j, i = np.unravel_index(np.argmin(facing), facing.shape)
        where = place(lattice, int(lattice.columns()[j, i, 0]))
        return Fault(Status.INVERTED, f"the cell at {where} has turned inside out: refine the grid")
    return None


def place(lattice: Lattice, mass: int) -> str:
    """Where a mass lies on the flat sheet, in words."""
    x, y, _ = lattice.positions[mass]
    return f"x = {x:.4g} m, y = {y:.4g} m"


def fastest(lattice: Lattice, v: np.ndarray) -> str:
    """Where the fastest mass lies, v: (n, 3) [m/s]; the first whose speed is no number, if there is one."""
    speed = np.abs(v[: lattice.mass_count]).max(axis=1)
    return place(lattice, int(np.argmax(np.where(np.isfinite(speed), speed, np.inf))))


def digits(problem: Problem, state: State) -> Fault | None:
    """Where the rounding of the internal force may move the equilibrium by more than DOUBTFUL: how far, and
    `singular` where the unbalanced force that it has left does move it by more than LOST."""
    largest = float(np.abs(state.u).max())
    if state.factor is None or largest == 0.0:
        return None
    links = problem.assembly.links
    relative = np.linalg.norm(np.diff(state.u[links.nodes], axis=1)[:, 0], axis=1)
    carried = np.zeros((len(state.u), 1))
    np.add.at(carried[:, 0], links.nodes.ravel(), np.repeat(links.stiffness * relative, 2))
    noise = np.random.default_rng(0).standard_normal((SAMPLES, *state.u.shape))
    moved = [problem.expand(state.factor.solve(problem.reduce(carried * sample))) for sample in noise]
    share = problem.assembly.rounding * float(np.abs(moved).max()) / largest
    if not share > DOUBTFUL:
        return None
    unbalanced, _ = problem.residual(state.u, state.load_factor)
    left = float(np.abs(problem.expand(state.factor.solve(problem.reduce(unbalanced)))).max()) / largest
    return Fault(
        Status.CONVERGED if left <= LOST else Status.SINGULAR,
        f"rounding may move the masses by {share:.1g} of the largest displacement "
        f"(condition number {state.factor.condition():.1e}): use fewer, or thicker, cells",
    )


def layers(scene: Scene, assembly: Assembly, u: np.ndarray) -> str:
    """A sentence where the sheet's stretching lies in layers thinner than the grid's cells, else nothing."""
    lattice = assembly.lattice
    stretched = _stretch_share(assembly, u)
    if stretched < FREE_OF_STRETCH:
        return ""
    kappa = _double_curvature(lattice, u[: lattice.mass_count])
    j, i = np.unravel_index(np.argmax(kappa), kappa.shape)
    if kappa[j, i] == 0.0:
        return ""
    h, nu = scene.sheet.thickness, scene.material.poisson
    width = np.sqrt(h / kappa[j, i]) / (12.0 * (1.0 - nu**2)) ** 0.25
    ratio = max(lattice.spacing[:2]) / width
    if ratio < RESOLVED:
        return ""
    where = place(lattice, int(lattice.columns()[j, i, 0]))
    return (
        f"not unique to the sheet but to this grid: cells {ratio:.2g} times as long as the layer in which it "
        f"stretches ({1e3 * width:.2g} mm near {where}); refine the grid until the answer stays"
    )


def _corners(field: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    return field[:-1, :-1], field[:-1, 1:], field[1:, 1:], field[1:, :-1]


def _surface(lattice: Lattice, u: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Mid-surface positions (ny, nx, 3) [m] and unit directors, from the bottom layer to the top."""
    now = (lattice.positions + u)[lattice.columns()]
    across = now[:, :, -1] - now[:, :, 0]
    size = np.linalg.norm(across, axis=2, keepdims=True)
    return now.mean(axis=2), across / np.maximum(size, np.finfo(float).tiny)


def _facing(lattice: Lattice, u: np.ndarray) -> np.ndarray:
    """Normal times mean director of every cell, over their area when flat, (ny − 1, nx − 1)."""
    middle, director = _surface(lattice, u)
    a, b, c, d = _corners(middle)
    normal = 0.5 * np.cross(c - a, d - b)
    mean = sum(_corners(director)) / 4.0
    facing: np.ndarray = np.einsum("jiq,jiq->ji", normal, mean) / (lattice.spacing[0] * lattice.spacing[1])
    return facing


def _double_curvature(lattice: Lattice, u: np.ndarray) -> np.ndarray:
    """√|κ₁ κ₂| of every cell from the directors' changes along x and y, (ny − 1, nx − 1) [1/m]."""
    middle, director = _surface(lattice, u)
    (a, b, c, d), (p, q, r, s) = _corners(middle), _corners(director)
    along, across = 0.5 * (b + c - a - d), 0.5 * (c + d - a - b)
    bent_along, bent_across = 0.5 * (q + r - p - s), 0.5 * (r + s - p - q)
    lx, ly, _ = lattice.spacing
    kxx = np.einsum("jiq,jiq->ji", along, bent_along) / lx**2
    kyy = np.einsum("jiq,jiq->ji", across, bent_across) / ly**2
    kxy = 0.5 * np.einsum("jiq,jiq->ji", along, bent_across) / (lx * ly)
    kxy += 0.5 * np.einsum("jiq,jiq->ji", across, bent_along) / (lx * ly)
    gauss: np.ndarray = np.sqrt(np.abs(kxx * kyy - kxy**2))
    return gauss


def _stretch_share(assembly: Assembly, u: np.ndarray) -> float:
    """Energy of the layers' mean stretch, as the in-plane links have it, over the elastic energy."""
    links, lattice = assembly.links, assembly.lattice
    total, _ = assembly.force(u)
    in_plane = np.flatnonzero(links.offset[:, 2] == 0.0)
    if total <= 0.0 or len(in_plane) == 0:
        return 0.0
    layers_ = lattice.grid[2]
    elongation = assembly.stresses(u).links[in_plane] / links.stiffness[in_plane]
    column = links.nodes[in_plane] // layers_
    _, member = np.unique(column[:, 0] * lattice.mass_count + column[:, 1], return_inverse=True)
    count = np.bincount(member)
    mean = np.bincount(member, elongation) / count
    stiffness = np.bincount(member, links.stiffness[in_plane])
    return float(0.5 * np.sum(stiffness * mean**2) / total)
