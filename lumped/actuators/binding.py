"""Linear maps from a chain's rows to the masses of its edge, and the chain's mass matrix.

The edge is a smooth curve through the chain's joints, whatever the number of masses: a polygon's kinks would
bend the sheet the more sharply the finer its cells are. For the arc length s in segments, x_j the joints and
ends, t_k the tangents and n_k the normals of segments,

    r(s) = the cubic from x_j to x_{j+1} with slopes m_j,      r(s) + z d(s) = the mass at height z

m_j is the slope at j of the polynomial whose mean over each neighbouring segment k, two on either side, is
the tangent t_k; at ends there are fewer, and a base's tangent replaces the missing ones. The director d(s) is
the sum of n_k with the weights that the t_k have in r'(s), so that it turns with the curve; at a corner the
director is the corner's. A base in between divides the curve in two, since moments may differ there. Arcs are
1 + φ²/24 as long as their chords, φ the angle of a joint, an error of the second order like the chain's.

A segment is a cylinder of the chain's radius a: it has the mass m of a uniform rod, and the rotary inertia
about its axis as m a²/4 of each director.
"""

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from lumped.actuators.frames import B, Frames, N, T
from sheetbench.scenes import Chain

NEIGHBOURS = 2  # segments on either side of a joint that its slope is taken from


def bind(
    frames: Frames, rows: int, along: np.ndarray, height: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the linear maps of masses bound to a chain: binding (m, rows) from its rows to the masses'
    displacement, shares (segments, m) of each mass among the segments, and arms (m, 3) [m] of the masses'
    forces about a base's frame; along, height: arc length and height over the axis (m,) [m]."""
    count, base = frames.segments, frames.base_joint
    binding, share = np.zeros((len(along), rows)), np.zeros((count, len(along)))
    ground = {} if base is None else {base: count}
    corners = {frames.end_point(end): count + 1 + k for k, end in enumerate(frames.corners)}
    tangents, normals = _slopes(count, ground), _slopes(count, ground | corners)
    place = along / frames.length
    arms = np.zeros((len(along), 3))
    for i, (p, z) in enumerate(zip(place, height, strict=True)):
        nearest = round(p)
        tie = abs(p - nearest) < 1e-9 and 0 < nearest < count
        owners = (nearest - 1, nearest) if tie else (min(max(int(p), 0), count - 1),)
        share[list(owners), i] = 1.0 / len(owners)
        joint, by_tangent, _ = _cubic(tangents, p)
        binding[i, joint] = 1.0
        binding[i, 1 : count + 1] += by_tangent[:count]
        binding[i, :count] -= by_tangent[:count]
        _, _, by_normal = _cubic(normals, p)
        lever = z / frames.length
        binding[i, frames.points : frames.points + count] += lever * by_normal[:count]
        for k, end in enumerate(frames.corners):
            binding[i, frames.corner_row[end]] += lever * by_normal[count + 1 + k]
        arms[i] = frames.length * by_tangent[count] * frames.axes[T] + z * by_normal[count] * frames.axes[N]
    return binding, share, arms


def _slopes(count: int, prescribed: Mapping[int, int]) -> np.ndarray:
    """Return the slopes m_j of r(s) at joints and ends (segments + 1, tangents), in parts of the tangents of
    segments, of a base and of corners. prescribed: number of the tangent of a base or a corner, by the joint
    or end that has it."""
    slopes = np.zeros((count + 1, max([count, *prescribed.values()]) + 1))
    for first, last in pairwise(sorted({0, count, *prescribed})):
        for joint in range(first, last + 1):
            if joint in prescribed:
                slopes[joint, prescribed[joint]] = 1.0
                continue
            segments = np.arange(max(first, joint - NEIGHBOURS), min(last, joint + NEIGHBOURS))
            ends = [end for end in (first, last) if end in prescribed and abs(end - joint) < NEIGHBOURS]
            numbers = [*segments, *(prescribed[end] for end in ends)]
            slopes[joint, numbers] = _weights(segments - joint, np.array(ends) - joint)
    return slopes


def _cubic(slopes: np.ndarray, s: float) -> tuple[int, np.ndarray, np.ndarray]:
    """Return the joint or end j before s, and r(s) − x_j and r'(s) in parts of the tangents."""
    j = min(max(int(np.floor(s + 1e-9)), 0), len(slopes) - 2)
    xi, (start, end) = s - j, slopes[j : j + 2]
    curve = xi * (1.0 - xi) * ((1.0 - xi) * start - xi * end)
    curve[j] += xi**2 * (3.0 - 2.0 * xi)
    slope = (1.0 - xi) * (1.0 - 3.0 * xi) * start + xi * (3.0 * xi - 2.0) * end
    slope[j] += 6.0 * xi * (1.0 - xi)
    return j, curve, slope


def _weights(means: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Return the weights (k + v,) that give a polynomial of k + v terms at 0 from its means over the segments
    that begin at `means` (k,) and its values at `values` (v,)."""
    powers = np.arange(len(means) + len(values))
    of_means = ((means[:, None] + 1.0) ** (powers + 1) - means[:, None] ** (powers + 1.0)) / (powers + 1)
    moments = np.concatenate([of_means, values[:, None] ** (1.0 * powers)])
    return np.asarray(np.linalg.solve(moments.T, np.eye(len(powers))[0]))


def mass_matrix(frames: Frames, rows: int, chains: Sequence[Chain], offsets: np.ndarray) -> np.ndarray:
    """Return the mass (rows, rows) [kg] of chains with axes at the offsets (c,) [m] from the common one."""
    mass = np.zeros((rows, rows))
    for chain, offset in zip(chains, offsets, strict=True):
        m = chain.line_density * frames.length
        for i in range(frames.segments):
            axis = np.zeros((2, rows))  # the ends of this chain's axis from the common rows
            axis[0, i] = axis[1, i + 1] = 1.0
            axis[:, frames.points + i] = offset / frames.length
            mass += axis.T @ (m / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])) @ axis
            for kind in (N, B):
                row = frames.points + (kind - 1) * frames.segments + i
                mass[row, row] += m * chain.radius**2 / 4.0 / frames.length**2
    return mass
