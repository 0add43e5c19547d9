"""Commands of actuators, forces between actuators and the sheet, and the prescribed rigid motion of an edge.

A prescribed motion sets the displacement of its masses; the force that holds them follows from the sheet. A
chain has a state of its own: rows of displacement, (rows, 3) [m], to which masses of the edge are bound; the
displacement of bound mass i is binding[i] @ rows. The sheet's equations contain nothing else of the chain;
equal and opposite forces follow, because the transpose of `binding` carries the masses' forces to the chain.
The chain's forces derive from a Lagrangian: multiplier rows enter like any other row, with the constraint's
residual as their force.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lumped.lattice import Lattice
from sheetbench.scenes import EdgeMotion, Sheet
from sheetbench.scenes.meaning.kinematics import MovedEdge


class Drive(NamedTuple):
    """State of the commands: a share of their last value (statics), or their value at a time [s]."""

    load_factor: float = 1.0
    time: float | None = None


@dataclass(frozen=True)
class InterfaceForces:
    """Forces between an actuator and the sheet. positions: (m, 3) [m] of the actuator's masses; on_masses:
    (m, 3) [N] force that holds them; on_rows: (rows, 3) [N] force that holds the actuator's rows, the bound
    masses' force included; y: (rows, 3) [m] displacement of the rows."""

    positions: np.ndarray
    on_masses: np.ndarray
    on_rows: np.ndarray
    y: np.ndarray


class RigidMotion:
    """A prescribed motion of an edge, a single segment: every bound mass moves as on a rigid bar
    (`scenes.meaning.kinematics`). movers: (n,) number of motions that move each mass; they share the force
    on it."""

    def __init__(self, motion: EdgeMotion, name: str, sheet: Sheet, lattice: Lattice, movers: np.ndarray):
        self.names: tuple[str, ...] = (name,)
        self.edge: str = motion.edge
        self.masses = lattice.edge_columns(motion.edge).ravel()
        self._held_as, self._part = motion.held_as, 1.0 / movers[self.masses, None]
        self._moved, rest = MovedEdge(motion, sheet), lattice.positions[self.masses]
        self._plan, self._height = rest[:, :2], rest[:, 2]

    def prescribed_displacement(self, drive: Drive) -> np.ndarray:
        """Return the displacement (m, 3) [m] of the masses."""
        return self._moved.displaced(self._plan, drive.load_factor, drive.time).lifted(self._height)

    def velocity(self, time: float) -> np.ndarray:
        """Return the velocity (m, 3) [m/s] of the masses from a time [s] on."""
        return self._moved.velocity(self._plan, self._height, time)

    def reactions(self, interface: InterfaceForces) -> dict[str, np.ndarray]:
        """Return the force (3,) [N] that imposes the motion, by its name among the reactions."""
        return {self._held_as: (self._part * interface.on_masses).sum(axis=0)}

    def held_moment(self, interface: InterfaceForces, drive: Drive) -> np.ndarray:
        """Return the moment (3,) [N·m] about the origin of the forces that impose the motion."""
        return np.cross(interface.positions, self._part * interface.on_masses).sum(axis=0)

    def wrenches(self, interface: InterfaceForces) -> np.ndarray:
        """Return force and moment about the edge's current middle, (1, 1, 6) [N, N·m]."""
        force = self._part * interface.on_masses
        moment = np.cross(interface.positions - interface.positions.mean(axis=0), force).sum(axis=0)
        return np.concatenate([force.sum(axis=0), moment]).reshape(1, 1, 6)
