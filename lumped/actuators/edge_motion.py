"""A prescribed motion of an edge as an actuator: every bound mass moves as on a rigid bar.

Where the bar is the scene says (`sheetbench.scenes.kinematics`). It has no rows of its own, hence no energy,
mass or constraint; what it exerts on the sheet is what holding the motion takes.
"""

from __future__ import annotations

import numpy as np

from lumped.actuators.actuator import Drive
from lumped.lattice import Lattice
from sheetbench.scenes import EdgeMotion, Sheet
from sheetbench.scenes.kinematics import MovedEdge


class RigidMotion:
    """One prescribed edge motion, as an `Actuator` with a single segment; part: its share (m,) in the force
    on every mass of the edge."""

    rows, multipliers, carried = 0, 0, 0.0
    rest = axis = np.zeros((0, 3))

    def __init__(
        self,
        motion: EdgeMotion,
        name: str,
        sheet: Sheet,
        lattice: Lattice,
        masses: np.ndarray,
        part: np.ndarray,
    ):
        self.names: tuple[str, ...] = (name,)
        self.edge: str = motion.edge
        self._held_as = motion.held_as
        self.masses = masses
        self._edge, self._rest = MovedEdge(motion, sheet), lattice.positions[masses]
        self.free, self.pairs, self.mass = np.ones((0, 3), bool), np.ones((0, 0), bool), np.zeros((0, 0))
        self.binding, self.share = np.zeros((len(masses), 0)), part[None]

    def weight(self, acceleration: np.ndarray) -> np.ndarray:
        """None."""
        return np.zeros((0, 3))

    def driven(self, drive: Drive) -> np.ndarray:
        """The rigid motion at the drive's moment."""
        plan, height = self._rest[:, :2], self._rest[:, 2]
        return self._edge.placed(plan, drive.load_factor, drive.time).lifted(height)

    def velocity(self, time: float) -> np.ndarray:
        """Its velocity (m, 3) [m/s] from a time [s] on."""
        return self._edge.velocity(self._rest[:, :2], self._rest[:, 2], time)

    def force(self, y: np.ndarray, drive: Drive) -> tuple[float, np.ndarray]:
        """None."""
        return 0.0, np.zeros((0, 3))

    def average_force(self, start: np.ndarray, end: np.ndarray, drive: Drive) -> np.ndarray:
        """None."""
        return np.zeros((0, 3))

    def tangent(self, y: np.ndarray, drive: Drive) -> np.ndarray:
        """None."""
        return np.zeros((0, 3, 0, 3))

    def constraint_gradient(self, y: np.ndarray) -> np.ndarray:
        """None."""
        return np.zeros((0, 0, 3))

    def command_force(self, y: np.ndarray, drive: Drive) -> np.ndarray:
        """None: the command moves masses."""
        return np.zeros((0, 3))

    def command_power(self, y: np.ndarray, drive: Drive, later: Drive) -> float:
        """None: the work is the bound masses'."""
        return 0.0

    def damping_force(self, y: np.ndarray, v: np.ndarray) -> tuple[float, np.ndarray]:
        """None."""
        return 0.0, np.zeros((0, 3))

    def damping_tangent(self, y: np.ndarray) -> np.ndarray:
        """None."""
        return np.zeros((0, 3, 0, 3))

    def reactions(self, on_masses: np.ndarray, on_rows: np.ndarray) -> dict[str, np.ndarray]:
        """What holding the motion takes."""
        return {self._held_as: self.share[0] @ on_masses}

    def held_moment(
        self, positions: np.ndarray, on_masses: np.ndarray, on_rows: np.ndarray, y: np.ndarray, drive: Drive
    ) -> np.ndarray:
        """What turning the edge takes."""
        moment: np.ndarray = self.share[0] @ np.cross(positions, on_masses)
        return moment

    def wrenches(self, positions: np.ndarray, on_masses: np.ndarray, y: np.ndarray) -> np.ndarray:
        """Force and moment about the edge's middle, where it is now."""
        force = self.share[0][:, None] * on_masses
        moment = np.cross(positions - positions.mean(axis=0), force).sum(axis=0)
        wrench: np.ndarray = np.concatenate([force.sum(axis=0), moment]).reshape(1, 1, 6)
        return wrench
