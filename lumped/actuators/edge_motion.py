"""A prescribed motion of an edge as an actuator: every bound mass moves as on a rigid bar.

Where the bar is the scene says (`scenes.meaning.kinematics`). What it exerts on the sheet is what holding
the motion takes.
"""

from __future__ import annotations

import numpy as np

from lumped.actuators.actuator import Acting, Drive
from lumped.lattice import Lattice
from sheetbench.scenes import EdgeMotion, Sheet
from sheetbench.scenes.meaning.kinematics import MovedEdge


class RigidMotion:
    """One prescribed edge motion, with a single segment; part: its share (m,) in the force
    on every mass of the edge."""

    def __init__(self, motion: EdgeMotion, name: str, sheet: Sheet, lattice: Lattice, part: np.ndarray):
        self.names: tuple[str, ...] = (name,)
        self.edge: str = motion.edge
        self.masses = lattice.edge_columns(motion.edge).ravel()
        self._held_as, self._part = motion.held_as, part[:, None]
        self._moved, rest = MovedEdge(motion, sheet), lattice.positions[self.masses]
        self._plan, self._height = rest[:, :2], rest[:, 2]

    def driven(self, drive: Drive) -> np.ndarray:
        """Displacement (m, 3) [m] of the masses."""
        return self._moved.placed(self._plan, drive.load_factor, drive.time).lifted(self._height)

    def velocity(self, time: float) -> np.ndarray:
        """Velocity (m, 3) [m/s] of the masses from a time [s] on."""
        return self._moved.velocity(self._plan, self._height, time)

    def reactions(self, acting: Acting) -> dict[str, np.ndarray]:
        """What holding the motion takes."""
        return {self._held_as: (self._part * acting.on_masses).sum(axis=0)}

    def held_moment(self, acting: Acting, drive: Drive) -> np.ndarray:
        """What turning the edge takes."""
        moment: np.ndarray = np.cross(acting.positions, self._part * acting.on_masses).sum(axis=0)
        return moment

    def wrenches(self, acting: Acting) -> np.ndarray:
        """Force and moment about the edge's middle, where it is now."""
        force = self._part * acting.on_masses
        moment = np.cross(acting.positions - acting.positions.mean(axis=0), force).sum(axis=0)
        return np.concatenate([force.sum(axis=0), moment]).reshape(1, 1, 6)
