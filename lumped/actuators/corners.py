"""Ends of chains at corners of the sheet, and ties between two chains that share one.

Two chains on neighbouring edges have the corner's point and director in common, as rods bound to a shell
have: without it the second would pass its end's moment on through one cell of the sheet, whose size the grid
decides.
The point and the director's row are those of the first chain, which binds the corner's masses; those of the
second follow them. Which is first makes no difference to what they exert or to where they are. A base holds
point and director where it stands, so at a corner it holds the other chain's end too, as a clamp would. Left
to the sheet: corners that another support or a motion takes.

What two chains both hold must be one equation, or the equations are singular. Scenes refuse what holds a
chain along itself twice (`scenes.meaning.corners`). Across the sheet, with n the director's small tilt
(n_x, n_y), a chain along x has one n_y throughout, for it is untwisted, and, "inplane", one n_x too:

    z(end) − z(start) + L n_x = 0,      n and z of the corner = n and z of both chains' ends

and likewise along y, what is held being 0. Of the conditions at corners those that follow from the rest of
this linear system are left out.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from lumped.actuators.frames import SharedEnd
from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Chain, Scene, holds_director

Condition = dict[tuple[object, ...], float]  # the coefficients of its unknowns


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
    own, found = _chains(scene)[edge].base_ends, []
    moved = {motion.edge for motion in scene.motions().values()}
    still = {s.edge for s in scene.supports if s.motion is None and holds_director(s)}
    for end in (0, 1):
        held = _beside(edge, end) in still - moved or based_beside(scene, edge, end)
        found.extend([end] if held and end not in own else [])
    return tuple(found)


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


def shared_ends(scene: Scene, shared: list[SharedCorner]) -> dict[str, dict[int, SharedEnd]]:
    """What each chain's ends bring to the corners that it shares, by edge and end (0 or 1)."""
    chains = _chains(scene)
    still = {edge for edge, chain in chains.items() if chain.base != "free" or held_ends(scene, edge)}
    rows: list[Condition] = [  # z(1) − z(0) + L n_along = 0, with L n_along the unknown
        {(edge, 0, "level"): -1.0, (edge, 1, "level"): 1.0, (edge, "n", "along"): 1.0}
        for edge, chain in chains.items()
        if chain.plane == "inplane" and edge not in still
    ]
    brought: dict[str, dict[int, dict[str, bool]]] = {edge: {} for edge in chains}
    for part in ("level", "across", "along"):
        for corner in shared:
            for edge, end in zip(corner.edges, corner.ends, strict=True):
                here = brought[edge].setdefault(end, {"own": edge == corner.edges[0]})
                asks = part == "across" or chains[edge].plane == "inplane"
                row = _condition(corner, edge, end, part, edge in still)
                here[part] = not (asks and _follows(row, rows))
                if asks and here[part]:
                    rows.append(row)
    return {edge: {end: SharedEnd(**here) for end, here in ends.items()} for edge, ends in brought.items()}


def _condition(corner: SharedCorner, edge: str, end: int, part: str, still: bool) -> Condition:
    """That z ("level") or a component of n, along or across the chain, is the chain's at a corner: what is
    held still is no unknown."""
    along = EDGES[edge].along_axis
    of_corner = {"level": 2, "along": along, "across": 1 - along}[part]
    of_chain = (edge, end if part == "level" else "n", part)
    return {(*corner.edges, of_corner): -1.0} | ({} if still else {of_chain: 1.0})


def _follows(row: Condition, rows: list[Condition]) -> bool:
    """Whether a linear condition follows from others."""
    unknowns = sorted({unknown for one in (row, *rows) for unknown in one}, key=str)
    matrix = np.array([[one.get(unknown, 0.0) for unknown in unknowns] for one in (*rows, row)])
    return bool(np.linalg.matrix_rank(matrix) == np.linalg.matrix_rank(matrix[:-1]))
