"""Division of a chain by the lattice: its segments, or equal parts of them.

A chain is an elastic rod to which a sheet's edge is bound; over each of its segments an intrinsic curvature
is constant and forces are summed. The lattice solves it as rigid parts with a joint between each two,
EI over a part's length. A segment is one part, or, beside cells shorter than a segment, as many equal parts
as bring them to a cell's length, at most MOST_PARTS along the edge. So parts are refined with the grid, with
an error of the second order in their length: a strip with six undivided segments
(`tests/lumped/statics/test_chain_parts.py`) was 2.5 to 4.8 % off on 13 to 49 cells, since arcs are longer
than their chords by 1 + φ²/24 and a sheet resists the stretch, and loads on joints are a trapezoidal rule.
"""

import numpy as np

from lumped.actuators.frames import Frames
from sheetbench.scenes import Chain

MOST_PARTS = 24  # 0.05 % off where a strip is turned by more than its length


def parts_of_a_segment(chain: Chain, cells: int) -> int:
    """Return the number of parts into which each segment is divided on an edge with `cells` cells. A chain
    needs at least two parts to bend, and with a base in the middle an even number for a joint there."""
    parts = -(-max(2, min(cells, MOST_PARTS)) // chain.segments)
    return parts + parts * chain.segments % 2 * (chain.base == "middle")


def refining_cells(chain: Chain, cells: int, ratio: float) -> int:
    """Return the smallest number of cells along an edge for which a chain is divided more finely.

    Parameters
    ----------
    chain : Chain
        The chain.
    cells : int
        A number of cells along its edge.
    ratio : float
        The least ratio of the numbers of parts.

    Returns
    -------
    int
        The number, 0 where it exceeds MOST_PARTS.
    """
    parts = int(np.ceil(ratio * parts_of_a_segment(chain, cells)))
    enough = chain.segments * (parts - 1) + 1
    return enough if enough <= MOST_PARTS else 0


def mean_curvatures(chain: Chain, frames: Frames) -> np.ndarray:
    """Return the share (joints, pieces) of each joint's length, in a divided chain, that lies in each piece
    of constant curvature."""
    ground, count = frames.segments, frames.segments
    before, after, _ = np.array(frames.joints).T
    start = np.where(before == ground, after, before + 0.5)
    ends = np.column_stack([start, np.where(after == ground, before + 1, after + 0.5)])
    bounds = chain.pieces() * (count // chain.segments)
    common = np.minimum(ends[:, 1:], bounds[1:]) - np.maximum(ends[:, :1], bounds[:-1])
    return np.asarray(np.maximum(common, 0.0) / (ends[:, 1:] - ends[:, :1]))
