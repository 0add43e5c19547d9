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
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lumped.actuators.frames import B, Frames, N, T
from sheetbench.scenes import Chain

AROUND = 2  # segments on either side of a joint that its slope is taken from


@dataclass(frozen=True)
class Binding:
    """rows: (m, rows) of masses on rows; share: (segments, m) of each in the segments; arms: (m, 3) [m] of
    masses on the frame that a base is, about which their force has a moment."""

    rows: np.ndarray
    share: np.ndarray
    arms: np.ndarray


def bind(frames: Frames, rows: int, along: np.ndarray, height: np.ndarray) -> Binding:
    """The binding of masses at arc length and height over the axis (m,) [m]."""
    count, base = frames.segments, frames.base_joint
    binding, share = np.zeros((len(along), rows)), np.zeros((count, len(along)))
    ground = {} if base is None else {base: count}
    corners = {frames.end_point(end): count + 1 + k for k, end in enumerate(frames.corners)}
    tangents, normals = _Curve.of(count, ground), _Curve.of(count, ground | corners)
    place = along / frames.length
    arms = np.zeros((len(along), 3))
    for i, (p, z) in enumerate(zip(place, height, strict=True)):
        nearest = round(p)
        tie = abs(p - nearest) < 1e-9 and 0 < nearest < count
        owners = (nearest - 1, nearest) if tie else (min(max(int(p), 0), count - 1),)
        share[list(owners), i] = 1.0 / len(owners)
        joint, by_tangent = tangents.place(p)
        binding[i, joint] = 1.0
        binding[i, 1 : count + 1] += by_tangent[:count]
        binding[i, :count] -= by_tangent[:count]
        by_normal = normals.slope(p)
        lever = z / frames.length
        binding[i, frames.points : frames.points + count] += lever * by_normal[:count]
        for k, end in enumerate(frames.corners):
            binding[i, frames.corner_row[end]] += lever * by_normal[count + 1 + k]
        arms[i] = frames.length * by_tangent[count] * frames.axes[T] + z * by_normal[count] * frames.axes[N]
    return Binding(binding, share, arms)


@dataclass(frozen=True)
class _Curve:
    """Slopes m_j of r(s) at joints and ends (segments + 1, tangents), in parts of the tangents of segments,
    of a base and of corners."""

    slopes: np.ndarray

    @classmethod
    def of(cls, count: int, known: Mapping[int, int]) -> _Curve:
        """known: the numbers of the tangents that joints and ends have of a base or a corner."""
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
        return cls(slopes)

    def place(self, s: float) -> tuple[int, np.ndarray]:
        """The joint or end j before s, and r(s) − x_j in parts of the tangents."""
        j, xi = self._segment(s)
        found = xi * (1.0 - xi) * ((1.0 - xi) * self.slopes[j] - xi * self.slopes[j + 1])
        found[j] += xi**2 * (3.0 - 2.0 * xi)
        return j, found

    def slope(self, s: float) -> np.ndarray:
        """r'(s) in parts of the tangents."""
        j, xi = self._segment(s)
        found = (1.0 - xi) * (1.0 - 3.0 * xi) * self.slopes[j] + xi * (3.0 * xi - 2.0) * self.slopes[j + 1]
        found[j] += 6.0 * xi * (1.0 - xi)
        return np.asarray(found)

    def _segment(self, s: float) -> tuple[int, float]:
        j = min(max(int(np.floor(s + 1e-9)), 0), len(self.slopes) - 2)
        return j, s - j


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
