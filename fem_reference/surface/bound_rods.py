"""What binds rods to a model: where the vectors of their sides are among the model's.

A model has N nodal vectors (N, 3): those of the sheet first, then those that are the rods' own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fem_reference.surface.rod import Rod
from fem_reference.surface.rod_elements import RodElements


@dataclass(frozen=True)
class BoundRods:
    """The rods of a scene among the vectors of a model.

    elements: all rods' sides; sites: (k, a) of Q among the model's vectors; own: the rods' own vectors at
    rest (q, 3), which come last; held: (q,) whether a base holds them.
    """

    rods: tuple[Rod, ...]
    elements: RodElements
    sites: np.ndarray
    own: np.ndarray
    held: np.ndarray

    def by_rod(self, of_sides: np.ndarray) -> list[np.ndarray]:
        """Values (k, …) of all sides, rod by rod."""
        return np.split(of_sides, np.cumsum([len(rod.nodes) for rod in self.rods])[:-1]) if self.rods else []


def on_surface(rods: Sequence[Rod], count: int) -> BoundRods:
    """The rods on a surface of `count` nodes, vectors φ (n), d (n) and then m of every rod's nodes."""
    sites, first = [np.zeros((0, 9), dtype=int)], 2 * count
    own, held = [np.zeros((0, 3))], [np.zeros(0, dtype=bool)]
    for rod in rods:
        sites.append(np.concatenate([rod.nodes, count + rod.nodes, first + rod.places], axis=1))
        own.append(np.tile(rod.elements.reference[0, 6], (len(rod.line), 1)))
        held.append(np.arange(len(rod.line)) == (-1 if rod.base is None else rod.base))
        first += len(rod.line)
    elements = RodElements.joined([rod.elements for rod in rods], 9)
    return BoundRods(tuple(rods), elements, *(np.concatenate(part) for part in (sites, own, held)))


def block_diagonal(blocks: Sequence[np.ndarray]) -> np.ndarray:
    """Blocks (k, r, c) along the diagonal, (k, Σ r, Σ c)."""
    rows, columns = (np.cumsum([0, *(block.shape[axis] for block in blocks)]) for axis in (1, 2))
    out = np.zeros((len(blocks[0]), rows[-1], columns[-1]))
    for i, block in enumerate(blocks):
        out[:, rows[i] : rows[i + 1], columns[i] : columns[i + 1]] = block
    return out
