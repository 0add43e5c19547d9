"""Location of plan points: the element that holds a point, edges included, and its local coordinates.

Solves x(ξ) = Σ N_i(ξ) x_i, scikit-fem's map of a straight-sided or biquadratic quadrilateral, by Newton's
method in every element whose bounding box holds the point, and keeps the first element whose own points
come nearest to it: in a distorted element without the point the method may end anywhere.
"""

import numpy as np
from skfem import MeshQuad

from fem_reference.surface.biquadratic import shape
from sheetbench.errors import BadInput
from sheetbench.numerics.cache import cached

SLACK = 1e-9  # distance outside, in element sizes, that still counts as on the edge: rounding only
CURVED_SLACK = 0.05  # that distance for elements with curved sides, which follow a shape approximately
_PAIRS_AT_ONCE = 4_000_000
_NEWTON = 8


def locate(mesh: MeshQuad, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return elements (n,) and their coordinates r, s (2, n) in [−1, 1] of plan points (n, 2) [m]. Raises
    BadInput, naming the first one, if a point is off the mesh."""
    nodes = mesh.doflocs[:, mesh.dofs.element_dofs]  # (2, 4 or 9, m)
    low, high = nodes.min(axis=1), nodes.max(axis=1)
    bulge = SLACK if nodes.shape[1] == 4 else 0.25  # a curved side leaves the box of its nodes
    slack = bulge * (high - low).max()
    element = np.full(len(points), -1)
    local = np.zeros((2, len(points)))
    block = max(1, _PAIRS_AT_ONCE // mesh.nelements)
    for start in range(0, len(points), block):
        x = points[start : start + block].T  # (2, b)
        above, below = x[:, :, None] >= low[:, None] - slack, x[:, :, None] <= high[:, None] + slack
        point, candidate = np.nonzero(np.all(above & below, axis=0))
        xi, outside = _invert(mesh, candidate, x[:, point])
        outside /= (high - low).max(axis=0)[candidate]
        order = np.lexsort((candidate, np.maximum(outside, SLACK), point))
        first = order[np.unique(point[order], return_index=True)[1]]
        first = first[outside[first] <= (SLACK if nodes.shape[1] == 4 else CURVED_SLACK)]
        element[start + point[first]] = candidate[first]
        local[:, start + point[first]] = xi[:, first]
    if np.any(element < 0):
        x, y = points[np.argmax(element < 0)]
        raise BadInput(f"plan point ({x:g}, {y:g}) is off the sheet")
    return element, 2.0 * local - 1.0


def interpolate(
    mesh: MeshQuad, element_nodes: np.ndarray, nodal: np.ndarray, points: np.ndarray
) -> np.ndarray:
    """Return a biquadratic nodal field (n, k) at plan points (p, 2) [m]: (p, k); element_nodes: (m, 9).
    Raises BadInput off the mesh."""
    element, value = shares(mesh, points)
    return np.einsum("pi,pik->pk", value, nodal[element_nodes[element]])


def shares(mesh: MeshQuad, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the elements (p,) of plan points (p, 2) [m], and the shape functions of their nodes there (p,
    9). Raises BadInput off the mesh."""
    return _shares(type(mesh), mesh.doflocs, mesh.t, points)


@cached(last=8, most=1 << 18)
def _shares(
    kind: type[MeshQuad], places: np.ndarray, elements: np.ndarray, points: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    element, place = locate(kind(places, elements), points)
    return element, shape(*place)[0]


def _invert(mesh: MeshQuad, elements: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return local coordinates 0 ≤ ξ ≤ 1 (2, n) of x (2, n) in elements (n,), and distances (n,) [m] from
    x."""
    mapping = mesh.mapping()
    xi = np.full_like(x, 0.5)
    for _ in range(_NEWTON):
        gap = mapping.F(xi[:, :, None], tind=elements)[:, :, 0] - x
        (a, b), (c, d) = mapping.DF(xi[:, :, None], tind=elements)[:, :, :, 0]
        area = a * d - b * c
        step = np.stack([d * gap[0] - b * gap[1], a * gap[1] - c * gap[0]])
        # A foreign element of the bounding box must not send Newton away; outside it may be folded.
        xi = np.clip(xi - np.divide(step, area, out=np.zeros_like(step), where=area != 0.0), -1.0, 2.0)
    xi = np.clip(xi, 0.0, 1.0)
    return xi, np.linalg.norm(mapping.F(xi[:, :, None], tind=elements)[:, :, 0] - x, axis=0)
