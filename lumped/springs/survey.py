"""What an equilibrium's springs store, and how far they are strained, as one compiled loop."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from lumped.springs import cells, links
from sheetbench.numerics.typed import njit


class Survey(NamedTuple):
    """energies: of the springs under each name in the spring set [J]; strain: the largest relative change of
    length of the links in a layer; stretch: of their energy that of the layers' mean stretch [J]."""

    energies: dict[str, float]
    strain: float
    stretch: float


@njit(cache=True, nogil=True)
def survey(
    u: np.ndarray, springs: Any, kind: np.ndarray, kinds: int, layers: int
) -> tuple[np.ndarray, float, float]:
    """Return the energies of the links by kind (m,) and of the cells of the layers, of the mid-surface and of
    upright faces, (kinds + 3,) [J], and the rest of a `Survey`; springs: `SpringArrays`."""
    along, energies, stretch, summed, met = springs.links, np.zeros(kinds + 3), 0.0, 0.0, 0
    for m in range(len(along.nodes)):
        change, square, length, _ = links.measure(u, along, m)
        half, e = 0.5 * along.constants[m], change / (np.sqrt(square) + length)
        energies[kind[m]] += half * (e * e)
        if along.offset[m, 2] == 0.0:
            # links between the same columns follow each other, layer by layer, and are as stiff as each other
            summed, met = summed + e, met + 1
            if met % layers == 0:
                stretch, summed = stretch + half * (summed * summed) / layers, 0.0
    energies[kinds] = np.sum(cells.energies(u, springs.layers))
    energies[kinds + 1] = np.sum(cells.energies(u, springs.middle))
    energies[kinds + 2] = np.sum(cells.energies(u, springs.faces))
    return energies, links.strains(np.expand_dims(u, 0), along, 0.0)[0][0], stretch
