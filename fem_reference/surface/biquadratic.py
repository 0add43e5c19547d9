"""Nine-node elements: biquadratic shape functions, Gauss points, and the tying points of MITC9.

Coordinates r, s run from −1 to 1; nodes are in the order of scikit-fem's `ElementQuad2`: corners, mid-sides,
centre. The sides have quadratic shape functions of one coordinate: corner, mid-side, corner.

Covariant strains of a biquadratic element are sampled at `TYING` and interpolated from there, so that a thin
element does not lock (Bucalem & Bathe, Int. J. Numer. Meth. Engng 36 (1993) 3729–3754).
"""

from collections.abc import Sequence

import numpy as np
from skfem import ElementQuad2

from sheetbench.errors import NoMesh

NODES = 9
TWO = np.array([-1.0, 1.0]) / np.sqrt(3.0)
THREE = np.array([-1.0, 0.0, 1.0]) * np.sqrt(0.6)
THREE_WEIGHTS = np.array([5.0, 8.0, 5.0]) / 9.0
SIDE_MASS = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) / 15.0  # ∫ N N dξ
# Along r and s, the points between which a covariant strain is interpolated; rs is sampled at 3 × 3 first.
TYING = {"rr": (TWO, THREE), "ss": (THREE, TWO), "rs": (TWO, TWO)}
# Axes of a tensor's components.
IN_PLANE = ((0, 0), (1, 1), (0, 1))
IN_SPACE = ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))


def shape(r: np.ndarray, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return values (n, 9) and derivatives (2, n, 9) by r, s of the shape functions at points of [−1, 1]²."""
    element = ElementQuad2()
    at = (np.array([r, s], dtype=float) + 1.0) / 2.0
    value, slope = zip(*(element.lbasis(at, i) for i in range(NODES)), strict=True)
    return np.array(value).T, np.array(slope).transpose(1, 2, 0) / 2.0


def side_shape(xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return values and derivatives (n, 3) of the shape functions of a side at points (n,) of [−1, 1]."""
    value = np.array([xi * (xi - 1.0) / 2.0, 1.0 - xi**2, xi * (xi + 1.0) / 2.0])
    return value.T, np.array([xi - 0.5, -2.0 * xi, xi + 0.5]).T


def lagrange(nodes: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the Lagrange polynomials (n, m) of `nodes` (m,) at points (n,)."""
    others = [np.delete(nodes, i) for i in range(len(nodes))]
    pairs = zip(nodes, others, strict=True)
    return np.array([np.prod((at[:, None] - o) / (x - o), axis=1) for x, o in pairs]).T


def product_grid(r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """Return the points r × s, (2, n); s runs fastest."""
    return np.array([np.repeat(r, len(s)), np.tile(s, len(r))])


def interpolation(r: np.ndarray, s: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the interpolation matrix (n, len(r) · len(s)) from the points r × s to points `at` (2, n)."""
    return np.einsum("na,nb->nab", lagrange(r, at[0]), lagrange(s, at[1])).reshape(at.shape[1], -1)


GAUSS = product_grid(THREE, THREE)
GAUSS_WEIGHTS = np.outer(THREE_WEIGHTS, THREE_WEIGHTS).ravel()
AT_GAUSS = shape(*GAUSS)


def jacobians(nodes: np.ndarray, slope: np.ndarray) -> np.ndarray:
    """Return ∂x_b/∂ξ_a (m, n, b, a) [m] of nodes at (m, 9, 2) [m]; slope: (2, n, 9) of `shape`."""
    return np.einsum("agi,eib->egba", slope, nodes)


def require_upright(area: np.ndarray) -> None:
    """Raise NoMesh for an element whose det J (m, n) changes sign; below zero r, s turn clockwise."""
    share = area * np.sign(area[:, :1])
    if not np.all(share > 0.0):
        worst = int(np.argmin(share.min(axis=1)))
        raise NoMesh(f"element {worst} of the mesh is inverted or degenerate")


def pulled_back(inverse: np.ndarray, pairs: Sequence[tuple[int, int]]) -> np.ndarray:
    """Return the matrix from covariant to Cartesian strain, both with engineering shears, components by
    pairs. inverse: ξ_b,x_c (…, b, c)."""
    out = np.zeros((*inverse.shape[:-2], len(pairs), len(pairs)), inverse.dtype)
    for row, (i, j) in enumerate(pairs):
        for column, (a, b) in enumerate(pairs):
            product = inverse[..., a, i] * inverse[..., b, j] + inverse[..., b, i] * inverse[..., a, j]
            out[..., row, column] = product * (0.5 if i == j else 1.0)
    return out


def integrated(
    operator: np.ndarray, moduli: np.ndarray, areas: np.ndarray, right: np.ndarray | None = None
) -> np.ndarray:
    """Return ∫ Lᵀ C R dA (m, k, k) of L, R (m, q, a, k), R = L by default; C: (a, a) or (m, q, a, a)."""
    m, q, a, k = operator.shape
    weighed = (moduli @ (operator if right is None else right)) * areas[:, :, None, None]
    flat = operator.reshape(m, q * a, k).swapaxes(1, 2)
    return np.asarray(flat @ weighed.reshape(m, q * a, -1))


def areas(nodes: np.ndarray) -> np.ndarray:
    """Return w |det J| (m, 9) [m²] at the Gauss points of elements with nodes at (m, 9, 2) [m]."""
    along, across = np.moveaxis(jacobians(nodes, AT_GAUSS[1]), -1, 0)  # ∂x/∂ξ, ∂x/∂η
    return GAUSS_WEIGHTS * np.abs(along[..., 0] * across[..., 1] - along[..., 1] * across[..., 0])
