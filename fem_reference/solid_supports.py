"""What supports hold in the solid, as a function of the load factor.

The mid-line of a supported edge is held as in the scene. A clamp holds the edge's face as well:

    "shell-like"  the face stays on the director, free to change its thickness along it: the components across
                  the director are held everywhere, the one along it on the mid-line only. This is the
                  clamp of a shell, and leaves no singular corner
    "full"        all three components of the whole face; the strain is singular at its rims

The face of a rod bent by λκ follows the rod's director: held values are u = u_rod + ζ (d − e_z), and the held
components are taken in the frame (across the edge, along the rod, d).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fem_reference import shell_supports
from fem_reference.shell_supports import Supports
from fem_reference.solid_mesh import Columns
from scenes import Scene, holds_director

CLAMPS = ("shell-like", "full")


@dataclass(frozen=True)
class ColumnSupports:
    """held: (n, levels, 3) by component of the node's frame; edges: name → held components of its own."""

    line: Supports
    heights: np.ndarray
    held: np.ndarray
    edges: dict[str, np.ndarray]

    def target(self, load_factor: float) -> np.ndarray:
        """Prescribed displacement (n, levels, 3) [m]; zero where nothing moves."""
        displacement, turn = self.line.change(load_factor)
        return displacement[:, None] + self.heights[:, None] * turn[:, None]

    def frames(self, load_factor: float) -> np.ndarray:
        """Axes (n, 3, 3) in which components are held, by column; the third is the director of a rod."""
        frames = np.tile(np.eye(3), (len(self.held), 1, 1))
        for rod in self.line.rods:
            _, turn = rod.change(load_factor)
            along, up = -turn[:, rod.axis], 1.0 + turn[:, 2]  # sin and cos of the rod's angle
            frames[rod.nodes, rod.axis, rod.axis], frames[rod.nodes, 2, rod.axis] = up, along
            frames[rod.nodes, rod.axis, 2], frames[rod.nodes, 2, 2] = -along, up
        return frames

    @property
    def turned(self) -> np.ndarray:
        """Plan nodes (n,) whose frame is not the scene's."""
        on = np.zeros(len(self.held), dtype=bool)
        for rod in self.line.rods:
            on[rod.nodes] = True
        return on

    def reactions(self, nodal: np.ndarray, load_factor: float) -> dict[str, np.ndarray]:
        """Force [N] (3,) of each support from nodal ones (n, levels, 3); what several hold they share."""
        frames = self.frames(load_factor)
        local = np.einsum("nck,nlc->nlk", frames, nodal) / np.maximum(sum(self.edges.values()), 1)
        return {
            name: np.einsum("nck,nlk->c", frames, np.where(held, local, 0.0))
            for name, held in self.edges.items()
        }


def of_scene(scene: Scene, columns: Columns, clamp: str) -> ColumnSupports:
    """The supports of a scene. Raises ValueError for an unknown clamp."""
    if clamp not in CLAMPS:
        raise ValueError(f"clamp = {clamp!r}: known are {', '.join(CLAMPS)}")
    on_edge = {str(support.edge): columns.edge(support.edge) for support in scene.supports}
    line = shell_supports.of_scene(scene, columns.plan_nodes, on_edge)
    edges = {}
    for support in scene.supports:
        nodes, axes = line.edges[support.edge]
        held = np.zeros((len(columns.plan_nodes), columns.levels, 3), dtype=bool)
        held[nodes[:, None], columns.layers, axes] = True
        if holds_director(support):
            held[nodes, :, : 2 if clamp == "shell-like" else 3] = True
        edges[str(support.edge)] = held
    none = np.zeros((len(columns.plan_nodes), columns.levels, 3), dtype=bool)
    return ColumnSupports(line, columns.heights, np.logical_or.reduce([none, *edges.values()]), edges)
