"""Forces of actuators on the sheet: a rod's line force and couple along the edge, summed by segments.

The line force q is quadratic along a side, with ∫ N q ds = F for the nodal forces F of the rod on the sheet;
couples follow in this way from the pull on the directors, d × f_d. A segment's share is its force and its
moment about the segment's middle, on the rod's axis, on the sheet [N, N·m]. A prescribed motion is one
segment, its moment about the edge's middle; chains that act as one share its forces evenly, as motions share
the forces of a common corner.
"""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from fem_reference.surface.biquadratic import SIDE_MASS, THREE, THREE_WEIGHTS, side_shape
from fem_reference.surface.rod import Rod
from fem_reference.surface.supports import PrescribedEdge
from sheetbench.scenes import Scene


class RodOnEdge(NamedTuple):
    """Force and couple (p, 6) [N, N·m] of a rod on its edge's nodes, with their positions φ (p, 3) [m] and
    directors d (p, 3)."""

    rod: Rod
    nodal: np.ndarray
    position: np.ndarray
    director: np.ndarray


class HoldingForces(NamedTuple):
    """Force and couple (n, 6) [N, N·m] that hold the sheet at its nodes, and their positions (n, 3) [m]."""

    nodal: np.ndarray
    position: np.ndarray


def exerted(
    scene: Scene, edges: Iterable[RodOnEdge], moved: dict[str, PrescribedEdge], held: HoldingForces
) -> tuple[dict[str, np.ndarray], np.ndarray]:
    """Return each actuator's wrench on the sheet, and the rods' line force (n, 3) [N/m], zero off their
    edges. A wrench is the force and moment (segments, 6) [N, N·m] of its segments, by the actuator's name."""
    wrenches, line = {}, np.zeros_like(held.position)
    for rod, nodal, position, director in edges:
        if rod.base is not None:  # the base's holding force reaches the sheet through the rod
            nodal[rod.base] += held.nodal[rod.line[rod.base]]
        share = by_segment(rod, nodal, position, director) / len(rod.chains)
        wrenches.update(dict.fromkeys(rod.chains, share))
        line[rod.line] += line_force(rod, nodal)[0]
    wrenches |= {name: _of_motion(motion, held) for name, motion in moved.items()}
    return {name: wrenches[name] for name in scene.named_actuators()}, line


def _of_motion(moved: PrescribedEdge, held: HoldingForces) -> np.ndarray:
    """Return force and moment about the edge's middle, (1, 6)."""
    nodal, position = moved.part[:, None] * held.nodal[moved.nodes], held.position[moved.nodes]
    arm = position - 0.5 * (position.min(axis=0) + position.max(axis=0))
    moment = np.cross(arm, nodal[:, :3]) + nodal[:, 3:]
    return np.concatenate([nodal[:, :3].sum(axis=0), moment.sum(axis=0)])[None]


def line_force(rod: Rod, nodal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return line force [N/m] and couple [N·m/m] (p, 3) from nodal forces and couples (p, 6) of the edge."""
    count = len(rod.line)
    mass = np.zeros((count, count))
    half = 0.5 * np.linalg.norm(rod.elements.reference[:, 2] - rod.elements.reference[:, 0], axis=1)
    np.add.at(mass, (rod.places[:, :, None], rod.places[:, None, :]), half[:, None, None] * SIDE_MASS)
    line = np.linalg.solve(mass, nodal)
    return line[:, :3], line[:, 3:]


def by_segment(rod: Rod, nodal: np.ndarray, position: np.ndarray, director: np.ndarray) -> np.ndarray:
    """Return force and moment (segments, 6) [N, N·m] on the sheet, from nodal ones (p, 6). position,
    director: φ [m] and d (p, 3) at the nodes of the edge."""
    force, couple = line_force(rod, nodal)
    points, segments = np.empty((len(rod.line), 2)), rod.chain.segments
    points[rod.places] = rod.elements.reference[:, :3, :2]
    along = points[:, np.argmax(np.ptp(points, axis=0))]
    bounds = np.linspace(along[0], along[-1], segments + 1)
    cuts = np.unique(np.concatenate([bounds, along[::2]]))  # smooth between
    half = 0.5 * np.diff(cuts)[:, None]
    places = (0.5 * (cuts[1:] + cuts[:-1])[:, None] + half * THREE).ravel()
    weights = (half * THREE_WEIGHTS).ravel()
    segment = np.clip(np.searchsorted(bounds, places) - 1, 0, segments - 1)
    values = _shapes(along, places)
    middle = _shapes(along, 0.5 * (bounds[1:] + bounds[:-1])) @ (position + rod.offset * director)
    moment = np.cross(values @ position - middle[segment], values @ force) + values @ couple
    out = np.zeros((segments, 6))
    np.add.at(out, segment, weights[:, None] * np.concatenate([values @ force, moment], axis=1))
    return out


def _shapes(nodes: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Return values (n, p) at places (n,) [m] of the shape functions of sides whose nodes (p,) [m] rise."""
    first = 2 * np.clip(np.searchsorted(nodes[::2], places) - 1, 0, len(nodes) // 2 - 1)
    xi = 2.0 * (places - nodes[first]) / (nodes[first + 2] - nodes[first]) - 1.0
    out = np.zeros((len(places), len(nodes)))
    np.put_along_axis(out, first[:, None] + np.arange(3), side_shape(xi)[0], axis=1)
    return out
