"""What supports and moved edges hold in the sheet, as a function of the load factor or of time.

Of every node the position φ = X + u and the director d may be held. Where a bent rod, a tilted clamp or a
motion puts them is the scene's to say (`scenes.meaning.kinematics`); statics take the last pose of a
motion and the last sample of a support that moves. Where two supports share a corner both hold what they
hold. A corner of a moved edge belongs to the motion and not to a support beside it, which scenes refuse if
it contradicts; two motions share its force.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fem_reference.surface.mesh import Plan
from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, Scene, Symmetric, held_axes, holds_director
from sheetbench.scenes.meaning.kinematics import DrivenEdge, MovedEdge, bent_or_tilted
from sheetbench.scenes.objects.shapes import COINCIDENT
from sheetbench.scenes.objects.supports import Point, named, place
from sheetbench.scenes.objects.tables import PiecewiseCurve

ROUNDED = 1e-9  # of a velocity, that slopes on both sides of a moment may differ by


@dataclass(frozen=True)
class Driven:
    """Nodes (k,) of a bent, tilted or moved edge, and their plan positions (k, 2) [m]; part: of the force on
    each node that is a motion's (k,)."""

    nodes: np.ndarray
    points: np.ndarray
    edge: DrivenEdge
    part: np.ndarray


class Moving(NamedTuple):
    """Nodes (k,) and axes that a support moves along its course (`scenes.supports.Motion`)."""

    nodes: np.ndarray
    axes: np.ndarray
    course: PiecewiseCurve


@dataclass(frozen=True)
class Supports:
    """What is held: position (n, 3) by component, director (n,); edges: name → nodes and held axes.

    tilt: (n, 2), whether the director's component along x or y is held at 0, as on a plane of symmetry;
    turning: what bends or tilts edges that are held; moved: what moves edges, by the actuators' names;
    shifts: the supports that move.
    """

    position: np.ndarray
    director: np.ndarray
    tilt: np.ndarray
    edges: dict[str, tuple[np.ndarray, np.ndarray]]
    turning: tuple[Driven, ...]
    moved: dict[str, Driven]
    shifts: tuple[Moving, ...]

    @property
    def driven(self) -> tuple[Driven, ...]:
        """Everything that puts held nodes elsewhere; of what shares a corner the last counts there."""
        return (*self.turning, *self.moved.values())

    def change(self, load_factor: float, time: float | None = None) -> np.ndarray:
        """Prescribed change (2, n, 3) of positions [m] and directors; zero where nothing moves them. time
        [s]: of motions, their last samples where None."""
        out = np.zeros((2, len(self.director), 3))
        for driven in self.driven:
            placed = driven.edge.placed(driven.points, load_factor, time)
            out[0, driven.nodes], out[1, driven.nodes] = placed.displacement, placed.director
        if self.shifts:
            out[0] += (load_factor if time is None else 1.0) * self.shift(time)
        return out

    def shift(self, time: float | None = None) -> np.ndarray:
        """Where supports that move are at a time [s], or in the end (n, 3) [m]."""
        return self._shifted(lambda course: course.at(time))

    def rate(self, time: float) -> np.ndarray:
        """Rate (2, n, 3) of that change from a time [s] on."""
        out = np.zeros((2, len(self.director), 3))
        out[0] = self._shifted(lambda course: course.slope(time))
        for moved in self.moved.values():
            assert isinstance(moved.edge, MovedEdge)
            count = len(moved.points)
            low, high = (moved.edge.velocity(moved.points, np.full(count, at), time) for at in (0.0, 1.0))
            out[0, moved.nodes], out[1, moved.nodes] = low, high - low
        return out

    def jumps(self, time: float) -> bool:
        """Whether a support changes its velocity at once."""
        slopes = [(course.slope(time), course.slope(time, before=True)) for _, _, course in self.shifts]
        return any(np.abs(a - b).max() > ROUNDED * np.abs([a, b]).max() for a, b in slopes)

    def _shifted(self, of: Callable[[PiecewiseCurve], np.ndarray]) -> np.ndarray:
        """Values of the supports' courses (3,), at their nodes and along their axes (n, 3)."""
        out = np.zeros((len(self.director), 3))
        for nodes, axes, course in self.shifts:
            out[np.ix_(nodes, axes)] = of(course)[axes]
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


def _node_at(nodes: np.ndarray, support: Point, name: str) -> np.ndarray:
    """The node (1,) at a point. Raises BadInput where a mesh has none, as one of the caller's own."""
    far = np.linalg.norm(nodes - np.array(support.at), axis=1)
    if far.min() > 1e3 * COINCIDENT * np.ptp(nodes, axis=0).max():
        raise BadInput(f"{name}.at = {list(support.at)}: no node of the mesh is there")
    return np.array([int(np.argmin(far))])


def of_scene(scene: Scene, plan: Plan) -> Supports:
    """The supports and moved edges of a scene on the nodes of a plan."""
    nodes = plan.nodes
    named_supports = named(scene.supports)
    on_edge = {str(on.edge): plan.on_boundary(on.edge) for on in scene.actuators}
    for name, support in named_supports.items():
        if isinstance(support, Point):
            on_edge[name] = _node_at(nodes, support, name)
        elif (shape := place(support)) is not None:
            on_edge[name] = np.unique(plan.elements[plan.within(shape)])
        else:
            on_edge[name] = plan.on_boundary(support.edge)
    position, director = np.zeros((len(nodes), 3), dtype=bool), np.zeros(len(nodes), dtype=bool)
    tilt = np.zeros((len(nodes), 2), dtype=bool)
    edges: dict[str, tuple[np.ndarray, np.ndarray]] = {}
    motions = scene.motions()
    movers = np.zeros(len(nodes))
    for motion in motions.values():
        on = on_edge[motion.edge]
        position[on] = director[on] = True
        movers[on] += 1.0
    for name, support in named_supports.items():
        on, axes = on_edge[name], np.array(held_axes(support))
        position[np.ix_(on, axes)] = True
        director[on] |= holds_director(support)
        if isinstance(support, Symmetric):
            tilt[on, EDGES[support.edge].normal_axis] = True
        edges[name] = (on[movers[on] == 0.0], axes)
    edges |= {motion.held_as: (on_edge[motion.edge], np.arange(3)) for motion in motions.values()}

    def driven(edge: DrivenEdge) -> Driven:
        on = on_edge[edge.edge]
        return Driven(on, nodes[on], edge, 1.0 / np.maximum(movers[on], 1.0))

    turning = tuple(driven(edge) for edge in bent_or_tilted(scene.supports, scene.sheet))
    moved = {name: driven(MovedEdge(motion, scene.sheet)) for name, motion in motions.items()}
    director |= tilt.all(axis=1)
    shifts = tuple(
        Moving(edges[name][0], edges[name][1], support.motion.course)
        for name, support in named_supports.items()
        if support.motion is not None
    )
    return Supports(position, director, tilt, edges, turning, moved, shifts)
