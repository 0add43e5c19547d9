"""Laws of springs: energy, stress and stiffness as functions of a measure of shape.

A link's measure is g = r·r of its relative position r, a cell's the Gram matrix g = (a·a, b·b, a·b) of its
mean sides a and b. A law is an energy W(g) [J]; its stress is S = dW/dg [N/m], its stiffness D = d²W/dg²
[N/m³]. The forces follow from the measure alone: on a link's end 2 S r, on a cell's sides

    2 S₁ a + S₃ b   and   2 S₂ b + S₃ a,

and so does the tangent (`lumped.springs.links`, `lumped.springs.cells`). D is M + (D − M) with the material
part M = Σ k ∇ε ∇εᵀ of the strains ε that an energy ½ Σ k ε² is of; dampers of coefficients c in place of k
have the stress M ġ. Laws take the change δg since rest, not g alone: where it is small no digits are lost.

`half` is ½ in the precision to compute with, which a literal would decide to be double.

Laws of cells are the rows of `LAWS`, which the tests go through.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit

Three = tuple[float, float, float]
Ten = tuple[float, float, float, float, float, float, float, float, float, float]
Four = tuple[float, float, float, float]
Six = tuple[float, float, float, float, float, float]  # 11, 22, 33, 12, 13, 23 of a symmetric matrix


@njit(cache=True, error_model="numpy")
def elongation(
    half: float, change: float, square: float, rest_length: float, k: float
) -> tuple[float, float, float, float]:
    """W = ½ k (r − L)², r = √g: return W, S = ½ k (r − L)/r, M = ¼ k/g and D − M = −½ S/g."""
    length = math.sqrt(square)
    strain = change / ((length + rest_length) * length)
    stress = half * k * strain
    inverse = half / square
    return stress * strain * square, stress, half * k * inverse, -stress * inverse


@njit(cache=True, error_model="numpy")
def mean_elongation(l0: float, l1: float, e0: float, e1: float, k: float) -> float:
    """(W(g₁) − W(g₀))/(g₁ − g₀) = ½ k (e₀ + e₁)/(l₀ + l₁): the stress whose work over a step is the energy
    stored (Simo and Tarnow 1992, Gonzalez 1996)."""
    return 0.5 * k * (e0 + e1) / (l0 + l1)


@njit(cache=True, error_model="numpy")
def area_and_strains(
    half: float, d: Three, g: Three, area: float, q: Four
) -> tuple[float, float, float, Three]:
    """W = ½ q₀ (A − A₀)² + ½ (q₁ δg₁₁² + q₂ δg₂₂² + q₃ δg₁₂²), A² = det g: energy of an area spring and of
    springs against the Green strains of the sides. d: δg; g: at rest; area: A₀; q: [N/m³] (`of_stiffness`).

    Return W, t = ½ q₀ (A − A₀)/A, which is the area spring's stress over n = (g₂₂, g₁₁, −2 g₁₂), A², and S.
    """
    d1, d2, d3 = d
    turned = g[2] * d3
    change = g[1] * d1 + g[0] * d2 + d1 * d2 - (turned + turned) - d3 * d3  # of det g
    square = area * area + change
    now = math.sqrt(square)
    grown = change / (now + area)
    t = half * q[0] * grown / now
    s3 = t * (g[2] + d3)
    s1, s2, s3 = t * (g[1] + d2) + q[1] * d1, t * (g[0] + d1) + q[2] * d2, q[3] * d3 - (s3 + s3)
    energy = half * (q[0] * grown * grown + q[1] * d1 * d1 + q[2] * d2 * d2 + q[3] * d3 * d3)
    return energy, t, square, (s1, s2, s3)


@njit(cache=True, error_model="numpy")
def stiffness_of_area_and_strains(d: Three, g: Three, t: float, square: float, share: float, q: Four) -> Six:
    """M + share (D − M) of `area_and_strains`, with its t and A²:

    M = ¼ q₀ n nᵀ/A² + diag(q₁, q₂, q₃),   D − M = t (N − ½ n nᵀ/A²),   N = ∂n/∂g.
    """
    t *= share
    along = (0.25 * q[0] - 0.5 * t) / square
    n1, n2, n3 = g[1] + d[1], g[0] + d[0], -2.0 * (g[2] + d[2])
    return (
        along * n1 * n1 + q[1],
        along * n2 * n2 + q[2],
        along * n3 * n3 + q[3] - 2.0 * t,
        along * n1 * n2 + t,
        along * n1 * n3,
        along * n2 * n3,
    )


@njit(cache=True, error_model="numpy")
def mean_area_and_strains(d0: Three, d1: Three, g: Three, area: float, q: Four) -> Three:
    """The stress over a step from δg = d0 to d1 whose work is the energy stored in it: of the strains the
    mean, of the area ½ q₀ ((A₀ + A₁)/2 − A) n̄/(½ (A₀ + A₁)), n̄ the mean: A² is quadratic in g, so that the
    mean gives the difference exactly. Derived here, after Simo and Tarnow (1992)."""
    grown, sizes = 0.0, 2.0 * area
    for d in (d0, d1):
        change = g[1] * d[0] + g[0] * d[1] + d[0] * d[1] - 2.0 * g[2] * d[2] - d[2] * d[2]
        gained = change / (math.sqrt(area * area + change) + area)
        grown += gained
        sizes += gained
    t = 0.5 * q[0] * grown / sizes
    m1, m2, m3 = 0.5 * (d0[0] + d1[0]), 0.5 * (d0[1] + d1[1]), 0.5 * (d0[2] + d1[2])
    return t * (g[1] + m2) + q[1] * m1, t * (g[0] + m1) + q[2] * m2, q[3] * m3 - 2.0 * t * (g[2] + m3)


@njit(cache=True, error_model="numpy")
def less_logarithm(x: float) -> float:
    """x − ln(1 + x), no digits lost where x is small."""
    if abs(x) < 3e-3:
        return (
            x
            * x
            * (1.0 / 2.0 - x * (1.0 / 3.0 - x * (1.0 / 4.0 - x * (1.0 / 5.0 - x * (1.0 / 6.0 - x / 7.0)))))
        )
    return x - math.log1p(x)


@njit(cache=True, error_model="numpy")
def logarithm_of_thickness(growth: float, ratio: float) -> float:
    """ln t² of the thickness stretch t at which nothing pulls there, t² − 1 + ½ β (ln a² + ln t²) = 0, from
    growth, ln a² of the change of area, and β = λ/μ: Halley's method, of third order, from what small strains
    have."""
    x = -ratio / (ratio + 2.0) * growth
    for _ in range(30):
        thinning = math.expm1(x)
        second = thinning + 1.0
        slope = second + 0.5 * ratio
        value = thinning + 0.5 * ratio * (growth + x)
        step = 2.0 * value * slope / (2.0 * slope * slope - value * second)
        x -= step
        if abs(step) <= 1e-5 * abs(x):
            break
    return x


@njit(cache=True, error_model="numpy")
def neo_hookean(
    half: float, d: Four, g: Three, area: float, k: Ten
) -> tuple[float, float, float, Three, tuple[float, float], Four]:
    """W = k₄ [½ (δḡ₁₁/g₁₁ + δḡ₂₂/g₂₂ + t² − 1) − ln(a t) + ½ β ln²(a t)], β = k₅ = λ/μ: a neo-Hookean
    membrane in plane stress, k₄ = μ times its volume [J], a = A/A₀, t eliminated (`logarithm_of_thickness`),
    on cells of right angles. ḡ is the mean of g in a bilinear cell, δg + s/12 (1, 1, 0), s = q·q = d₄ of what
    its corners have beside mean sides. Less ½ k₆ (√ĝ₁₁ − L₁)² + ½ k₇ (√ĝ₂₂ − L₂)², ĝ = g + s/4 the mean of
    its sides', which links along them store unless opposite ones differ; with ½ k₈ δg₁₂², and of an upright
    face ½ k₉ δg₁₂²/(1 + δg₁₁/g₁₁), the shear of its director b against the direction of its chord a, whatever
    that is stretched. k₀ to k₃: the springs of its small strains (`area_and_strains`), whose M this law has.

    Return W since rest; t = k₄ t²/−2A² and A² of ḡ; the membrane's stress; those of the sides; S.
    """
    shifted = d[0] + d[3] / 12.0, d[1] + d[3] / 12.0
    e1, e2 = shifted[0] / g[0], shifted[1] / g[1]
    product = e1 * e2 - d[2] * d[2] / (area * area)
    change = e1 + e2 + product  # of a²
    square = area * area * (1.0 + change)
    now = g[0] + d[0]
    face = k[9] * g[0] / now
    sheared = (k[8] + face) * d[2]
    energy, t, m1, m2, p1, p2 = half * sheared * d[2], 0.0, 0.0, 0.0, 0.0, 0.0
    if k[4] != 0.0:
        growth = math.log1p(change)
        x = logarithm_of_thickness(growth, k[5])
        thinning = math.expm1(x)
        t = -half * k[4] * (1.0 + thinning) / square
        scale = half * k[4] / (1.0 + change)
        stored = less_logarithm(change) - product + less_logarithm(thinning) - half * thinning * (growth + x)
        d1, d2 = d[0] + 0.25 * d[3], d[1] + 0.25 * d[3]
        w1, p1, _, _ = elongation(half, d1, g[0] + d1, math.sqrt(g[0]), k[6])
        w2, p2, _, _ = elongation(half, d2, g[1] + d2, math.sqrt(g[1]), k[7])
        energy += half * k[4] * stored - w1 - w2
        m1 = scale / g[0] * (e1 + product - thinning * (1.0 + e2))
        m2 = scale / g[1] * (e2 + product - thinning * (1.0 + e1))
    stress = (
        m1 - p1 - half * face * d[2] * d[2] / now,
        m2 - p2,
        sheared - 2.0 * t * d[2],
        (m1 + m2) / 12.0 - 0.25 * (p1 + p2),
    )
    return energy, t, square, (m1, m2, -2.0 * t * d[2]), (p1, p2), stress


@njit(cache=True, error_model="numpy")
def stiffness_of_neo_hookean(
    d: Four, g: Three, t: float, square: float, share: float, k: Ten
) -> tuple[Six, Four]:
    """M + share (D − M) of `neo_hookean`, its 11 22 33 12 13 23 and 14 24 34 44; D with the second derivative
    of t by the implicit function:

    ¼ W″ n nᵀ/A² + t (N − ½ n nᵀ/A²),   W″ = k₄ t²/A² (1 + β/(t² + ½ β)) by the area, t² the thickness'.
    """
    shifted = d[0] + d[3] / 12.0, d[1] + d[3] / 12.0, d[2]
    now = g[0] + d[0]
    face = k[9] * g[0] / now
    curvature = c1 = c2 = 0.0
    if k[4] != 0.0:
        thickness = -2.0 * t * square / k[4]
        curvature = k[4] * thickness / square * (1.0 + k[5] / (thickness + 0.5 * k[5]))
        d1, d2 = d[0] + 0.25 * d[3], d[1] + 0.25 * d[3]
        _, _, m1, r1 = elongation(0.5, d1, g[0] + d1, math.sqrt(g[0]), k[6])
        _, _, m2, r2 = elongation(0.5, d2, g[1] + d2, math.sqrt(g[1]), k[7])
        c1, c2 = m1 + r1, m2 + r2
    o = stiffness_of_area_and_strains(shifted, g, t, square, 1.0, (curvature, 0.0, 0.0, 0.0))
    m = stiffness_of_area_and_strains(
        (d[0], d[1], d[2]), g, 0.0, (now * (g[1] + d[1]) - d[2] * d[2]), 0.0, (k[0], k[1], k[2], k[3])
    )
    turn = d[2] / now
    return (
        m[0] + share * (o[0] - c1 + face * turn * turn - m[0]),
        m[1] + share * (o[1] - c2 - m[1]),
        m[2] + share * (o[2] + k[8] + face - m[2]),
        m[3] + share * (o[3] - m[3]),
        m[4] + share * (o[4] - face * turn - m[4]),
        m[5] + share * (o[5] - m[5]),
    ), (
        share * ((o[0] + o[3]) / 12.0 - 0.25 * c1),
        share * ((o[1] + o[3]) / 12.0 - 0.25 * c2),
        share * (o[4] + o[5]) / 12.0,
        share * ((o[0] + 2.0 * o[3] + o[1]) / 144.0 - 0.0625 * (c1 + c2)),
    )


@njit(cache=True, error_model="numpy")
def mean_neo_hookean(d0: Four, d1: Four, g: Three, area: float, k: Ten) -> Four:
    """The stress over a step whose work is the energy stored: that in its middle, and along the step what is
    left of the energy (Gonzalez 1996)."""
    middle = 0.5 * (d0[0] + d1[0]), 0.5 * (d0[1] + d1[1]), 0.5 * (d0[2] + d1[2]), 0.5 * (d0[3] + d1[3])
    s = neo_hookean(0.5, middle, g, area, k)[-1]
    m1, m2, m3, m4 = d1[0] - d0[0], d1[1] - d0[1], d1[2] - d0[2], d1[3] - d0[3]
    length = m1 * m1 + m2 * m2 + m3 * m3 + m4 * m4
    if length <= 1e-12 * area * area:  # what is left is rounding
        return s
    stored = neo_hookean(0.5, d1, g, area, k)[0] - neo_hookean(0.5, d0, g, area, k)[0]
    left = (stored - s[0] * m1 - s[1] * m2 - s[2] * m3 - s[3] * m4) / length
    return s[0] + left * m1, s[1] + left * m2, s[2] + left * m3, s[3] + left * m4


@dataclass(frozen=True)
class Law:
    """A law of cells: energy and stress (first and last of what it returns), stiffness, the stress whose work
    over a step is the energy stored, how many measures, and constants of a cell of 1 × 1 m to test it by."""

    respond: Callable[..., Any]
    stiffness: Callable[..., Any]
    mean_stress: Callable[..., Any]
    measures: int
    example: tuple[float, ...]


LAWS = (
    Law(
        area_and_strains, stiffness_of_area_and_strains, mean_area_and_strains, 3, (-30.0, 200.0, 150.0, 80.0)
    ),
    Law(
        neo_hookean,
        stiffness_of_neo_hookean,
        mean_neo_hookean,
        4,
        (164.0, 132.0, 140.0, 87.0, 100.0, 9.0, 68.0, 60.0, -13.0, 25.0),
    ),
)


def of_stiffness(k: np.ndarray, sides: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Constants q (c, 4) [N/m³] of springs of stiffness k (c, 4) [N/m] against the change of area A/A₀ − 1
    and the Green strains δg₁₁/2g₁₁, δg₂₂/2g₂₂, δg₁₂/√(g₁₁ g₂₂), each with the energy ½ k ε² A₀; of cells with
    sides (c, 2, 3) [m] and area (c,) [m²] at rest."""
    aa, bb = (sides**2).sum(axis=2).T
    per_strain = np.stack([1.0 / area**2, 0.25 / aa**2, 0.25 / bb**2, 1.0 / (aa * bb)], axis=1)
    constants: np.ndarray = k * area[:, None] * per_strain
    return constants
