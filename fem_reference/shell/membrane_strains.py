"""Membrane strains of one mesh of shell elements on another: Cartesian ones at nodes stand between the two.

Those of an element are sampled along its own coordinates ξ (see `element`): with J = ∂x/∂ξ in the flat sheet

    e_αβ = J_xα E_xy J_yβ.

At the nodes of its elements a mesh has what their samples extrapolate to, on average.
"""

from __future__ import annotations

import numpy as np
from skfem import ElementQuad2

from fem_reference.shell.element import GRIDS
from fem_reference.surface.biquadratic import interpolation, jacobians, product_grid, shape

NODES = 2.0 * ElementQuad2.doflocs.T - 1.0
ALONG = {"rr": (0, 0), "ss": (1, 1), "rs": (0, 1)}  # e_αβ in the order of their samples
_TO_NODES = {name: interpolation(*GRIDS[name], NODES) for name in ALONG}
_AT_SAMPLES = {name: shape(*product_grid(*GRIDS[name])) for name in ALONG}
_AT_NODES = shape(*NODES)[1]
_ENDS = np.cumsum([len(points.T) for points in _TO_NODES.values()])


def at_nodes(nodes: np.ndarray, element_nodes: np.ndarray, strain: np.ndarray) -> np.ndarray:
    """E (n, 2, 2) at the nodes of elements at (m, 9, 2) [m] with samples (m, 21); element_nodes: (m, 9)."""
    along = zip(_TO_NODES.values(), np.split(strain, _ENDS[:-1], axis=1), strict=True)
    rr, ss, rs = (samples @ to_nodes.T for to_nodes, samples in along)
    tensor = np.moveaxis(np.array([[rr, rs], [rs, ss]]), (0, 1), (2, 3))
    inverse = np.linalg.inv(jacobians(nodes, _AT_NODES))  # ∂ξ_a/∂x_b
    sums = np.zeros((element_nodes.max() + 1, 2, 2))
    np.add.at(sums, element_nodes, inverse.swapaxes(2, 3) @ tensor @ inverse)
    return sums / np.bincount(element_nodes.ravel())[:, None, None]


def sampled(nodes: np.ndarray, strain: np.ndarray) -> np.ndarray:
    """Samples (m, 21) of elements at (m, 9, 2) [m] of E (m, 9, 2, 2) at their nodes."""
    found = []
    for (a, b), (value, slope) in zip(ALONG.values(), _AT_SAMPLES.values(), strict=True):
        jacobian = jacobians(nodes, slope)
        here = (value @ strain.reshape(-1, 9, 4)).reshape(-1, len(value), 2, 2)
        found.append(np.einsum("epx,epxy,epy->ep", jacobian[..., a], here, jacobian[..., b]))
    return np.concatenate(found, axis=1)
