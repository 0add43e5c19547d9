"""An edge moved rigidly, as an actuator of the kind "motion" prescribes it; statics take its last pose.

With the middle of the edge at X_m, displacement u and rotation vector θ, at load factor λ

    φ = X_m + λ u + R(λθ) (X − X_m),    d = R(λθ) e_z,

linearised, as the plate has it, φ = X + u + θ × (X − X_m), d = e_z + θ × e_z. A corner belongs to the motion
and not to a support beside it, which scenes refuse if it contradicts; two motions share its force.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from fem_reference.surface.supports import Supports
from sheetbench.scenes import EdgeMotion, Scene


@dataclass(frozen=True)
class MovedEdge:
    """nodes: (k,); arm: X − X_m (k, 3) [m]; displacement (3,) [m]; rotation (3,) [rad]; part: of the force on
    each node that is this motion's (k,)."""

    nodes: np.ndarray
    arm: np.ndarray
    displacement: np.ndarray
    rotation: np.ndarray
    part: np.ndarray

    def change(self, load_factor: float) -> tuple[np.ndarray, np.ndarray]:
        """Displacement (k, 3) [m] and change of director (k, 3) at a load factor."""
        turn = self.turn(load_factor)
        director = turn.apply([0.0, 0.0, 1.0]) - [0.0, 0.0, 1.0]
        displacement = load_factor * self.displacement + turn.apply(self.arm) - self.arm
        return displacement, np.tile(director, (len(self.nodes), 1))

    def turn(self, load_factor: float) -> Rotation:
        """R at a load factor."""
        return Rotation.from_rotvec(load_factor * self.rotation)

    def small_change(self) -> tuple[np.ndarray, np.ndarray]:
        """The linearised displacement (k, 3) [m] and change of director (3,) at full load."""
        return self.displacement + np.cross(self.rotation, self.arm), np.cross(self.rotation, [0.0, 0.0, 1.0])


def of_scene(scene: Scene, nodes: np.ndarray, on_edge: dict[str, np.ndarray]) -> list[MovedEdge]:
    """The moved edges of a scene; nodes: plan positions (n, 2) [m]; on_edge: edge → the nodes on it."""
    found = []
    moving = [actuator for actuator in scene.actuators if isinstance(actuator, EdgeMotion)]
    movers = np.zeros(len(nodes))
    for actuator in moving:
        movers[on_edge[str(actuator.edge)]] += 1.0
    for actuator in moving:
        on = on_edge[str(actuator.edge)]
        middle = np.mean(scene.sheet.edge_ends(actuator.edge), axis=0)
        arm = np.column_stack([nodes[on] - middle, np.zeros(len(on))])
        displacement, rotation = (
            np.array(values[-1] if values else (0.0, 0.0, 0.0))
            for values in (actuator.displacement, actuator.rotation)
        )
        found.append(MovedEdge(on, arm, displacement, rotation, 1.0 / movers[on]))
    return found


def hold(supports: Supports, scene: Scene, nodes: np.ndarray, on_edge: dict[str, np.ndarray]) -> Supports:
    """The supports with the moved edges held in position and director, and driven."""
    moving = of_scene(scene, nodes, on_edge)
    position, director = supports.position.copy(), supports.director.copy()
    taken = np.concatenate([np.zeros(0, dtype=int), *(motion.nodes for motion in moving)])
    edges = {name: (on[~np.isin(on, taken)], axes) for name, (on, axes) in supports.edges.items()}
    named = (actuator.held_as for actuator in scene.actuators if isinstance(actuator, EdgeMotion))
    for name, motion in zip(named, moving, strict=True):
        position[motion.nodes] = True
        director[motion.nodes] = True
        edges[name] = (motion.nodes, np.arange(3))
    return replace(
        supports, position=position, director=director, edges=edges, driven=(*supports.driven, *moving)
    )


def moved(supports: Supports) -> list[MovedEdge]:
    """The moved edges among what drives the supports, in the order of the scene."""
    return [driver for driver in supports.driven if isinstance(driver, MovedEdge)]
