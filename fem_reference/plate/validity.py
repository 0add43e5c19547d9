"""Limits of the linear plate's theory: strains, turns and in-plane forces.

strained  the mid-surface stretched, or the sheet too heavy, for a linear law (`scenes.outside_model`).
turned    the director e_z + β, the slope ∇w, or the turn ω = ½ (v,x − u,y) in the plane is more than 1: no
          rotation by any angle tilts a director by more than its length.
buckled   the in-plane forces N, which the plate's bending neglects, take its stability at a share λ of the
          load: with K the stiffness and K_N the geometric stiffness of N on the slopes of w,

              K φ = −λ K_N φ,      φ·K_N φ = ∫ ∇w·N ∇w dA

          (e.g. Bathe, Finite Element Procedures, 6.8). Checked where N presses somewhere and a² |N|/D > 1, a
          the longer side: a square sheet held along one edge buckles at π²/4. Sheets with chains, whose own
          forces take part, are not checked.

The answer is linear in the load, so that each criterion gives the share of the load at which the theory ends.
"""

import numpy as np
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigsh

from fem_reference.discrete.shape import SheetShape
from fem_reference.plate.element import BENDING, MEMBRANE, PlateElements

LEAST_FORCE = 1.0  # a² |N|/D, below which in-plane forces do not buckle a sheet


def nonlinearity(elements: PlateElements, change: np.ndarray, strain: np.ndarray) -> float:
    """Return the largest slope, turn, or double the mean strain along x or y of an element; linear theory
    ends at 1 of each. change: of the vectors (m, 18, 3); strain: (9 m, 8)."""
    by_xy = elements.gradient @ change[:, None, :9]  # of u, v and w by x and y, (m, 9, 2, 3)
    inplane = 0.5 * (by_xy[:, :, 0, 1] - by_xy[:, :, 1, 0])
    tilt, slope = np.linalg.norm(change[:, 9:], axis=2), np.linalg.norm(by_xy[..., 2], axis=2)
    along = np.einsum("mq,mqi->mi", elements.areas, strain.reshape(-1, 9, 8)[..., :2])
    mean = along / elements.areas.sum(axis=1, keepdims=True)
    return float(max(tilt.max(), slope.max(), np.abs(inplane).max(), 2.0 * np.abs(mean).max()))


def buckling_load(shape: SheetShape) -> float | None:
    """Return the lowest positive share of the load at which the in-plane forces buckle the plate. shape:
    under the full load; the result is None for forces that cannot buckle it, or hardly."""
    sheet, elements = shape.sheet, shape.sheet.element
    force = shape.elastic[:, MEMBRANE] / elements.areas.reshape(-1, 1)  # [N/m]
    xx, yy, xy = force.T
    pressing = -(0.5 * (xx + yy) - np.hypot(0.5 * (xx - yy), xy)).min()
    rigidity = (elements.stiffness[:, BENDING.start, BENDING.start] / elements.areas.ravel()).max()
    if sheet.bodies or pressing * max(sheet.scene.sheet.lengths) ** 2 < LEAST_FORCE * rigidity:
        return None
    tensor = force[:, [0, 2, 2, 1]].reshape(*elements.areas.shape, 2, 2) * elements.areas[..., None, None]
    on_w = np.einsum("mqai,mqab,mqbj->mij", elements.gradient, tensor, elements.gradient)
    blocks = np.zeros((len(on_w), 18, 3, 18, 3))
    blocks[:, :9, 2, :9, 2] = on_w
    geometric = sheet.folded(blocks)
    matrix = sheet.tangent(shape, np.zeros(sheet.size), 0.0, 0.0)
    inverse = LinearOperator(matrix.shape, matvec=sheet.solver().factor(matrix).solve, dtype=float)
    start = np.random.default_rng(0).uniform(-1.0, 1.0, sheet.unknowns)
    options = {"Minv": inverse, "which": "LA", "v0": start, "tol": 1e-6, "return_eigenvectors": False}
    try:
        largest = eigsh(-geometric, 1, matrix, **options)
    except ArpackNoConvergence:
        return None
    return 1.0 / float(largest[0]) if largest[0] > 0.0 else None
