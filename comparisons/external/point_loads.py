"""Point loads on the nodes of an external code's mesh, by its shape functions."""

from __future__ import annotations

from typing import Protocol

import numpy as np

from sheetbench.scenes import PointLoad, Scene


class Mesh(Protocol):
    """Nodes (n, 3) [m], and at plan points (p, 2) [m] the nodes around with their shares, (p, k) both."""

    @property
    def positions(self) -> np.ndarray: ...

    def weights(self, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]: ...


def point_loads(scene: Scene, mesh: Mesh) -> np.ndarray:
    """Forces on the nodes (n, 3) [N]."""
    out = np.zeros_like(mesh.positions)
    for load in scene.loads:
        if isinstance(load, PointLoad):
            nodes, weights = mesh.weights(np.array([load.at]))
            out[nodes[0]] += load.last_factor * np.outer(weights[0], load.force)
    return out
