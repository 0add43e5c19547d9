"""Plan meshes of the flat sheet: quadrilaterals, near-square, with the edges named as in the scene.

A mesh is scikit-fem's `MeshQuad` with the boundaries "x0", "x1", "y0", "y1"; the models take any other
flat quadrilateral mesh as well. Biquadratic nodes lie at corners, mid-sides and centres, in the
order of scikit-fem's `ElementQuad2`. Coordinates in metres.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from skfem import MeshQuad

from scenes import EDGES, Sheet

Elements = int | tuple[int, int]

# A nine-node element drawn as four bilinear quadrilaterals; local nodes: 4 corners, 4 mid-sides, centre.
_QUARTERS = np.array([[0, 4, 8, 7], [4, 1, 5, 8], [8, 5, 2, 6], [7, 8, 6, 3]])


def divisions(lengths: tuple[float, float], elements: Elements) -> tuple[int, int]:
    """Elements along x and y: a pair as given, or that many along the shorter side and near-square ones.

    Raises ValueError for fewer than one element.
    """
    if isinstance(elements, tuple):
        along_x, along_y = elements
    else:
        size = min(lengths) / max(elements, 1)
        along_x, along_y = (max(elements, round(length / size)) for length in lengths)
    if along_x < 1 or along_y < 1 or (isinstance(elements, int) and elements < 1):
        raise ValueError(f"elements = {elements}: at least one element along each side")
    return along_x, along_y


def rectangle(sheet: Sheet, elements: Elements) -> MeshQuad:
    """A uniform mesh of the sheet whose boundaries carry the edges' names."""
    along_x, along_y = divisions(sheet.lengths, elements)
    mesh = MeshQuad.init_tensor(
        np.linspace(0.0, sheet.length_x, along_x + 1), np.linspace(0.0, sheet.length_y, along_y + 1)
    )
    ends = {name: sheet.lengths[edge.normal_axis] * edge.far_end for name, edge in EDGES.items()}
    return mesh.with_boundaries({name: _at(EDGES[name].normal_axis, end) for name, end in ends.items()})


def _at(axis: int, position: float) -> Callable[[np.ndarray], np.ndarray]:
    return lambda x: np.isclose(x[axis], position, rtol=1e-9, atol=1e-12)


def quarters(element_nodes: np.ndarray) -> np.ndarray:
    """Nine-node elements (9, m) as bilinear cells (4 m, 4) for drawing."""
    return element_nodes.T[:, _QUARTERS].reshape(-1, 4)
