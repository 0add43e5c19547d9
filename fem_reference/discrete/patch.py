"""Integrals over the part of a square where a biquadratic polynomial is positive, for all squares at once.

A biquadratic q on [−1, 1]² has nine values at −1, 0, 1 along r and s (s fastest). At a given r it is a
parabola in s, positive between or outside its roots: Gauss points there are exact. The inner integral is a
function of r, smooth between the real parts of the roots of three polynomials: of q along the two sides s =
±1, and of the parabola's discriminant, near which it behaves as a square root that the substitution r(t) = ½
(3t − t³) removes.
"""

import numpy as np

from fem_reference.surface.triad import outer

# coefficients of a parabola by its values
LINE = np.array([[0.0, 1.0, 0.0], [-0.5, 0.0, 0.5], [0.5, -1.0, 0.5]])
BERNSTEIN = np.array([[1.0, 0.0, 0.0], [-0.5, 2.0, -0.5], [0.0, 0.0, 1.0]])
SUMS = np.eye(5)[np.add.outer(range(3), range(3)).ravel()]  # of products of coefficients, (9, 5)
INNER, INNER_WEIGHTS = np.polynomial.legendre.leggauss(4)
_T, _W = np.polynomial.legendre.leggauss(14)
OUTER, OUTER_WEIGHTS = 0.5 * (3.0 * _T - _T**3), 1.5 * (1.0 - _T**2) * _W
LEAST_COEFFICIENT = 1e-13  # least leading coefficient, relative to the largest: it adds a root far away
FULL = 1e-12  # least value of a square that is positive all over, relative to the largest


def roots(c: np.ndarray) -> np.ndarray:
    """Return the real parts (e, n) of the roots of polynomials with coefficients c (e, n + 1), clipped to
    [−1, 1]. Coefficients are in ascending order."""
    n = c.shape[1] - 1
    least = LEAST_COEFFICIENT * np.abs(c).max(axis=1) + 1e-300
    leading = np.where(np.abs(c[:, -1]) < least, least, c[:, -1])
    companion = np.zeros((len(c), n, n))
    companion[:, range(1, n), range(n - 1)] = 1.0
    companion[:, :, -1] = -c[:, :-1] / leading[:, None]
    return np.asarray(np.clip(np.linalg.eigvals(companion).real, -1.0, 1.0))


def basis(r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the weights (…, 9) of the nine values in the value at r, s (…)."""
    powers = (np.stack([np.ones_like(x), x, x * x], axis=-1) @ LINE for x in (r, s))
    return np.einsum("...a,...b->...ab", *powers).reshape(*np.shape(r), 9)


def points(q: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return r, s and weights (e, k) of integration points of the patches {q > 0} of values q (e, 9)."""
    c = LINE @ q.reshape(-1, 3, 3) @ LINE.T
    sides = [roots(c[:, :, 0] + sign * c[:, :, 1] + c[:, :, 2]) for sign in (-1.0, 1.0)]
    products = outer(c[..., 1], c[..., 1]) - 4.0 * outer(c[..., 2], c[..., 0])
    discriminant, ends = products.reshape(-1, 9) @ SUMS, np.ones((len(q), 1))
    stops = np.sort(np.hstack([-ends, *sides, roots(discriminant), ends]), axis=1)
    middle, half = 0.5 * (stops[:, 1:] + stops[:, :-1]), 0.5 * (stops[:, 1:] - stops[:, :-1])
    r = (middle[..., None] + half[..., None] * OUTER).reshape(len(q), -1)
    weight = (half[..., None] * OUTER_WEIGHTS).reshape(len(q), -1)
    z, y, x = np.moveaxis(np.stack([np.ones_like(r), r, r * r], axis=-1) @ c, -1, 0)  # x s² + y s + z
    root = np.sqrt(np.maximum(y * y - 4.0 * x * z, 0.0))
    t = -0.5 * (y + np.copysign(root, y))
    with np.errstate(divide="ignore", invalid="ignore"):
        pair = np.nan_to_num(np.stack([t / x, z / t]), nan=1.0)
    below, above = np.sort(np.clip(pair, -1.0, 1.0), axis=0)
    low, high = np.stack([0.0 * r - 1.0, below, above]), np.stack([below, above, 0.0 * r + 1.0])
    at = 0.5 * (low + high)  # of one sign up to both ends, also where there is no root
    inside = x * at * at + y * at + z > 0.0
    width = 0.5 * (high - low) * inside * weight
    s = at[..., None] + 0.5 * (high - low)[..., None] * INNER
    r, width = np.broadcast_to(r[..., None], s.shape), width[..., None] * INNER_WEIGHTS
    return tuple(np.moveaxis(values, 0, 1).reshape(len(q), -1) for values in (r, s, width))  # type: ignore[return-value]


def integrals(q: np.ndarray, k: np.ndarray, power: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ∫ k ⟨q⟩ᵖ/p! (…) of values q, k (…, 9) and p = 2 or 3, and its first (…, 9) and second (…, 9, 9)
    derivatives by q."""
    out = np.zeros(q.shape[:-1]), np.zeros(q.shape), np.zeros((*q.shape, 9))
    bounds = q @ np.kron(BERNSTEIN, BERNSTEIN).T
    full, touched = bounds.min(axis=-1) > FULL * bounds.max(axis=-1), bounds.max(axis=-1) > 0.0
    r, s = (axis.reshape(1, -1) for axis in np.meshgrid(INNER, INNER, indexing="ij"))
    uniform = r, s, np.outer(INNER_WEIGHTS, INNER_WEIGHTS).reshape(1, -1)
    for rows, within in ((touched & full, True), (touched & ~full, False)):
        if rows.any():
            at_r, at_s, weight = uniform if within else points(q[rows])
            share = np.broadcast_to(basis(at_r, at_s), (rows.sum(), at_r.shape[1], 9))
            d = np.maximum((share @ q[rows][..., None])[..., 0], 0.0)
            weight = weight * (share @ k[rows][..., None])[..., 0]
            first = weight * d ** (power - 1) / (power - 1)
            out[0][rows] = (first * d).sum(axis=1) / power
            out[1][rows] = (first[:, None] @ share)[:, 0]
            out[2][rows] = share.swapaxes(1, 2) @ ((weight * d ** (power - 2))[..., None] * share)
    return out
