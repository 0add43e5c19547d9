"""The vector a = −(v·d) d/|d|² that makes v + a normal to d, with its derivatives, of vectors (…, 3) each.

The derivatives are written in n = d/|d|² and J = ∂n/∂d: a = −(v·d) n = −(v·n) d.
"""

import numpy as np

EYE = np.eye(3)


def outer(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a ⊗ b (…, k, l) of vectors (…, k) and (…, l)."""
    return np.asarray(a[..., :, None] * b[..., None, :])


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Return a·b (…, 1, 1) of vectors (…, 3)."""
    return np.asarray((a * b).sum(-1)[..., None, None])


def correction(v: np.ndarray, d: np.ndarray) -> np.ndarray:
    """Return a (…, 3)."""
    return np.asarray(-(dot(v, d) / dot(d, d))[..., 0] * d)


def first(v: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return ∂a/∂v and ∂a/∂d (…, 3, 3)."""
    n = d / dot(d, d)[..., 0]
    return -outer(d, n), -outer(n, v) - dot(v, n) * (EYE - 2.0 * outer(d, n))


def second(v: np.ndarray, d: np.ndarray, f: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return Σ f·∂²a/∂v∂d and Σ f·∂²a/∂d² (…, 3, 3), of f on a."""
    n = d / dot(d, d)[..., 0]
    turned = (f - 2.0 * dot(f, n)[..., 0] * d) / dot(d, d)[..., 0]  # J f
    half = 2.0 * dot(v, n) * outer(f, n) - outer(v, turned)
    both = half + half.swapaxes(-1, -2) + 2.0 * dot(v, n) * dot(f, n) * (EYE - 4.0 * outer(n, d))
    return -dot(f, n) * EYE - outer(d, turned), both
