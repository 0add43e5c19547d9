"""How finely the lattice divides a chain: its segments, or equal parts of them.

A chain is an elastic rod to which a sheet's edge is bound; its segments say over which lengths an intrinsic
curvature is constant and over which forces are summed. The lattice solves it as rigid parts with a joint
between each two, EI over a part's length: a segment a part, and where cells along the edge are shorter, each
segment in as many equal parts as bring them to a cell's length, FINE along the edge at most. So parts take
part in the grid's refinement, with an error of the second order in their length: of six segments a strip
(`tests/lumped/statics/test_chain_parts.py`) was 2.5 to 4.8 % off on 13 to 49 cells, since arcs are longer
than their chords by 1 + φ²/24 and a sheet resists the stretch, and loads bend joints as a trapezoidal rule
has it.
"""

from __future__ import annotations

import numpy as np

from lumped.actuators.frames import Frames
from sheetbench.scenes import Chain

FINE = 24  # parts that are enough: 0.05 % off where a strip is turned by more than its length


def parts_of_a_segment(chain: Chain, cells: int) -> int:
    """Return into how many parts each segment is divided beside so many cells; a chain has two at least, or
    it could not bend, and with a base in the middle an even number, for a joint to be there."""
    parts = -(-max(2, min(cells, FINE)) // chain.segments)
    return parts + parts * chain.segments % 2 * (chain.base == "middle")


def mean_curvatures(chain: Chain, frames: Frames) -> np.ndarray:
    """Return the share (joints, pieces) that the pieces of constant curvature have in each joint of a divided
    chain: what of the joint's length lies in them."""
    ground, count = frames.segments, frames.segments
    ends = np.array(
        [
            (after if before == ground else before + 0.5, before + 1 if after == ground else after + 0.5)
            for before, after, _ in frames.joints
        ]
    )
    bounds = chain.pieces() * (count // chain.segments)
    common = np.minimum(ends[:, 1:], bounds[1:]) - np.maximum(ends[:, :1], bounds[:-1])
    return np.asarray(np.maximum(common, 0.0) / (ends[:, 1:] - ends[:, :1]))
