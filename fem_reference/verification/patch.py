"""Patch tests: under a constant stress the inner nodes of distorted meshes are in balance.

Each model's nodes get the positions of a state of constant strain; the result is the largest unbalanced
force inside over the largest on the rim, zero up to rounding. Plate: constant stretch and curvature,
linear. Shell: a finite stretch and rotation, and a small constant curvature (with a finite one the positions
are not biquadratic). Solid: a finite deformation gradient, its top and bottom part of the rim.
"""

from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation
from skfem import MeshQuad

from fem_reference.discrete.static import Static, StaticState
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.surface.mesh import rectangle
from fem_reference.surface.outlined import quadrilaterals
from fem_reference.verification.rows import EXACT, Row, absolute_row
from fem_reference.verification.specimens import specimen
from sheetbench.scenes import Material, Sheet

ROUNDING = 1e-8
ELEMENTS, MOVED = 3, 0.25  # largest displacement of inner vertices, over an element's size
SCENE = specimen(Sheet(1.0, 1.0, 0.02), Material(young=1e7, poisson=0.3, density=1000.0), ())
STRETCH = np.array([[0.10, 0.04], [-0.03, -0.07]])  # displacement gradient in the plane
CURVATURE = np.array([[1.0, 1.5], [1.5, -1.0]])  # gradient of the director's tilt [1/m]
TURN = Rotation.from_rotvec([0.7, -1.1, 0.4]).as_matrix()
THROUGH = {"plate": 1.0, "shell": 1.0, "solid": 1.05}  # stretch of the directors
STATES: list[tuple[Any, str, Any]] = [  # the rotation of a stretch, the size of a curvature
    (DiscretePlate, "constant stretch", np.eye(3)),
    (DiscretePlate, "constant curvature", 1.0),
    (DiscreteShell, "finite stretch", TURN),
    (DiscreteShell, "constant curvature", 1e-8),
    (DiscreteSolid, "finite deformation", TURN),
]


def rows() -> Iterator[Row]:
    """Yield the largest force inside over the largest on the rim for every model and state."""
    meshes = {"distorted": distorted(), "along a line": following()}
    for (name, mesh), (kind, state, strained) in product(meshes.items(), STATES):
        unbalanced = _unbalanced(kind, mesh, strained)
        label = f"{kind.model} {mesh.nelements} elements, {name}"
        yield absolute_row(f"unbalanced, {state}", label, 0.0, EXACT, unbalanced, ROUNDING)


def distorted() -> MeshQuad:
    """Return the sheet's mesh with its inner vertices moved by fixed random numbers."""
    mesh = rectangle(SCENE.sheet, ELEMENTS)
    inner, points = mesh.interior_nodes(), mesh.p.copy()
    points[:, inner] += MOVED / ELEMENTS * np.random.default_rng(1).uniform(-1.0, 1.0, (2, len(inner)))
    return MeshQuad(points, mesh.t).with_boundaries(mesh.boundaries)


def following() -> MeshQuad:
    """Return a mesh of the sheet that follows an oblique line across it."""
    import shapely

    square, line = shapely.box(0.0, 0.0, 1.0, 1.0), shapely.LineString([(0.0, 0.3), (1.0, 0.7)])
    return quadrilaterals(square, line, (0.25, 0.25), True)


def _unbalanced(kind: Any, mesh: MeshQuad, strained: Any) -> float:
    """Return the largest force inside the unit square over the largest on its rim. strained: rotation of a
    stretched sheet, or size of its curvature."""
    sheet = kind(mesh, SCENE)
    nodes, moved, bent = sheet.plan.nodes, np.zeros((sheet.nodes, 3)), isinstance(strained, float)
    if bent:
        moved[:, 2] = -0.5 * strained * np.einsum("na,ab,nb->n", nodes, CURVATURE, nodes)
        turned = np.pad(strained * nodes @ CURVATURE, ((0, 0), (0, 1)))
    else:
        moved[:, :2] = nodes @ STRETCH.T
        moved = (sheet.flat + moved) @ strained.T - sheet.flat
        turned = np.tile(THROUGH[sheet.model] * strained[:, 2] - [0.0, 0.0, 1.0], (sheet.nodes, 1))
    residual = np.abs(Static(sheet).forces(StaticState(sheet.of_vectors(moved, turned)), 0.0).residual)
    inside = np.all((nodes > 1e-9) & (nodes < 1.0 - 1e-9), axis=1)
    if bent:
        forces = np.concatenate(residual.reshape(2, -1, 3), axis=1)[:, 2:5]
        return float(forces[inside].max() / forces[~inside].max())
    forces = sheet.displacement(residual)
    return float(sheet.middles(forces)[inside].max() / forces.max())
