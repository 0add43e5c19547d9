"""How a chain's rows carry masses of the edge and its own inertia: two constant linear maps.

Masses of the edge lie on the segment whose share of the edge holds their plan position, at a fixed place
along it, and at their height along the rod's normal: linear between the middles of segments, where it is
n_i, and beyond the outermost. (The nearest n_i alone would tilt masses at ends by half a joint's angle, an
error of first order.) A mass at a joint belongs to both neighbours, a segment without masses is bound to
nothing. Before the middle of a segment that ends at a corner which holds it, masses are at their height along
what lies between the corner's director and n_i.

A segment is a cylinder of the chain's radius a: it has the mass m of a uniform rod, and the rotary inertia
about its axis as m a²/4 of each director.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from lumped.actuators.frames import B, Frames, N
from sheetbench.scenes import Chain


def bind(frames: Frames, rows: int, along: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Binding (m, rows) of masses at arc length and height over the axis (m,) [m], and their share in each
    segment (segments, m)."""
    binding = np.zeros((len(along), rows))
    share = np.zeros((frames.segments, len(along)))
    place = along / frames.length
    for i, (p, z) in enumerate(zip(place, height, strict=True)):
        nearest = round(p)
        tie = abs(p - nearest) < 1e-9 and 0 < nearest < frames.segments
        owners = (nearest - 1, nearest) if tie else (min(max(int(p), 0), frames.segments - 1),)
        for segment in owners:
            weight = 1.0 / len(owners)
            share[segment, i] = weight
            binding[i, segment] += weight * (1.0 - (p - segment))
            binding[i, segment + 1] += weight * (p - segment)
        before = min(max(int(np.floor(p - 0.5)), 0), max(frames.segments - 2, 0))
        after = min(before + 1, frames.segments - 1)
        lever = z / frames.length
        end = 0 if p < 0.5 * frames.segments else 1
        inside = p if end == 0 else frames.segments - p  # from the nearer end, in ds
        if end in frames.corners and inside < 0.5:
            director = frames.points + frames.end_segment(end)
            binding[i, director] += lever * 2.0 * inside
            binding[i, frames.corner_row[end]] += lever * (1.0 - 2.0 * inside)
            continue
        binding[i, frames.points + before] += lever * (1.5 - (p - before))
        binding[i, frames.points + after] += lever * (p - before - 0.5)
    return binding, share


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
