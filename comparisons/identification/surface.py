"""The deformed mid-surface of a model as a smooth surface, and the distance of measured points from it.

φ(x, y) = (x, y, 0) + u(x, y), with u a cubic spline through the displacements on a plan grid. The foot of a
point P minimises |P − φ| over the sheet (Gauss–Newton in x, y); the distance is the component of P − φ along
the normal there, so that sliding within the surface, or a point measured beyond the sheet's edge, counts for
nothing. The distance's derivative by a parameter is −n · ∂u/∂θ at the foot (envelope theorem). Metres.
"""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RectBivariateSpline
from scipy.spatial import KDTree

ITERATIONS = 30
FOOT_TOLERANCE = 1e-10  # of the sheet's longer side: a step of the foot that ends the search


def plan_grid(lengths: tuple[float, float], counts: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Return coordinates along x and along y [m], ends included."""
    return np.linspace(0.0, lengths[0], counts[0]), np.linspace(0.0, lengths[1], counts[1])


def plan_points(axes: tuple[np.ndarray, np.ndarray]) -> np.ndarray:
    """Return all points of a plan grid (nx · ny, 2) [m], y running fastest."""
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)


class Field:
    """A vector field (nx · ny, 3), as `plan_points` orders it, between its grid points."""

    def __init__(self, axes: tuple[np.ndarray, np.ndarray], values: np.ndarray):
        shape = (len(axes[0]), len(axes[1]))
        degrees = [min(3, n - 1) for n in shape]
        self._parts = [
            RectBivariateSpline(*axes, part.reshape(shape), kx=degrees[0], ky=degrees[1]) for part in values.T
        ]

    def at(self, points: np.ndarray, dx: int = 0, dy: int = 0) -> np.ndarray:
        """Return values, or derivatives of order (dx, dy), at plan points (n, 2): (n, 3)."""
        return np.stack([part.ev(*points.T, dx=dx, dy=dy) for part in self._parts], axis=1)


@dataclass(frozen=True)
class Feet:
    """Feet of measured points: (n, 2) on the flat sheet [m], unit normals (n, 3), distances (n,) [m],
    positive on the side of the normal (initially +z)."""

    points: np.ndarray
    normals: np.ndarray
    distances: np.ndarray


def feet(axes: tuple[np.ndarray, np.ndarray], displacement: Field, cloud: np.ndarray) -> Feet:
    """Return the feet of a cloud (n, 3) [m] on the deformed surface."""
    lengths = np.array([axes[0][-1], axes[1][-1]])
    candidates = plan_points(plan_grid((lengths[0], lengths[1]), (65, 65)))
    _, nearest = KDTree(_evaluate_points(candidates, displacement)).query(cloud)
    plan = candidates[nearest]
    for _ in range(ITERATIONS):
        offsets = cloud - _evaluate_points(plan, displacement)
        tangents = _evaluate_tangents(plan, displacement)  # (n, 3, 2)
        metric = tangents.swapaxes(1, 2) @ tangents
        step = np.linalg.solve(metric, tangents.swapaxes(1, 2) @ offsets[:, :, None])[:, :, 0]
        updated = np.clip(plan + step, 0.0, lengths)
        change = np.abs(updated - plan).max()
        plan = updated
        if change < FOOT_TOLERANCE * lengths.max():
            break
    tangents = _evaluate_tangents(plan, displacement)
    normals = np.cross(tangents[:, :, 0], tangents[:, :, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    distances = np.einsum("nc,nc->n", normals, cloud - _evaluate_points(plan, displacement))
    return Feet(plan, normals, distances)


def _evaluate_points(plan: np.ndarray, displacement: Field) -> np.ndarray:
    return np.column_stack([plan, np.zeros(len(plan))]) + displacement.at(plan)


def _evaluate_tangents(plan: np.ndarray, displacement: Field) -> np.ndarray:
    flat = np.eye(3)[:, :2]
    derivatives = np.stack([displacement.at(plan, dx=1), displacement.at(plan, dy=1)], axis=-1)
    return np.asarray(flat + derivatives)
