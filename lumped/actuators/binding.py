"""How a chain's rows carry masses of the edge and its own inertia: two constant linear maps.

The edge is a smooth curve through the chain's joints, whatever the number of masses: a polygon's kinks would
bend the sheet the more sharply the finer its cells are. With arc length s in segments, x_j the joints and
ends, t_k the tangents and n_k the normals of segments,

    r(s) = the cubic from x_j to x_{j+1} with slopes m_j,      r(s) + z d(s) = the mass at height z

m_j is the slope at j of the polynomial whose means over the segments around, two on either side, are those of
r', t_k; at ends there are fewer, and a base's tangent stands for the missing ones. As r'(s) is a sum of t_k,
d(s) is that sum of n_k, so that it turns with the curve; at a corner the director is the corner's. A base in
between divides the curve in two, since moments may differ there. Arcs are 1 + φ²/24 as long as their chords,
φ the angle of a joint, an error of the second order as the chain's own.

A segment is a cylinder of the chain's radius a: it has the mass m of a uniform rod, and the rotary inertia
about its axis as m a²/4 of each director.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise

import numpy as np

from lumped.actuators.frames import B, Frames, N, T
from sheetbench.scenes import Chain

AROUND = 2  # segments on either side of a joint that its slope is taken from


def bind(
    frames: Frames, rows: int, along: np.ndarray, height: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the binding of masses at arc length and height over the axis (m,) [m] on rows, (m, rows), the
    share of each in the segments, (segments, m), and their arms on the frame that a base is, about which
    their force has a moment, (m, 3) [m]."""
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


def _slopes(count: int, known: Mapping[int, int]) -> np.ndarray:
    """Slopes m_j of r(s) at joints and ends (segments + 1, tangents), in parts of the tangents of segments,
    of a base and of corners; known: the numbers of those that joints and ends have of a base or a corner."""
    slopes = np.zeros((count + 1, max([count, *known.values()]) + 1))
    for first, last in pairwise(sorted({0, count, *known})):
        for joint in range(first, last + 1):
            if joint in known:
                slopes[joint, known[joint]] = 1.0
                continue
            around = np.arange(max(first, joint - AROUND), min(last, joint + AROUND))
            nearby = [end for end in (first, last) if end in known and abs(end - joint) < AROUND]
            numbers = [*around, *(known[end] for end in nearby)]
            slopes[joint, numbers] = _weights(around - joint, np.array(nearby) - joint)
    return slopes


def _cubic(slopes: np.ndarray, s: float) -> tuple[int, np.ndarray, np.ndarray]:
    """The joint or end j before s; r(s) − x_j and r'(s) in parts of the tangents."""
    j = min(max(int(np.floor(s + 1e-9)), 0), len(slopes) - 2)
    xi, (start, end) = s - j, slopes[j : j + 2]
    place = xi * (1.0 - xi) * ((1.0 - xi) * start - xi * end)
    place[j] += xi**2 * (3.0 - 2.0 * xi)
    slope = (1.0 - xi) * (1.0 - 3.0 * xi) * start + xi * (3.0 * xi - 2.0) * end
    slope[j] += 6.0 * xi * (1.0 - xi)
    return j, place, slope


def _weights(means: np.ndarray, values: np.ndarray) -> np.ndarray:
    """What part its means over the segments that begin at `means` (k,), and its `values` there (v,), have in
    the value at 0 of a polynomial of k + v terms."""
    powers = np.arange(len(means) + len(values))
    of_means = ((means[:, None] + 1.0) ** (powers + 1) - means[:, None] ** (powers + 1.0)) / (powers + 1)
    moments = np.concatenate([of_means, values[:, None] ** (1.0 * powers)])
    return np.asarray(np.linalg.solve(moments.T, np.eye(len(powers))[0]))


def mass_matrix(frames: Frames, rows: int, chains: Sequence[Chain], beside: np.ndarray) -> np.ndarray:
    """Mass (rows, rows) [kg] of chains whose axes lie `beside` the common one (c,) [m]."""
    mass = np.zeros((rows, rows))
    for chain, aside in zip(chains, beside, strict=True):
        m = chain.line_density * frames.length
        for i in range(frames.segments):
            axis = np.zeros((2, rows))  # the ends of this chain's axis from the common rows
            axis[0, i] = axis[1, i + 1] = 1.0
            axis[:, frames.points + i] = aside / frames.length
            mass += axis.T @ (m / 6.0 * np.array([[2.0, 1.0], [1.0, 2.0]])) @ axis
            for kind in (N, B):
                row = frames.points + (kind - 1) * frames.segments + i
                mass[row, row] += m * chain.radius**2 / 4.0 / frames.length**2
    return mass
