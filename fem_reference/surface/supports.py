"""Positions and directors held by supports and moved edges, by the load factor or time.

The position φ = X + u and the director d of every node may be held. `scenes.meaning.kinematics` gives their
values at a bent rod, a tilted clamp or a motion; statics take the last pose of a motion and the last sample
of a support that moves. Two supports at a common corner act together. A corner of a moved edge belongs to the
motion and not to a support beside it, which scenes refuse if it contradicts; two motions share its force.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fem_reference.surface.mesh import Plan
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, held_axes, holds_director, tilt_axes
from sheetbench.scenes.meaning.kinematics import DrivenEdge, MovedEdge, bent_or_tilted
from sheetbench.scenes.objects.shapes import COINCIDENT
from sheetbench.scenes.objects.supports import Point, named, place
from sheetbench.scenes.objects.tables import PiecewiseCurve

ROUNDED = 1e-9  # relative difference of slopes before and after a moment that counts as rounding


@dataclass(frozen=True)
class PrescribedEdge:
    """Nodes (k,) of a bent, tilted or moved edge, and their plan positions (k, 2) [m]. part: share of the
    force on each node that belongs to the edge (k,)."""

    nodes: np.ndarray
    points: np.ndarray
    edge: DrivenEdge
    part: np.ndarray


@dataclass(frozen=True)
class Supports:
    """Components held by supports. edges: name → components of the position (n, 3); director (n,). tilt: (n,
    2), whether the director's component along x or y is held at 0, as on a plane of symmetry; turning: held
    edges that are bent or tilted; moved: moved edges, by the actuators' names; shifts: the courses of the
    supports that move (`scenes.supports.Motion`), by name."""

    edges: dict[str, np.ndarray]
    director: np.ndarray
    tilt: np.ndarray
    turning: tuple[PrescribedEdge, ...]
    moved: dict[str, PrescribedEdge]
    shifts: dict[str, PiecewiseCurve]

    @cached_property
    def position(self) -> np.ndarray:
        """Components of the position held by any support (n, 3)."""
        return sum(self.edges.values(), np.zeros((len(self.director), 3), dtype=bool))

    @property
    def driven(self) -> tuple[PrescribedEdge, ...]:
        """All edges with prescribed places; at a common corner the last one counts."""
        return (*self.turning, *self.moved.values())

    def change(self, load_factor: float, time: float | None = None) -> np.ndarray:
        """Return the prescribed change (2, n, 3) of positions [m] and directors, zero elsewhere. time [s]: of
        motions, their last samples where None."""
        out = np.zeros((2, len(self.director), 3))
        for driven in self.driven:
            displaced = driven.edge.displaced(driven.points, load_factor, time)
            out[0, driven.nodes], out[1, driven.nodes] = displaced.displacement, displaced.director
        if self.shifts:
            out[0] += (load_factor if time is None else 1.0) * self.shift(time)
        return out

    def shift(self, time: float | None = None) -> np.ndarray:
        """Return the displacement (n, 3) [m] of moving supports at a time [s], or at the end."""
        return self._shifted(lambda course: course.at(time))

    def rate(self, time: float) -> np.ndarray:
        """Return the rate (2, n, 3) of `change` from a time [s] on."""
        out = np.zeros((2, len(self.director), 3))
        out[0] = self._shifted(lambda course: course.slope(time))
        for moved in self.moved.values():
            assert isinstance(moved.edge, MovedEdge)
            count = len(moved.points)
            low, high = (moved.edge.velocity(moved.points, np.full(count, at), time) for at in (0.0, 1.0))
            out[0, moved.nodes], out[1, moved.nodes] = low, high - low
        return out

    def jumps(self, time: float) -> bool:
        """Return whether a support's velocity jumps at a time [s]."""
        slopes = [(course.slope(time), course.slope(time, before=True)) for course in self.shifts.values()]
        return any(np.abs(a - b).max() > ROUNDED * np.abs([a, b]).max() for a, b in slopes)

    def _shifted(self, of: Callable[[PiecewiseCurve], np.ndarray]) -> np.ndarray:
        """Return values of the supports' courses (3,), on the nodes and components that they hold (n, 3)."""
        out = np.zeros((len(self.director), 3))
        for name, course in self.shifts.items():
            np.copyto(out, of(course), where=self.edges[name])
        return out

    def reactions(self, nodal: np.ndarray) -> dict[str, np.ndarray]:
        """Return the force [N] (3,) of each support from nodal forces (n, 3), shared between supports."""
        shared = nodal / np.maximum(sum(self.edges.values()), 1)
        return {name: np.sum(shared, axis=0, where=held) for name, held in self.edges.items()}


def _node_at(nodes: np.ndarray, support: Point, name: str) -> np.ndarray:
    """Return the node (1,) at a point. Raises BadInput where the mesh, as a caller's own, has none."""
    far = np.linalg.norm(nodes - np.array(support.at), axis=1)
    if far.min() > 1e3 * COINCIDENT * np.ptp(nodes, axis=0).max():
        raise BadInput(f"{name}.at = {list(support.at)}: no node of the mesh is there")
    return np.array([int(np.argmin(far))])


def of_scene(scene: Scene, plan: Plan) -> Supports:
    """Return the supports and moved edges of a scene on the nodes of a plan."""
    nodes = plan.nodes
    named_supports = named(scene.supports)
    on_edge = {str(on.edge): plan.on_boundary(on.edge) for on in scene.actuators}
    for name, support in named_supports.items():
        if isinstance(support, Point):
            on_edge[name] = _node_at(nodes, support, name)
        elif (shape := place(support)) is not None:
            on_edge[name] = plan.touching(shape)
        else:
            on_edge[name] = plan.on_boundary(support.edge)
    motions, movers = scene.motions(), np.zeros(len(nodes))
    for motion in motions.values():
        movers[on_edge[motion.edge]] += 1.0
    director, tilt, edges = movers > 0.0, np.zeros((len(nodes), 2), dtype=bool), dict[str, np.ndarray]()
    for name, support in named_supports.items():
        on, edges[name] = on_edge[name], np.zeros((len(nodes), 3), dtype=bool)
        edges[name][np.ix_(on[movers[on] == 0.0], held_axes(support))] = True
        if holds_director(support):
            director[on] = True
        elif axes := tilt_axes(support):
            tilt[on, axes[0]] = True
    for motion in motions.values():
        edges[motion.held_as] = np.zeros((len(nodes), 3), dtype=bool)
        edges[motion.held_as][on_edge[motion.edge]] = True

    def driven(edge: DrivenEdge) -> PrescribedEdge:
        on = on_edge[edge.edge]
        return PrescribedEdge(on, nodes[on], edge, 1.0 / np.maximum(movers[on], 1.0))

    turning = tuple(driven(edge) for edge in bent_or_tilted(scene.supports, scene.sheet))
    moved = {name: driven(MovedEdge(motion, scene.sheet)) for name, motion in motions.items()}
    director |= tilt.all(axis=1)
    shifts = {name: held.motion.course for name, held in named_supports.items() if held.motion is not None}
    return Supports(edges, director, tilt, turning, moved, shifts)
