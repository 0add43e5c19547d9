"""Surfaces of obstacles: distance φ, normal n = ∇φ and curvature H = ∇n, with y the position less the
obstacle's, across its axis if it has one:

    plane               φ = y·n,      H = 0
    sphere, cylinder    φ = |y| − R,  n = y/|y|,  H = (P − n nᵀ)/|y|,

P the projector across the axis, the identity for a sphere. Source: the gradient and Hessian of a distance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from sheetbench.scenes import Plane
from sheetbench.scenes.objects.obstacles import AnyObstacle


class At(NamedTuple):
    """Points relative to an obstacle, across its axis, y (…, 3) [m]; |y| or y·n (…) [m], the distance φ (…)
    [m] and the unit normal (…, 3)."""

    across: np.ndarray
    length: np.ndarray
    distance: np.ndarray
    normal: np.ndarray


class ObstacleSurface:
    """An obstacle's surface. radius [m], infinite of a plane."""

    def __init__(self, obstacle: AnyObstacle):
        self.flat = isinstance(obstacle, Plane)
        self.radius = np.inf if isinstance(obstacle, Plane) else obstacle.radius
        self._normal = obstacle.direction
        self.projector = np.eye(3) - (0.0 if self.flat else np.outer(self._normal, self._normal))

    def at(self, places: np.ndarray) -> At:
        """Return where places (…, 3) [m], less the obstacle's own position, are."""
        if self.flat:
            distance = places @ self._normal
            return At(places, distance, distance, np.broadcast_to(self._normal, places.shape))
        across = places @ self.projector
        length = np.sqrt((across * across).sum(axis=-1))
        return At(across, length, length - self.radius, across / length[..., None])

    def curvature(self, at: At) -> np.ndarray:
        """Return H (…, 3, 3) [1/m]."""
        if self.flat:
            return np.zeros((*at.length.shape, 3, 3))
        outer = at.normal[..., :, None] * at.normal[..., None, :]
        bent: np.ndarray = (self.projector - outer) / at.length[..., None, None]
        return bent

    def mean_normal(self, start: At, end: At) -> np.ndarray:
        """Return n̄ (…, 3) with n̄·Δy = Δφ exactly: n, or (y₀ + y₁)/(|y₀| + |y₁|) as Δ|y|² = (y₀ + y₁)·Δy."""
        if self.flat:
            return end.normal
        mean: np.ndarray = (start.across + end.across) / (start.length + end.length)[..., None]
        return mean
