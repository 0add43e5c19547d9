"""Ends of chains at corners of the sheet, and ties between two chains that share one.

Two chains on neighbouring edges have the corner's point and director in common, as rods bound to a shell do:
otherwise the second would pass its end's moment on through one cell of the sheet, whose size depends on the
grid. The first chain has the rows of point and director and binds the corner's masses; the second chain's
point and director follow. The order makes no difference to forces or displacements. A base holds point and
director at its place, so at a corner it holds the other chain's end too, as a clamp would. Corners that
another support or a motion holds are not tied.

A constraint that two chains both impose must enter once, or the equations are singular. Scenes with a chain
held twice along itself are refused (`scenes.meaning.corners`). Across the sheet, a constraint at a corner is
left out if on the flat sheet it follows from the constraints elsewhere and at earlier corners.
"""

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Chain, Scene, holds_director

DEPENDENT_BELOW = 1e-9  # of a gradient's norm: the rounding left of a combination of other gradients


@dataclass(frozen=True)
class SharedCorner:
    """Edges and ends (0 or 1) of two chains that share a corner; the first binds its masses."""

    edges: tuple[str, str]
    ends: tuple[int, int]


@dataclass(frozen=True)
class Tie:
    """Rows (k,) whose displacement is weights (k, s) @ the displacement of other rows (s,)."""

    rows: np.ndarray
    others: np.ndarray
    weights: np.ndarray


def held_ends(scene: Scene, edge: str) -> tuple[int, ...]:
    """Return the ends of a chain's edge, its base's excepted, at which a support on the neighbouring edge or
    the base of a chain on that edge holds position and director."""
    moved = {motion.edge for motion in scene.motions().values()}
    still = {s.edge for s in scene.supports if s.motion is None and holds_director(s)}
    supports = still - moved
    held = {e for e in (0, 1) if _neighbour(edge, e) in supports or adjacent_base(scene, edge, e)}
    return tuple(sorted(held.difference(_chains(scene)[edge].base_ends)))


def adjacent_base(scene: Scene, edge: str, end: int) -> str | None:
    """Return the edge that meets another at its end, if a chain on it has its base at their corner."""
    neighbour = _neighbour(edge, end)
    chain = _chains(scene).get(neighbour)
    return neighbour if chain is not None and int(edge[1]) in chain.base_ends else None


def _neighbour(edge: str, end: int) -> str:
    """Return the edge that meets another at its end."""
    return f"{'xy'[EDGES[edge].along_axis]}{end}"


def _chains(scene: Scene) -> dict[str, Chain]:
    return {edge: next(iter(chains.values())) for edge, chains in scene.chains().items()}


def shared_corners(scene: Scene, lattice: Lattice, taken: np.ndarray) -> list[SharedCorner]:
    """Return the corners at which two chains without a base there meet, unless a support or motion holds the
    masses; taken: (n,) bool, masses that one holds."""
    chains = _chains(scene)
    corners = []
    for first, second in combinations(chains, 2):
        ends = int(second[1]), int(first[1])
        free = not taken[lattice.edge_columns(first)[-ends[0]]].any()
        based = ends[0] in chains[first].base_ends or ends[1] in chains[second].base_ends
        if _neighbour(first, ends[0]) == second and free and not based:
            corners.append(SharedCorner((first, second), ends))
    return corners


def redundant_constraints(gradient: np.ndarray, rank: np.ndarray) -> list[int]:
    """Return the numbers of redundant constraints: their gradients (c, n) by the free rows are linear
    combinations of earlier gradients in the order of rank (c,). Constraints of rank 0 are independent."""
    basis, dependent = np.linalg.qr(gradient[rank == 0].T)[0], []
    for number in np.argsort(rank, kind="stable")[np.sum(rank == 0) :].tolist():
        remainder = gradient[number] - basis @ (basis.T @ gradient[number])
        remainder -= basis @ (basis.T @ remainder)
        length = float(np.linalg.norm(remainder))
        if length <= DEPENDENT_BELOW * np.linalg.norm(gradient[number]):
            dependent.append(number)
        else:
            basis = np.column_stack([basis, remainder / length])
    return dependent
