"""Laws of springs: energy, stress and stiffness as functions of a measure of shape.

A link's measure is g = r·r of its relative position r, a cell's the Gram matrix g = (a·a, b·b, a·b) of its
mean sides a and b. A law is an energy W(g) [J]; its stress is S = dW/dg [N/m], its stiffness D = d²W/dg²
[N/m³]. The forces follow from the measure alone: on a link's end 2 S r, on a cell's sides

    2 S₁ a + S₃ b   and   2 S₂ b + S₃ a,

and so does the tangent (`lumped.springs.links`, `lumped.springs.cells`). D is M + (D − M) with the material
part M = Σ k ∇ε ∇εᵀ of the strains ε that an energy ½ Σ k ε² is of; dampers of coefficients c in place of k
have the stress M ġ. Laws take the change δg since rest, not g alone: where it is small no digits are lost.

`half` is ½ in the precision to compute with, which a literal would decide to be double.

Laws of cells take and return one measure more, s = q·q of what the corners have beside mean sides
(`lumped.springs.cells`); they are the rows of `lumped.springs.cell_laws.LAWS`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

Three = tuple[float, float, float]
Four = tuple[float, float, float, float]
Constants = tuple[float, ...]
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
    half: float, d: Four, g: Three, area: float, q: Constants
) -> tuple[float, tuple[float, float], Four]:
    """W = ½ q₀ (A − A₀)² + ½ (q₁ δg₁₁² + q₂ δg₂₂² + q₃ δg₁₂²), A² = det g: energy of an area spring and of
    springs against the Green strains of the sides. d: δg; g: at rest; area: A₀; q: [N/m³] (`of_stiffness`).

    Return W; t = ½ q₀ (A − A₀)/A, which is the area spring's stress over n = (g₂₂, g₁₁, −2 g₁₂), and A²; S.
    """
    d1, d2, d3 = d[0], d[1], d[2]
    turned = g[2] * d3
    change = g[1] * d1 + g[0] * d2 + d1 * d2 - (turned + turned) - d3 * d3  # of det g
    square = area * area + change
    now = math.sqrt(square)
    grown = change / (now + area)
    t = half * q[0] * grown / now
    s3 = t * (g[2] + d3)
    s1, s2, s3 = t * (g[1] + d2) + q[1] * d1, t * (g[0] + d1) + q[2] * d2, q[3] * d3 - (s3 + s3)
    energy = half * (q[0] * grown * grown + q[1] * d1 * d1 + q[2] * d2 * d2 + q[3] * d3 * d3)
    return energy, (t, square), (s1, s2, s3, half - half)


@njit(cache=True, error_model="numpy")
def stiffness_of_area_and_strains(
    d: Four, g: Three, area: float, memory: tuple[float, float], share: float, q: Constants
) -> tuple[Six, Four]:
    """M + share (D − M) of `area_and_strains`, with its t and A²; none of s:

    M = ¼ q₀ n nᵀ/A² + diag(q₁, q₂, q₃),   D − M = t (N − ½ n nᵀ/A²),   N = ∂n/∂g.
    """
    t, square = share * memory[0], memory[1]
    along = (0.25 * q[0] - 0.5 * t) / square
    n1, n2, n3 = g[1] + d[1], g[0] + d[0], -2.0 * (g[2] + d[2])
    return (
        along * n1 * n1 + q[1],
        along * n2 * n2 + q[2],
        along * n3 * n3 + q[3] - 2.0 * t,
        along * n1 * n2 + t,
        along * n1 * n3,
        along * n2 * n3,
    ), (0.0, 0.0, 0.0, 0.0)


@njit(cache=True, error_model="numpy")
def mean_area_and_strains(d0: Four, d1: Four, g: Three, area: float, q: Constants) -> Four:
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
    return t * (g[1] + m2) + q[1] * m1, t * (g[0] + m1) + q[2] * m2, q[3] * m3 - 2.0 * t * (g[2] + m3), 0.0


def of_stiffness(k: np.ndarray, sides: np.ndarray, area: np.ndarray) -> np.ndarray:
    """Constants q (c, 4) [N/m³] of springs of stiffness k (c, 4) [N/m] against the change of area A/A₀ − 1
    and the Green strains δg₁₁/2g₁₁, δg₂₂/2g₂₂, δg₁₂/√(g₁₁ g₂₂), each with the energy ½ k ε² A₀; of cells with
    sides (c, 2, 3) [m] and area (c,) [m²] at rest."""
    aa, bb = (sides**2).sum(axis=2).T
    per_strain = np.stack([1.0 / area**2, 0.25 / aa**2, 0.25 / bb**2, 1.0 / (aa * bb)], axis=1)
    constants: np.ndarray = k * area[:, None] * per_strain
    return constants
