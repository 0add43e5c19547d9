"""The law of upright faces: the shear of their director b against the direction of their chord a,

    W = ½ k₄ δg₁₂²/(1 + δg₁₁/g₁₁),

whatever the chord is stretched. k₀ to k₃: the springs of its small strains (`lumped.springs.laws`) [N/m³].
"""

from __future__ import annotations

from numba import njit

from lumped.springs.laws import Constants, Four, Six, Three


@njit(cache=True, error_model="numpy")
def face(half: float, d: Four, g: Three, area: float, k: Constants) -> tuple[float, float, Four]:
    """Return W, its stiffness against δg₁₂, and S."""
    now, none = g[0] + d[0], half - half
    stiff = k[4] * g[0] / now
    pull = stiff * d[2]
    energy = half * pull * d[2]
    return energy, stiff, (-energy / now, none, pull, none)


@njit(cache=True, error_model="numpy")
def stiffness_of_face(
    d: Four, g: Three, area: float, stiff: float, share: float, k: Constants
) -> tuple[Six, Four]:
    """Return M + share (D − M) of `face`, its 11 22 33 12 13 23; nothing of s."""
    turn, part = d[2] / (g[0] + d[0]), share * stiff
    shear = k[3] + share * (stiff - k[3])
    return (part * turn * turn, 0.0, shear, 0.0, -part * turn, 0.0), (0.0, 0.0, 0.0, 0.0)


@njit(cache=True, error_model="numpy")
def mean_face(d0: Four, d1: Four, g: Three, area: float, k: Constants) -> Four:
    """Return the stress over a step whose work is the energy stored: of products the mean of one factor
    times the change of the other."""
    y0, y1, quarter = g[0] + d0[0], g[0] + d1[0], 0.25 * k[4] * g[0]
    across = quarter * (d0[2] + d1[2]) * (1.0 / y0 + 1.0 / y1)
    return -quarter * (d0[2] * d0[2] + d1[2] * d1[2]) / (y0 * y1), 0.0, across, 0.0
