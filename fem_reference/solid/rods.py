"""Elastic rods on the edges of the solid (see `rod`): columns follow the rod's director.

The rod is bound to the mid-line, φ being a column's middle node; d, m and a third director t along the edge,
three components each at every node, are unknowns beside the solid's. A column, like the face of a clamp, is
free only to change its thickness along d: with w = x_l − φ of every level l, at every node

    w · m,    w · t,    t · d,    t · m,    ½ (d · d − 1),    ½ (m · m − 1),    ½ (t · t − 1)

vanish, as firmly as the rod's own d · m. All strains stay quadratic forms of the unknowns. SI units.
"""

from collections.abc import Sequence

import numpy as np

from fem_reference.solid.mesh import Columns
from fem_reference.surface.rod import SQUARE, BoundRods, Rod, RodElements, bound, products

DIRECTORS = 9  # of a side: d, m and t of its three nodes


def on_columns(rods: Sequence[Rod], columns: Columns) -> BoundRods:
    """Return the rods on columns of nodes; vectors: x (n · levels), then d, m, t of every rod's nodes."""
    levels = columns.levels

    def of_columns(rod: Rod) -> tuple[RodElements, np.ndarray]:
        numbers = levels * rod.nodes[:, :, None] + np.arange(levels)
        return _elements(rod, columns), numbers.reshape(-1, 3 * levels)

    return bound(rods, 3 * levels + DIRECTORS, columns.positions.size // 3, of_columns, DIRECTORS // 3)


def _elements(rod: Rod, columns: Columns) -> RodElements:
    """Return the rod in terms of Q = (x of a side's columns; d, m, t at three nodes), (k, 3 levels + 9,
    3)."""
    side, levels, middle, k = rod.elements, columns.levels, columns.layers, len(rod.nodes)
    unit = np.eye(3 * levels + DIRECTORS)
    middles, (d, m, t) = unit[middle : 3 * levels : levels], unit[3 * levels :].reshape(3, 3, -1)
    onto = np.concatenate([middles, d, m])  # (φ, d, m) of Q
    penalty = side.stiffness[:, SQUARE]
    forms, stiffness = [np.einsum("ia,esij,jb->esab", onto, side.forms, onto)], [side.stiffness]
    pairs = [(t, d, 1.0), (t, m, 1.0), (d, d, 0.5), (m, m, 0.5), (t, t, 0.5)]
    for a, b, share in pairs:
        forms.append(np.tile(share * products(a, b), (k, 1, 1, 1)))
        stiffness.append(penalty)
    for level in (level for level in range(levels) if level != middle):
        off = unit[level : 3 * levels : levels] - middles
        for director in (m, t):
            forms.append(np.tile(products(off, director), (k, 1, 1, 1)))
            stiffness.append(penalty / columns.thickness**2)
    flat = columns.positions[rod.nodes].reshape(k, -1, 3)
    along = np.cross(side.reference[:, 3:6], side.reference[:, 6:])
    total = np.concatenate(stiffness, axis=1)
    reference = np.concatenate([flat, side.reference[:, 3:], along], axis=1)
    more = total.shape[1] - side.intrinsic.shape[1]  # strains without an intrinsic part
    intrinsic = np.pad(side.intrinsic, ((0, 0), (0, more), (0, 0)))
    return RodElements(reference, np.concatenate(forms, axis=1), total, intrinsic)
