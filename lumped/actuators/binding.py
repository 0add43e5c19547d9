"""How a chain's rows carry masses of the edge and its own inertia: two constant linear maps.

The edge is a smooth curve through the chain, whatever the number of masses: a polygon's kinks would bend the
sheet the more sharply the finer its cells. With arc length s in segments, x_j the joints, t_k the tangents and
n_k the normals of the segments, and held and shared ends as `lumped.actuators.frames` has them,

    X_j = x_j + (t_j − t_{j−1})/24      at joints; at ends that are held X = x, at free ones as at the next joint
    r(s) = the cubic from X_j to X_{j+1} with slopes m_j,      r(s) + z d(s) = the mass at height z

The chord of an arc of angle φ is 1 − φ²/24 as long as the arc: so arcs through X_j are as long as the segments.
m_j is the slope at j of the polynomial whose means over the two segments on either side are those of r', fewer at
ends, where a base's tangent stands for a missing one. As r'(s) is a sum of t_k, d(s) is that sum of n_k: it turns
with the curve. At a corner the director is the corner's. A base in between divides the curve in two, since
curvatures may differ there; a single free segment is straight.

A segment is a cylinder of the chain's radius a: it has the mass m of a uniform rod, and the rotary inertia
about its axis as m a²/4 of each director.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

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
    tangents = _Curve.of(count, {} if base is None else {base: count}, frames.corner_points)
    turning = _Curve.of(
        count,
        ({} if base is None else {base: count})
        | {frames.end_point(end): count + 1 + k for k, end in enumerate(frames.corners)},
        (),
    )
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
        by_normal = turning.slope(p)
        lever = z / frames.length
        binding[i, frames.points : frames.points + count] += lever * by_normal[:count]
        for k, end in enumerate(frames.corners):
            binding[i, frames.corner_row[end]] += lever * by_normal[count + 1 + k]
        arms[i] = frames.length * by_tangent[count] * frames.axes[T] + z * by_normal[count] * frames.axes[N]
    return Binding(binding, share, arms)


@dataclass(frozen=True)
class _Curve:
    """Of r, in segments: offsets X_j − x_j, slopes m_j (joints and ends, tangents) and chords X_{j+1} − X_j
    (segments, tangents), in parts of the tangents of segments, of a base and of corners."""

    offsets: np.ndarray
    slopes: np.ndarray
    chords: np.ndarray

    @classmethod
    def of(cls, count: int, known: dict[int, int], still: Sequence[int]) -> _Curve:
        """known: the number of the tangent at joints and ends where it is known; still: others held there."""
        tangents = max([count, *(number + 1 for number in known.values())]) + 2
        unit = np.eye(tangents)
        offsets, slopes = np.zeros((2, count + 1, tangents))
        chords = np.zeros((count, tangents))
        bounds = sorted({0, count, *known})
        for first, last in zip(bounds, bounds[1:], strict=False):
            inner = range(first + 1, last)
            for j in inner:
                offsets[j] = (unit[j] - unit[j - 1]) / 24.0
            for end, beside in ((first, first + 1), (last, last - 1)):
                if end not in known and end not in still and beside in inner:
                    offsets[end] = offsets[beside]
            chords[first:last] = unit[first:last] + np.diff(offsets[first : last + 1], axis=0)
            for j in range(first, last + 1):
                slopes[j] = _slope(j, first, last, chords, {k: unit[n] for k, n in known.items()})
        return cls(offsets, slopes, chords)

    def place(self, s: float) -> tuple[int, np.ndarray]:
        """The joint or end before s, and r(s) − x there in parts of the tangents."""
        j, xi = self._segment(s)
        chord, before, after = self.chords[j], self.slopes[j], self.slopes[j + 1]
        own = xi**2 * (3.0 - 2.0 * xi) * chord
        return j, self.offsets[j] + own + xi * (1.0 - xi) ** 2 * before - xi**2 * (1.0 - xi) * after

    def slope(self, s: float) -> np.ndarray:
        """r'(s) in parts of the tangents."""
        j, xi = self._segment(s)
        own = 6.0 * xi * (1.0 - xi) * self.chords[j]
        return np.asarray(
            own + (1.0 - xi) * (1.0 - 3.0 * xi) * self.slopes[j] + xi * (3.0 * xi - 2.0) * self.slopes[j + 1]
        )

    def _segment(self, s: float) -> tuple[int, float]:
        j = min(max(int(np.floor(s + 1e-9)), 0), len(self.chords) - 1)
        return j, s - j


def _slope(joint: int, first: int, last: int, chords: np.ndarray, known: dict[int, np.ndarray]) -> np.ndarray:
    """m at a joint or end between `first` and `last`, from chords around it and known slopes."""
    if joint in known:
        return known[joint]
    around = range(max(first, joint - AROUND), min(last, joint + AROUND))
    data = [chords[k] for k in around]
    powers = np.arange(AROUND + len(data))
    at = [((k + 1.0 - joint) ** (powers + 1) - (k - joint) ** (powers + 1)) / (powers + 1) for k in around]
    for end, missing in ((first, joint - AROUND < first), (last, joint + AROUND > last)):
        if end in known and missing:
            data.append(known[end])
            at.append(np.asarray(float(end - joint) ** powers))
    moments = np.array(at)[:, : len(data)]
    weights = np.linalg.solve(moments.T, np.eye(len(data))[0])
    return np.asarray(weights @ np.array(data))


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
