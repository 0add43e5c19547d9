"""Ends of chains at corners of the sheet, and ties between two chains that share one.

Two chains on neighbouring edges have the corner's point and director in common, as rods bound to a shell
have: without it the second would pass its end's moment on through one cell of the sheet, whose size the grid
decides.
The point and the director's row are those of the first chain, which binds the corner's masses; those of the
second follow them. Which is first makes no difference to what they exert or to where they are. A base holds
point and director where it stands, so at a corner it holds the other chain's end too, as a clamp would. Left
to the sheet: corners that another support or a motion takes.

What two chains both hold must be one equation, or the equations are singular. Scenes refuse what holds a
chain along itself twice (`scenes.meaning.corners`). Of what is across the sheet the constraints at corners
that follow, on the flat sheet, from all others and from those at corners before them are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Chain, Scene, holds_director

FOLLOWS = 1e-9  # of a gradient: what rounding leaves where it is a combination of others


@dataclass(frozen=True)
class SharedCorner:
    """Edges and ends (0 or 1) of two chains that share a corner; the first binds its masses."""

    edges: tuple[str, str]
    ends: tuple[int, int]


@dataclass(frozen=True)
class Tie:
    """Rows (k,) whose displacement is weights (k, s) @ that of other rows (s,)."""

    rows: np.ndarray
    others: np.ndarray
    weights: np.ndarray


def held_ends(scene: Scene, edge: str) -> tuple[int, ...]:
    """Ends of a chain's edge, but for its own base's, at which a support on the neighbouring edge or the base
    of the chain there holds position and director."""
    moved = {motion.edge for motion in scene.motions().values()}
    still = {s.edge for s in scene.supports if s.motion is None and holds_director(s)}
    held = {end for end in (0, 1) if _beside(edge, end) in still - moved or based_beside(scene, edge, end)}
    return tuple(sorted(held.difference(_chains(scene)[edge].base_ends)))


def based_beside(scene: Scene, edge: str, end: int) -> str | None:
    """The edge beside an end of another, if a chain on it has its base at their corner."""
    beside = _beside(edge, end)
    chain = _chains(scene).get(beside)
    return beside if chain is not None and int(edge[1]) in chain.base_ends else None


def _beside(edge: str, end: int) -> str:
    """The edge that meets another at an end of it."""
    return f"{'xy'[EDGES[edge].along_axis]}{end}"


def _chains(scene: Scene) -> dict[str, Chain]:
    return {edge: next(iter(here.values())) for edge, here in scene.chains().items()}


def shared_corners(scene: Scene, lattice: Lattice, taken: np.ndarray) -> list[SharedCorner]:
    """Corners at which two chains meet that have no base there, and whose masses nothing else has taken, (n,)
    bool."""
    chains = _chains(scene)
    found = []
    for first, second in combinations(chains, 2):
        ends = int(second[1]), int(first[1])
        free = not taken[lattice.edge_columns(first)[-ends[0]]].any()
        based = ends[0] in chains[first].base_ends or ends[1] in chains[second].base_ends
        if _beside(first, ends[0]) == second and free and not based:
            found.append(SharedCorner((first, second), ends))
    return found


def redundant(gradient: np.ndarray, rank: np.ndarray) -> list[int]:
    """Return which rows of the constraints' gradient (c, n) by the free rows follow from the others; those of
    rank 0, which come first, do not, rank (c,)."""
    basis, found = np.linalg.qr(gradient[rank == 0].T)[0], []
    for number in np.argsort(rank, kind="stable")[np.sum(rank == 0) :].tolist():
        left = gradient[number] - basis @ (basis.T @ gradient[number])
        left -= basis @ (basis.T @ left)
        length = float(np.linalg.norm(left))
        if length <= FOLLOWS * np.linalg.norm(gradient[number]):
            found.append(number)
        else:
            basis = np.column_stack([basis, left / length])
    return found
