"""Quadrature over the part of a cell where a depth is positive, as a compiled loop.

A depth q is biquadratic on [−1, 1]², with nine values at −1, 0, 1 along x and y (x fastest). Along x, at each
y, it is a parabola whose roots end the patch {q > 0}; the integrand between the roots is a polynomial, exact
by Gauss points. The integral over y is smooth between the values of y where a root passes a side of the cell
or two roots meet: there it has the square root of the distance, which y(t) = ½ (3t − t³) makes regular. Since
the depth vanishes at the patch's border, ∫ ⟨q⟩² has the derivatives 2 ∫ q φ and 2 ∫ φ φᵀ over the patch, with
the points of ∫ ⟨q⟩².
"""

from __future__ import annotations

import numpy as np

from sheetbench.numerics.options import inner, njit

ALONG, ALONG_WEIGHTS = np.polynomial.legendre.leggauss(4)
_T, _W = np.polynomial.legendre.leggauss(16)
ACROSS, ACROSS_WEIGHTS = 0.5 * (3.0 * _T - _T**3), 1.5 * (1.0 - _T**2) * _W
MOST = 2 * 16 * 4 * 9  # points of a patch
HALVINGS = 52
# of a parabola by values at −1, 0, 1
POWERS = np.array([[0.0, 1.0, 0.0], [-0.5, 0.0, 0.5], [0.5, -1.0, 0.5]])
BERNSTEIN = np.array([[1.0, 0.0, 0.0], [-0.5, 2.0, -0.5], [0.0, 0.0, 1.0]])


@inner()
def value(c: np.ndarray, n: int, t: float) -> float:
    """Return a polynomial of degree n with coefficients c (n + 1,) at t."""
    total = 0.0
    for k in range(n, -1, -1):
        total = total * t + c[k]
    return total


@inner()
def add_roots(c: np.ndarray, n: int, out: np.ndarray, count: int) -> int:
    """Append to the first `count` of `out` the places in (−1, 1) where a polynomial of degree n <= 4 changes
    its sign; return the new count."""
    ends, of = np.full(7, -1.0), np.zeros((5, 5))  # roots of the derivative of one degree less; derivatives
    ends[1], inside = 1.0, 0
    of[n] = c
    for degree in range(n - 1, 0, -1):
        for k in range(degree + 1):
            of[degree, k] = (k + 1) * of[degree + 1, k + 1]
    for degree in range(1, n + 1):
        found, new = 0, np.full(7, -1.0)
        for j in range(inside + 1):
            a, b = ends[j], ends[j + 1]
            at_a = value(of[degree], degree, a)
            if at_a * value(of[degree], degree, b) < 0.0:
                for _ in range(HALVINGS):
                    x = 0.5 * (a + b)
                    if value(of[degree], degree, x) * at_a > 0.0:
                        a = x
                    else:
                        b = x
                found += 1
                new[found] = b
        new[found + 1], inside = 1.0, found
        ends[:] = new
    for j in range(inside):
        out[count + j] = ends[j + 1]
    return count + inside


@inner()
def transform(by: np.ndarray, q: np.ndarray, c: np.ndarray) -> None:
    """Set c (3, 3), of y^i x^j or of Bernstein's polynomials, from values (9,)."""
    c[:] = 0.0
    for i in range(3):
        for j in range(3):
            for k in range(9):
                c[i, j] += by[i, k // 3] * by[j, k % 3] * q[k]


@inner()
def add_line(y: float, weight: float, lo: float, hi: float, points: np.ndarray, count: int) -> int:
    """Append Gauss points between lo and hi at a y to the first `count` of `points` (…, 3), x, y, weight;
    return the new count."""
    for g in range(len(ALONG)):
        points[count + g, 0] = 0.5 * (lo + hi) + 0.5 * (hi - lo) * ALONG[g]
        points[count + g, 1] = y
        points[count + g, 2] = weight * 0.5 * (hi - lo) * ALONG_WEIGHTS[g]
    return count + len(ALONG)


@inner()
def patch(q: np.ndarray, points: np.ndarray) -> int:
    """Set points (…, 3), x, y and weight, of the patch where the biquadratic of q (9,) is positive: how
    many."""
    count, c, ends, p, cuts = 0, np.empty((3, 3)), np.empty(12), np.zeros(5), np.full(4, -1.0)
    transform(BERNSTEIN, q, c)
    if c.max() <= 0.0:
        return 0
    if c.min() > 0.0:
        for g in range(len(ALONG)):
            count = add_line(ALONG[g], ALONG_WEIGHTS[g], -1.0, 1.0, points, count)
        return count
    transform(POWERS, q, c)
    ends[0] = -1.0
    stops = 1
    for s in (-1.0, 1.0):  # at the sides
        for i in range(3):
            p[i] = c[i, 0] + s * c[i, 1] + c[i, 2]
        stops = add_roots(p, 2, ends, stops)
    p[:] = 0.0
    for i in range(3):  # where two roots meet
        for j in range(3):
            p[i + j] += c[i, 1] * c[j, 1] - 4.0 * c[i, 2] * c[j, 0]
    stops = add_roots(p, 4, ends, stops)
    ends[stops] = 1.0
    ends[1:stops].sort()
    for k in range(stops):
        half, middle = 0.5 * (ends[k + 1] - ends[k]), 0.5 * (ends[k + 1] + ends[k])
        if half <= 0.0:
            continue
        for g in range(len(ACROSS)):
            y, w = middle + half * ACROSS[g], half * ACROSS_WEIGHTS[g]
            at = c[0] + y * (c[1] + y * c[2])
            disc = at[1] * at[1] - 4.0 * at[2] * at[0]
            cuts[1:] = 1.0
            if disc > 0.0:
                t = -0.5 * (at[1] + np.copysign(np.sqrt(disc), at[1]))
                cuts[1], cuts[2] = min(t / at[2], at[0] / t), max(t / at[2], at[0] / t)
            for i in range(3):
                lo, hi = max(cuts[i], -1.0), min(cuts[i + 1], 1.0)
                if hi > lo and value(at, 2, 0.5 * (lo + hi)) > 0.0:
                    count = add_line(y, w, lo, hi, points, count)
    return count


@inner()
def shape(x: float, y: float, f: np.ndarray) -> None:
    """Set the nine shape functions f (9,)."""
    a, b, d = 0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)
    for i in range(3):
        u = 0.5 * y * (y - 1.0) if i == 0 else 1.0 - y * y if i == 1 else 0.5 * y * (y + 1.0)
        f[3 * i], f[3 * i + 1], f[3 * i + 2] = u * a, u * b, u * d


@njit
def integrate(
    depth: np.ndarray, stiffness: np.ndarray, over: np.ndarray, tangent: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return energies ∫ ψ (m,) [J], loads ∫ ψ' φ (m, n) [N] and ∫ ψ'' φ φᵀ (m, n, n) [N/m] of depths (m, n)
    [m], n = 9 of a patch or 1 of a point with φ = 1, and the deepest (m,); stiffness: k (m, n) [N/m]; over: δ
    (m,) [m], 0 for ψ = ½ k d²; tangent: whether to compute ∫ ψ'' φ φᵀ."""
    m, n = depth.shape
    energy, load, by = np.zeros(m), np.zeros((m, n)), np.zeros((m, n, n))
    deepest = np.empty(m)
    points, f, q = np.ones((MOST, 3)), np.ones(9), np.empty(9)
    for e in range(m):
        deepest[e] = depth[e].max()
        for turn in range(2 if over[e] > 0.0 else 1):  # ψ = k (⟨d⟩³ − ⟨d − δ⟩³)/6δ, or k ⟨d⟩²/2
            for a in range(n):
                q[a] = depth[e, a] - turn * over[e]
            for g in range(patch(q, points) if n > 1 else int(q[0] > 0.0)):
                if n > 1:
                    shape(points[g, 0], points[g, 1], f)
                d = k = 0.0
                for a in range(n):
                    d += f[a] * q[a]
                    k += f[a] * stiffness[e, a]
                deepest[e] = max(deepest[e], d + turn * over[e])
                k *= points[g, 2]
                if over[e] > 0.0:
                    k *= (1.0 - 2.0 * turn) / over[e]
                    psi, p, slope = k * d * d * d / 6.0, 0.5 * k * d * d, k * d
                else:
                    psi, p, slope = 0.5 * k * d * d, k * d, k
                energy[e] += psi
                for a in range(n):
                    load[e, a] += p * f[a]
                    if tangent:
                        for b in range(n):
                            by[e, a, b] += slope * f[a] * f[b]
    return energy, load, by, deepest
