"""The mid-surface of nine-node elements without kinks between them: tangents across the nodes' directors.

At a node i a biquadratic φ has the slopes φ,k along r and s, which differ from its neighbours' slopes where
a line of nodes bears a force. Without the slopes' part along the director,

    P = φ + Σ_ik σ(r − r_i) L(s) a_ik …,   a_ik = −(φ,k·d_i) d_i/|d_i|²,
    σ(x) = x − 3/2 x|x| up to |x| = ½,  sgn(x) ½ (1 − |x|)² up to 1,

with the quadratic shape functions L across: all elements at a node have its tangent plane. σ, of slope 1 at
0, is made of parabolas that join without a kink, so that P is biquadratic on each of 4 × 4 parts.
"""

import numpy as np
from skfem import ElementQuad2, MeshQuad

from fem_reference.surface.biquadratic import lagrange, shape
from fem_reference.surface.location import locate
from fem_reference.surface.triad import outer

NODES = 2.0 * ElementQuad2().doflocs - 1.0  # (9, 2)
SLOPES = shape(*NODES.T)[1]  # (2, 9, 9), of φ by r, s at nodes
LINEAR = np.zeros((2, 9, 2, 18))  # φ,k and d at each node by φ and d of all
LINEAR[:, :, 0, :9] = SLOPES
LINEAR[:, range(9), 1, range(9, 18)] = 1.0
EYE = np.eye(3)


def shares(r: np.ndarray, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the weights at points r, s (p,) of [−1, 1]: (p, 18) of the corrections a along r, then s, and
    (p, 9) of the nodes, linear between them."""
    away = np.stack([r, s])[..., None] - NODES.T[:, None]
    far = np.abs(away)
    hats, ends = np.maximum(1.0 - far, 0.0), np.array([-1.0, 0.0, 1.0])
    turn = np.where(far < 0.5, away * (1.0 - 1.5 * far), 0.5 * np.sign(away) * hats**2)
    along, across = (
        lagrange(ends, x)[:, (y + 1.0).astype(int)] for x, y in zip((r, s), NODES.T, strict=True)
    )
    return np.hstack([turn[0] * across, along * turn[1]]), hats[0] * hats[1]


def _at_nodes(vectors: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return v = φ,k, d and n = d/|d|² (m, 2, 9, 3), and d·d (m, 2, 9, 1), of vectors (m, 18, 3)."""
    v, d = np.einsum("kivj,ejc->vekic", LINEAR, vectors, optimize=True)
    square = (d * d).sum(-1, keepdims=True)
    return v, d, d / square, square


def corrections(vectors: np.ndarray) -> np.ndarray:
    """Return the corrections a (m, 18, 3) of the nodes' tangents, along r, then s."""
    v, d, n, _ = _at_nodes(vectors)
    return np.asarray(-(v * d).sum(-1, keepdims=True) * n).reshape(-1, 18, 3)


def first(vectors: np.ndarray) -> np.ndarray:
    """Return derivatives (m, 18, 3, 18, 3) of a by the vectors."""
    v, d, n, _ = _at_nodes(vectors)
    along = (v * n).sum(-1)[..., None, None]
    by = np.stack([-outer(d, n), along * (2.0 * outer(d, n) - EYE) - outer(n, v)])
    return np.einsum("vekicd,kivj->ekicjd", by, LINEAR, optimize=True).reshape(-1, 18, 3, 18, 3)


def change_at(mesh: MeshQuad, vectors: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the elements (p,) at plan points (p, 2), the change P − φ (p, 3) of the surface there, and the
    change's derivatives (p, 3, 18, 3) by the elements' vectors. Raises BadInput off the mesh."""
    on, place = locate(mesh, points)
    share, _ = shares(*place)
    by = np.einsum("pn,pnijc->pijc", share, first(vectors[on]))
    return on, np.einsum("pn,pni->pi", share, corrections(vectors[on])), by


def second(vectors: np.ndarray, pull: np.ndarray) -> np.ndarray:
    """Return Σ f·∂²a (m, 18, 3, 18, 3) by the vectors, of f on a (m, 18, 3): of −(v·d)(f·d)/d·d."""
    v, d, n, square = _at_nodes(vectors)
    f = pull.reshape(d.shape)
    along, pulled = ((of * d).sum(-1, keepdims=True) for of in (v, f))
    half, dyad = 2.0 * outer(along * f + pulled * v, n) - outer(v, f), outer(n, n)
    along, pulled, square = along[..., None], pulled[..., None], square[..., None]
    by = np.zeros((2, 2, *dyad.shape))
    by[0, 1] = pulled * (2.0 * dyad - EYE / square) - outer(n, f)
    by[1, 0] = by[0, 1].swapaxes(-1, -2)
    by[1, 1] = half + half.swapaxes(-1, -2) + 2.0 * along * pulled * (EYE / square - 4.0 * dyad)
    by[1, 1] /= square
    return np.einsum("kivj,vwekicd,kiwl->ejcld", LINEAR, by, LINEAR, optimize=True)
