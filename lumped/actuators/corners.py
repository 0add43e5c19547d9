"""Ends of chains at corners of the sheet, and ties between two chains that share one.

Two chains on neighbouring edges have the corner's point and director in common, as rods bound to a shell
have: without it the second would pass its end's moment on through one cell of the sheet, whose size the grid
decides.
The point and the director's row are those of the first chain, which binds the corner's masses; those of the
second follow them. Which is first makes no difference to what they exert or to where they are.

Left to the sheet: corners that a support or a motion takes, and the end at which a chain has its base. Chains
are inextensible, untwisted and, in a plane, straight across it: where both hold a component of the corner's
place already (`_rigid`), as two with bases do, only the director is tied; the sheet ties the places, as its
cells shrink, and the corner's masses are the first chain's.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from lumped.actuators.frames import B, N, T
from lumped.lattice import Lattice
from sheetbench.scenes import EDGES, Chain, Scene, holds_director

BASED = {"start": 0, "end": 1}


@dataclass(frozen=True)
class SharedCorner:
    """Edges and ends (0 or 1) of two chains that share a corner; the first binds its masses. tied: whether
    they have the point in common too."""

    edges: tuple[str, str]
    ends: tuple[int, int]
    tied: bool


@dataclass(frozen=True)
class Tie:
    """Rows (k,) whose displacement is weights (k, s) @ that of other rows (s,)."""

    rows: np.ndarray
    others: np.ndarray
    weights: np.ndarray


def held_ends(scene: Scene, edge: str) -> tuple[int, ...]:
    """Ends of an edge at which a support on the neighbouring edge holds position and director."""
    return tuple(end for end in (0, 1) if _corner_is_held(scene, edge, end))


def _corner_is_held(scene: Scene, edge: str, end: int) -> bool:
    beside = _beside(edge, end)
    moved = any(motion.edge == beside for motion in scene.motions().values())
    here = [support for support in scene.supports if support.edge == beside and support.motion is None]
    return not moved and any(holds_director(support) for support in here)


def _beside(edge: str, end: int) -> str:
    """The edge that meets another at an end of it."""
    return f"{'xy'[EDGES[edge].along_axis]}{end}"


def shared_corners(scene: Scene, lattice: Lattice, taken: np.ndarray) -> list[SharedCorner]:
    """Corners at which two chains meet and whose masses nothing else has taken, (n,) bool."""
    chains = {edge: next(iter(here.values())) for edge, here in scene.chains().items()}
    found = []
    for first, second in combinations(chains, 2):
        ends = int(second[1]), int(first[1])
        free = not taken[lattice.edge_columns(first)[-ends[0]]].any()
        pair = (chains[first], ends[0]), (chains[second], ends[1])
        based = any(BASED.get(chain.base) == end for chain, end in pair)
        if _beside(first, ends[0]) == second and free and not based:
            tied = not any(_held_twice(scene, chains, pair, axis) for axis in range(3))
            found.append(SharedCorner((first, second), ends, tied))
    return found


def _held_twice(
    scene: Scene, chains: dict[str, Chain], pair: tuple[tuple[Chain, int], ...], axis: int
) -> bool:
    """Whether each of two chains keeps its end in place along an axis."""
    kinds = [N if axis == 2 else T if EDGES[chain.edge].along_axis == axis else B for chain, _ in pair]
    return all(_rigid(scene, chains, *each, kind) for each, kind in zip(pair, kinds, strict=True))


def _rigid(scene: Scene, chains: dict[str, Chain], chain: Chain, end: int, kind: int) -> bool:
    """Whether a flat chain's end cannot move along its t, n or b: by its base, along b and n by its plane,
    and along t by its other end."""
    based, held = chain.base != "free", held_ends(scene, chain.edge)
    if kind == T:
        beyond = chains.get(_beside(chain.edge, 1 - end))
        return based or 1 - end in held or (beyond is not None and beyond.base != "free")
    if kind == N:
        return chain.plane == "inplane" and (based or 1 - end in held)
    return chain.plane == "normal" and based
