"""Quadrature over the part of a cell where the depth of contact is positive, as a compiled loop.

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
def value(c: np.ndarray, t: float) -> float:
    """Return a polynomial with coefficients c (n + 1,) at t."""
    total = 0.0
    for k in range(len(c) - 1, -1, -1):
        total = total * t + c[k]
    return total


@njit
def sign_changes(c: np.ndarray) -> np.ndarray:
    """Return the points −1 and 1, and between them those at which a polynomial with coefficients c (n + 1,)
    changes sign, in rising order."""
    found, count = np.full(len(c) + 1, -1.0), 1
    if len(c) > 1:
        ends = sign_changes(c[1:] * np.arange(1, len(c)))  # one at most between two of these
        for j in range(len(ends) - 1):
            a, b, at_a = ends[j], ends[j + 1], value(c, ends[j])
            if at_a * value(c, b) < 0.0:
                for _ in range(HALVINGS):
                    x = 0.5 * (a + b)
                    if value(c, x) * at_a > 0.0:
                        a = x
                    else:
                        b = x
                found[count] = b
                count += 1
    found[count] = 1.0
    return found[: count + 1]


@inner()
def patch_points(q: np.ndarray, points: np.ndarray) -> int:
    """Write integration points (…, 3), x, y and weight, of the patch where the biquadratic of q (9,) is
    positive; return their number."""
    count, square, products = 0, q.reshape(3, 3), np.zeros(5)
    bounds = BERNSTEIN @ square @ BERNSTEIN.T
    if bounds.max() <= 0.0:
        return 0
    c = POWERS @ square @ POWERS.T  # of y^i x^j
    for i in range(3):  # where two roots meet
        for j in range(3):
            products[i + j] += c[i, 1] * c[j, 1] - 4.0 * c[i, 2] * c[j, 0]
    low, high = c[:, 0] - c[:, 1] + c[:, 2], c[:, 0] + c[:, 1] + c[:, 2]  # at the sides
    ends, across, weights = np.array([-1.0, 1.0]), ALONG, ALONG_WEIGHTS  # where it is positive all over
    if bounds.min() <= 0.0:
        ends = np.sort(np.concatenate((sign_changes(low), sign_changes(high), sign_changes(products))))
        across, weights = ACROSS, ACROSS_WEIGHTS
    for k in range(len(ends) - 1):
        half, middle = 0.5 * (ends[k + 1] - ends[k]), 0.5 * (ends[k + 1] + ends[k])
        if half <= 0.0:
            continue
        for g in range(len(across)):
            y, w = middle + half * across[g], half * weights[g]
            at = c[0] + y * (c[1] + y * c[2])
            disc, cuts = at[1] * at[1] - 4.0 * at[2] * at[0], (-1.0, 1.0, 1.0, 1.0)
            if disc > 0.0:
                root = -0.5 * (at[1] + np.copysign(np.sqrt(disc), at[1]))
                cuts = (-1.0, min(root / at[2], at[0] / root), max(root / at[2], at[0] / root), 1.0)
            for i in range(3):
                lo, hi = max(cuts[i], -1.0), min(cuts[i + 1], 1.0)
                if hi > lo and value(at, 0.5 * (lo + hi)) > 0.0:
                    for t in range(len(ALONG)):
                        points[count, 0] = 0.5 * (lo + hi) + 0.5 * (hi - lo) * ALONG[t]
                        points[count, 1] = y
                        points[count, 2] = w * 0.5 * (hi - lo) * ALONG_WEIGHTS[t]
                        count += 1
    return count


@inner()
def shape(x: float, y: float, f: np.ndarray) -> None:
    """Write the nine biquadratic shape functions at x, y into f (9,)."""
    for i, u in enumerate((0.5 * y * (y - 1.0), 1.0 - y * y, 0.5 * y * (y + 1.0))):
        f[3 * i], f[3 * i + 1], f[3 * i + 2] = (
            u * 0.5 * x * (x - 1.0),
            u * (1.0 - x * x),
            u * 0.5 * x * (x + 1.0),
        )


@njit
def integrate(
    depth: np.ndarray, stiffness: np.ndarray, power: int, tangent: bool
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return the energies ∫ ψ (m,) [J] of parts with depths d (m, n) [m], ψ = k ⟨d⟩ᵖ/p! of a power p = 2 or
    3; their derivatives ∫ ψ' φ (m, n) and ∫ ψ'' φ φᵀ (m, n, n); and the largest depths (m,). n: 9 values of a
    biquadratic, or 1 of a point with φ = 1; stiffness: k (m, n); tangent: whether to compute ∫ ψ'' φ φᵀ."""
    m, n = depth.shape
    energy, load, by = np.zeros(m), np.zeros((m, n)), np.zeros((m, n, n))
    deepest, points, f = np.empty(m), np.ones((MOST, 3)), np.ones(9)
    for e in range(m):
        q, deepest[e] = depth[e], depth[e].max()
        for g in range(patch_points(q, points) if n > 1 else int(q[0] > 0.0)):
            if n > 1:
                shape(points[g, 0], points[g, 1], f)
            d = k = 0.0
            for a in range(n):
                d += f[a] * q[a]
                k += f[a] * stiffness[e, a]
            deepest[e] = max(deepest[e], d)
            slope = k * points[g, 2] * (d if power == 3 else 1.0)
            p = slope * d / (power - 1)
            energy[e] += p * d / power
            for a in range(n):
                load[e, a] += p * f[a]
                if tangent:
                    for b in range(n):
                        by[e, a, b] += slope * f[a] * f[b]
    return energy, load, by, deepest
