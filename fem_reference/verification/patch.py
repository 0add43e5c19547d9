"""Patch tests: under a constant stress the inner nodes of distorted meshes are in balance.

Each model's nodes are put where a state of constant strain has them; the result is the largest unbalanced
force inside over the largest on the rim: zero but for rounding. Plate: constant stretch and curvature,
linear. Shell: a finite stretch and rotation, and a small constant curvature (with a finite one the positions
are not biquadratic). Solid: a finite deformation gradient.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation
from skfem import MeshQuad

from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.static import Static, StaticState
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.surface.mesh import rectangle
from fem_reference.surface.outlined import quadrilaterals
from fem_reference.verification.rows import EXACT, Row, absolutely
from sheetbench.scenes import Material, Scene, Sheet

ROUNDING = 1e-8
ELEMENTS, MOVED = 3, 0.25  # inner vertices move by up to so much of an element
SCENE = Scene(
    name="patch",
    sheet=Sheet(length_x=1.0, length_y=1.0, thickness=0.02),
    material=Material(young=1e7, poisson=0.3, density=1000.0),
)
STRETCH = np.array([[0.10, 0.04], [-0.03, -0.07]])  # displacement gradient in the plane
CURVATURE = np.array([[1.0, 1.5], [1.5, -1.0]])  # gradient of the director's tilt [1/m]
SMALL = 1e-8
TURN = Rotation.from_rotvec([0.7, -1.1, 0.4]).as_matrix()


def rows() -> Iterator[Row]:
    """The largest force inside over the largest on the rim for every model and state."""
    states: dict[str, dict[str, Callable[[MeshQuad], float]]] = {
        "plate": {
            "constant stretch": partial(_stretched, DiscretePlate, np.eye(3)),
            "constant curvature": partial(_curved, DiscretePlate, 1.0),
        },
        "shell": {
            "finite stretch": partial(_stretched, DiscreteShell, TURN),
            "constant curvature": partial(_curved, DiscreteShell, SMALL),
        },
        "solid": {"finite deformation": partial(_stretched, DiscreteSolid, TURN, through=1.05)},
    }
    for name, mesh in (("distorted", distorted()), ("along a line", following())):
        for model, checks in states.items():
            for state, unbalanced in checks.items():
                label = f"{model} {mesh.nelements} elements, {name}"
                yield absolutely(f"unbalanced, {state}", label, 0.0, EXACT, unbalanced(mesh), ROUNDING)


def distorted() -> MeshQuad:
    """The sheet's mesh with its inner vertices moved at random, always alike."""
    mesh = rectangle(SCENE.sheet, ELEMENTS)
    inner, points = mesh.interior_nodes(), mesh.p.copy()
    points[:, inner] += MOVED / ELEMENTS * np.random.default_rng(1).uniform(-1.0, 1.0, (2, len(inner)))
    return MeshQuad(points, mesh.t).with_boundaries(mesh.boundaries)


def following() -> MeshQuad:
    """A mesh of the sheet that follows an oblique line across it."""
    import shapely

    square, line = shapely.box(0.0, 0.0, 1.0, 1.0), shapely.LineString([(0.0, 0.3), (1.0, 0.7)])
    return quadrilaterals(square, line, (0.25, 0.25), True)


def _inside(plan: np.ndarray) -> np.ndarray:
    """Which of plan positions (n, 2) [m] lie within the unit square."""
    return np.asarray(np.all((plan > 1e-9) & (plan < 1.0 - 1e-9), axis=1))


def _residual(sheet: DiscreteElements, q: np.ndarray) -> np.ndarray:
    """Forces (N,)."""
    return Static(sheet).forces(StaticState(q), 0.0).residual


def _stretched(model: Any, turn: np.ndarray, mesh: MeshQuad, through: float = 1.0) -> float:
    """through: by which the directors are stretched, of the solid, whose top and bottom belong to the rim."""
    sheet = model(mesh, SCENE)
    moved = (sheet.flat + np.pad(sheet.plan.nodes @ STRETCH.T, ((0, 0), (0, 1)))) @ turn.T - sheet.flat
    turned = np.tile(through * turn[:, 2] - [0.0, 0.0, 1.0], (sheet.nodes, 1))
    forces = sheet.displacement(_residual(sheet, sheet.of_vectors(moved, turned)))
    return float(np.abs(sheet.middles(forces)[_inside(sheet.plan.nodes)]).max() / np.abs(forces).max())


def _curved(model: type[DiscreteShell], size: float, mesh: MeshQuad) -> float:
    sheet = model(mesh, SCENE)
    nodes, (moved, turned) = sheet.plan.nodes, np.zeros((2, sheet.nodes, 3))
    moved[:, 2] = -0.5 * size * np.einsum("na,ab,nb->n", nodes, CURVATURE, nodes)
    turned[:, :2] = size * nodes @ CURVATURE
    force, couple = _residual(sheet, sheet.of_vectors(moved, turned)).reshape(2, -1, 3)
    forces, inside = np.abs(np.column_stack([force[:, 2], couple[:, :2]])), _inside(nodes)
    return float(forces[inside].max() / forces[~inside].max())
