"""What actuators exert on the sheet: a rod's line force and couple along the edge, summed by segments.

Nodal forces F of the rod on the sheet are those of a line force q with ∫ N q ds = F, of second order along a
side; couples likewise from the pull on the directors, d × f_d. A segment's share is the force and the moment
about its middle, on the rod's axis, that it exerts on the sheet [N, N·m]. A prescribed motion is one segment,
its moment about the edge's middle; chains that act as one share its forces evenly, as motions share those
of a common corner.
"""

from __future__ import annotations

import numpy as np

from fem_reference.shell.rods import RoddedShell, RodForces, RodState, of_rods, with_rods
from fem_reference.shell.structure import Forces, State
from fem_reference.surface import edge_motion
from fem_reference.surface.biquadratic import THREE, THREE_WEIGHTS, side_shape
from fem_reference.surface.edge_motion import MovedEdge
from fem_reference.surface.rod import Rod
from sheetbench.scenes import EdgeMotion, Scene

_MASS = np.array([[4.0, 2.0, -1.0], [2.0, 16.0, 2.0], [-1.0, 2.0, 4.0]]) / 15.0  # ∫ N N dξ


def wrenches(scene: Scene, structure: RoddedShell, state: State, forces: Forces) -> dict[str, np.ndarray]:
    """Name of an actuator → force and moment (segments, 6) [N, N·m] of its segments on the sheet."""
    found = {}
    for i, rod in enumerate(structure.rods):
        nodal = nodal_force(rod, i, of_rods(state), with_rods(forces))
        director = state.change[1][rod.line] + np.array([0.0, 0.0, 1.0])
        share = by_segment(rod, nodal, _positions(rod, state.change[0]), director) / len(rod.names)
        found.update({name: share for name in rod.names})
    motions = [n for n, a in scene.named_actuators().items() if isinstance(a, EdgeMotion)]
    for name, moved in zip(motions, edge_motion.moved(structure.supports), strict=True):
        found[name] = _of_motion(structure, moved, state, forces)
    return {name: found[name] for name in scene.named_actuators()}


def line_forces(structure: RoddedShell, state: State, forces: Forces) -> np.ndarray:
    """Line force (n, 3) [N/m] of the rods on the sheet at the shell's nodes, zero off their edges."""
    out = np.zeros((structure.count, 3))
    for i, rod in enumerate(structure.rods):
        out[rod.line] += line_force(rod, nodal_force(rod, i, of_rods(state), with_rods(forces)))[0]
    return out


def _of_motion(structure: RoddedShell, moved: MovedEdge, state: State, forces: Forces) -> np.ndarray:
    nodes = moved.nodes
    force, pull = forces.residual[:, nodes] * moved.part[:, None]
    displacement, turn = state.change[:, nodes]
    position = structure.rest_positions[nodes] + displacement
    director = turn + np.array([0.0, 0.0, 1.0])
    middle = 0.5 * (position.min(axis=0) + position.max(axis=0))
    moment = np.cross(position - middle, force) + np.cross(director, pull)
    return np.concatenate([force.sum(axis=0), moment.sum(axis=0)])[None]


def nodal_force(rod: Rod, i: int, state: RodState, forces: RodForces) -> np.ndarray:
    """Force and couple (p, 6) [N, N·m] of rod i on the nodes of its edge."""
    pull = np.zeros((2, len(rod.line), 3))
    np.add.at(pull[0], rod.places, -forces.rod_pull[i][:, :3])
    np.add.at(pull[1], rod.places, -forces.rod_pull[i][:, 3:6])
    if rod.base is not None:  # what holds the base reaches the sheet through the rod
        pull[:, rod.base] += forces.residual[:, rod.line[rod.base]]
    director = state.change[1][rod.line] + np.array([0.0, 0.0, 1.0])
    return np.concatenate([pull[0], np.cross(director, pull[1])], axis=1)


def line_force(rod: Rod, nodal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Line force [N/m] and couple [N·m/m] (p, 3) of forces and couples (p, 6) on the nodes of the edge."""
    count = len(rod.line)
    mass = np.zeros((count, count))
    half = 0.5 * np.linalg.norm(rod.reference[:, 2] - rod.reference[:, 0], axis=1)
    np.add.at(mass, (rod.places[:, :, None], rod.places[:, None, :]), half[:, None, None] * _MASS)
    line = np.linalg.solve(mass, nodal)
    return line[:, :3], line[:, 3:]


def by_segment(rod: Rod, nodal: np.ndarray, position: np.ndarray, director: np.ndarray) -> np.ndarray:
    """Force and moment (segments, 6) [N, N·m] on the sheet, of its nodal ones (p, 6) where the nodes are.

    position, director: φ [m] and d (p, 3) at the nodes of the edge.
    """
    force, couple = line_force(rod, nodal)
    ends = rod.reference[:, [0, 2]]
    low, high = ends.min(axis=(0, 1)), ends.max(axis=(0, 1))
    along = int(np.argmax(high[:2] - low[:2]))
    bounds = np.linspace(low[along], high[along], rod.segments + 1)
    cuts = np.unique(np.concatenate([bounds, ends[:, :, along].ravel()]))  # smooth between
    half = 0.5 * np.diff(cuts)[:, None]
    places = (0.5 * (cuts[1:] + cuts[:-1])[:, None] + half * THREE).ravel()
    weights = (half * THREE_WEIGHTS).ravel()
    segment = np.clip(np.searchsorted(bounds, places) - 1, 0, rod.segments - 1)
    values = _shapes(rod, along, places)
    middle = _shapes(rod, along, 0.5 * (bounds[1:] + bounds[:-1])) @ (position + rod.offset * director)
    moment = np.cross(values @ position - middle[segment], values @ force) + values @ couple
    out = np.zeros((rod.segments, 6))
    np.add.at(out, segment, weights[:, None] * np.concatenate([values @ force, moment], axis=1))
    return out


def _positions(rod: Rod, displacement: np.ndarray) -> np.ndarray:
    """φ (p, 3) at the nodes of the edge."""
    flat = np.zeros((len(rod.line), 3))
    flat[rod.places] = rod.reference[:, :3]
    return flat + displacement[rod.line]


def _shapes(rod: Rod, along: int, places: np.ndarray) -> np.ndarray:
    """Values (n, p) of the shape functions at places (n,) [m] along the edge."""
    nodes = rod.reference[:, :3, along]
    ends = np.sort(nodes[:, [0, 2]], axis=1)
    side = np.argmax(
        (places[:, None] >= ends[:, 0] - 1e-12) & (places[:, None] <= ends[:, 1] + 1e-12), axis=1
    )
    first, last = nodes[side, 0], nodes[side, 2]
    xi = 2.0 * (places - first) / (last - first) - 1.0
    out = np.zeros((len(places), len(rod.line)))
    np.put_along_axis(out, rod.places[side], side_shape(xi)[0], axis=1)
    return out
