"""Where a plan point lies: the element that holds it and its local coordinates, edges and corners included.

Solves x(ξ) = Σ N_i(ξ) x_i for the bilinear map of a straight-sided quadrilateral by Newton's method in
every element whose bounding box holds the point, and keeps the element in which ξ lies deepest.
Local coordinates are scikit-fem's, 0 ≤ ξ ≤ 1.
"""

from __future__ import annotations

import numpy as np
from skfem import MeshQuad

SLACK = 1e-9  # how far outside, in element sizes, still counts as on the edge: rounding only
_PAIRS_AT_ONCE = 4_000_000


def locate(mesh: MeshQuad, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Elements (n,) and local coordinates (2, n) of plan points (n, 2) [m].

    Raises ValueError, naming the first one, if a point is off the mesh.
    """
    corners = mesh.p[:, mesh.t]  # (2, 4, m)
    low, high = corners.min(axis=1), corners.max(axis=1)
    slack = SLACK * (high - low).max()
    element = np.full(len(points), -1)
    local = np.zeros((2, len(points)))
    block = max(1, _PAIRS_AT_ONCE // mesh.nelements)
    for start in range(0, len(points), block):
        x = points[start : start + block].T  # (2, b)
        above, below = x[:, :, None] >= low[:, None] - slack, x[:, :, None] <= high[:, None] + slack
        point, candidate = np.nonzero(np.all(above & below, axis=0))
        xi = _invert(corners[:, :, candidate], x[:, point])
        outside = np.maximum(np.abs(xi - 0.5).max(axis=0) - 0.5, 0.0)
        order = np.lexsort((candidate, outside > SLACK, point))
        point, candidate, xi, outside = point[order], candidate[order], xi[:, order], outside[order]
        first = np.ones(len(point), dtype=bool)
        first[1:] = point[1:] != point[:-1]
        first &= outside <= SLACK
        element[start + point[first]] = candidate[first]
        local[:, start + point[first]] = np.clip(xi[:, first], 0.0, 1.0)
    if np.any(element < 0):
        x, y = points[np.argmax(element < 0)]
        raise ValueError(f"plan point ({x:g}, {y:g}) is off the sheet")
    return element, local


def _invert(corners: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Local coordinates (2, n) of x (2, n) in elements with corners (2, 4, n)."""
    a = corners[:, 0]
    b, c = corners[:, 1] - a, corners[:, 3] - a
    twist = corners[:, 2] - corners[:, 1] - c
    xi = np.full_like(x, 0.5)
    for _ in range(12):
        gap = a + b * xi[0] + c * xi[1] + twist * xi[0] * xi[1] - x
        along, across = b + twist * xi[1], c + twist * xi[0]
        area = along[0] * across[1] - along[1] * across[0]
        area = np.where(area == 0.0, np.inf, area)
        step = [gap[0] * across[1] - gap[1] * across[0], along[0] * gap[1] - along[1] * gap[0]]
        xi = np.clip(
            xi - np.array(step) / area, -2.0, 3.0
        )  # a foreign element of the bounding box must not send Newton away
    return xi
