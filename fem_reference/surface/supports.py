"""What supports hold in the sheet, as a function of the load factor.

Of every node the position φ = X + u and the director d may be held. A rod bent to curvature κ, with s
measured from the middle of the edge along e and the middle and its tangent unmoved, keeps arc length:

    φ(s) = φ(0) + e sin(κs)/κ + e_z (1 − cos κs)/κ,    d(s) = e_z cos κs − e sin κs.

A clamp tilted by τ leaves φ = X and turns the director, with n out of the sheet,

    d = e_z cos τ − n sin τ.

With load factor λ the rod is bent to λκ and the clamp tilted by λτ. Where two supports share a corner both
hold what they hold.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from sheetbench.scenes import EDGES, Clamped, Curved, Scene, Symmetric, held_axes, holds_director, rod_middle


class Driver(Protocol):
    """What moves nodes (k,) that are held: their displacement [m] and change of director, (k, 3) each."""

    @property
    def nodes(self) -> np.ndarray: ...
    def change(self, load_factor: float) -> tuple[np.ndarray, np.ndarray]: ...


@dataclass(frozen=True)
class BentEdge:
    """nodes: (k,) on the rod; arc: s (k,) [m]; axis: 0 or 1, the edge's direction; curvature [1/m]."""

    nodes: np.ndarray
    arc: np.ndarray
    axis: int
    curvature: float

    def change(self, load_factor: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (k, 3) [m] and change of director (k, 3) at a load factor."""
        kappa = load_factor * self.curvature
        angle = kappa * self.arc
        displacement, turn = np.zeros((len(self.arc), 3)), np.zeros((len(self.arc), 3))
        displacement[:, self.axis] = self.arc * (np.sinc(angle / np.pi) - 1.0)
        displacement[:, 2] = self.arc * np.sin(angle / 2.0) * np.sinc(angle / (2.0 * np.pi))
        turn[:, self.axis] = -np.sin(angle)
        turn[:, 2] = -2.0 * np.sin(angle / 2.0) ** 2
        return displacement, turn


@dataclass(frozen=True)
class TiltedClamp:
    """nodes: (k,) on the edge; axis: 0 or 1, normal to the edge; tilt: of the director away from it [rad]."""

    nodes: np.ndarray
    axis: int
    tilt: float

    def change(self, load_factor: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (k, 3) [m], which is zero, and change of director (k, 3) at a load factor."""
        angle = load_factor * self.tilt
        turn = np.zeros((len(self.nodes), 3))
        turn[:, self.axis] = -np.sin(angle)
        turn[:, 2] = -2.0 * np.sin(angle / 2.0) ** 2
        return np.zeros_like(turn), turn


@dataclass(frozen=True)
class Supports:
    """What is held: position (n, 3) by component, director (n,); edges: name → nodes and held axes.

    tilt: (n, 2), whether the director's component along x or y is held at 0, as on a plane of symmetry;
    turning: what turns the directors of held nodes in the plane of its axis and z; driven: what else moves
    nodes that are held.
    """

    position: np.ndarray
    director: np.ndarray
    tilt: np.ndarray
    edges: dict[str, tuple[np.ndarray, np.ndarray]]
    turning: tuple[BentEdge | TiltedClamp, ...]
    driven: tuple[Driver, ...] = ()

    def change(self, load_factor: float) -> np.ndarray:
        """Prescribed change (2, n, 3) of positions [m] and directors; zero where nothing moves them."""
        out = np.zeros((2, len(self.director), 3))
        for driver in (*self.turning, *self.driven):
            out[:, driver.nodes] = driver.change(load_factor)
        return out

    def reactions(self, nodal: np.ndarray) -> dict[str, np.ndarray]:
        """Force [N] (3,) of each support from the nodal ones (n, 3); supports that hold the same share it."""
        holders = np.zeros_like(nodal)
        for nodes, axes in self.edges.values():
            holders[np.ix_(nodes, axes)] += 1.0
        out = {}
        for name, (nodes, axes) in self.edges.items():
            out[name] = np.zeros(3)
            held = np.ix_(nodes, axes)
            out[name][axes] = np.sum(nodal[held] / holders[held], axis=0)
        return out


def of_scene(scene: Scene, nodes: np.ndarray, on_edge: dict[str, np.ndarray]) -> Supports:
    """The supports of a scene on nodes with plan positions (n, 2) [m]; on_edge: the nodes of every edge."""
    position, director = np.zeros((len(nodes), 3), dtype=bool), np.zeros(len(nodes), dtype=bool)
    tilt = np.zeros((len(nodes), 2), dtype=bool)
    edges: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    turning: list[BentEdge | TiltedClamp] = []
    for support in scene.supports:
        on, axes = on_edge[support.edge], np.array(held_axes(support))
        position[np.ix_(on, axes)] = True
        director[on] |= holds_director(support)
        if isinstance(support, Symmetric):
            tilt[on, EDGES[support.edge].normal_axis] = True
        edges[support.edge] = (on, axes)
        if isinstance(support, Curved) and support.curvature != 0.0:
            axis = EDGES[support.edge].along_axis
            along = nodes[on, axis]
            middle = (along.min() + along.max()) / 2.0
            if any(isinstance(other, Symmetric) for other in scene.supports):
                middle = rod_middle(support, scene.supports, scene.sheet)
            turning.append(BentEdge(on, along - middle, axis, support.curvature))
        if isinstance(support, Clamped) and support.tilt != 0.0:
            axis = EDGES[support.edge].normal_axis
            turning.append(TiltedClamp(on, axis, support.tilt * EDGES[support.edge].outward[axis]))
    director |= tilt.all(axis=1)
    return Supports(position, director, tilt, edges, tuple(turning))
