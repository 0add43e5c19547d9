"""What an equilibrium's springs store, and how far they are strained, as one compiled loop."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from lumped.springs import cells, links
from sheetbench.numerics.typed import inner, njit


class Survey(NamedTuple):
    """energies: of the springs under each name in the spring set [J]; strain: the largest relative change of
    length of the links in a layer; stretch: of their energy that of the layers' mean stretch [J]."""

    energies: dict[str, float]
    strain: float
    stretch: float


@njit(cache=True, nogil=True)
def survey(
    u: np.ndarray, springs: Any, areas: tuple[Any, ...], kind: np.ndarray, kinds: int, layers: int
) -> tuple[np.ndarray, float, float]:
    """Return the energies of the links by kind (m,) and of both kinds of springs on cells, (kinds + 6,) [J],
    and the rest of a `Survey`; springs: `SpringArrays`; areas: the three tags of area springs alone."""
    along, elongation = springs.links, links.elongations(u, springs.links)
    energies, stretch, summed, met = np.zeros(kinds + 6), 0.0, 0.0, 0
    for m in range(len(elongation)):
        half, e = 0.5 * along.constants[m], elongation[m]
        energies[kind[m]] += half * (e * e)
        if along.offset[m, 2] == 0.0:
            # links between the same columns follow each other, layer by layer, and are as stiff as each other
            summed, met = summed + e, met + 1
            if met % layers == 0:
                stretch, summed = stretch + half * (summed * summed) / layers, 0.0
    add_sums(cells.energies(u, springs.layers, areas[0]), energies[kinds:])
    add_sums(cells.energies(u, springs.middle, areas[1]), energies[kinds + 2 :])
    add_sums(cells.energies(u, springs.faces, areas[2]), energies[kinds + 4 :])
    return energies, links.strains(np.expand_dims(u, 0), along, 0.0)[0][0], stretch


@inner()
def add_sums(each: np.ndarray, out: np.ndarray) -> None:
    """Add (c, 2) over all c."""
    for c in range(len(each)):
        out[0] += each[c, 0]
        out[1] += each[c, 1]
