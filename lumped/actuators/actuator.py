"""What drives actuators, what acts between them and the sheet, and the simplest one, an edge's motion.

A prescribed motion puts masses where they have to be, and what holds them there is found from the sheet. A
chain has a state of its own. It brings rows of displacement, (rows, 3) [m], which only it understands, and
binds masses of the edge to them: the displacement of bound mass i is binding[i] @ rows. The sheet's equations
never see more; equal and opposite forces follow, because one transpose of `binding` carries the masses'
forces to the chain. Its forces derive from a Lagrangian: multiplier rows enter like any other row, with the
constraint's residual as their force.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from lumped.lattice import Lattice
from sheetbench.scenes import EdgeMotion, Sheet
from sheetbench.scenes.meaning.kinematics import MovedEdge


class Drive(NamedTuple):
    """How far commands are: a share of their last value (statics), or, with a time [s], their value then."""

    load_factor: float = 1.0
    time: float | None = None


@dataclass(frozen=True)
class Acting:
    """What acts between an actuator and the sheet: where its masses are (m, 3) [m], what holds them (m, 3)
    and its rows with these, as they bind them, (rows, 3) [N], and its rows' displacement y (rows, 3) [m]."""

    positions: np.ndarray
    on_masses: np.ndarray
    on_rows: np.ndarray
    y: np.ndarray


class RigidMotion:
    """A prescribed motion of an edge, a single segment: every bound mass moves as on a rigid bar, where the
    scene says (`scenes.meaning.kinematics`); movers: how many motions move each mass (n,), which share the
    force on it."""

    def __init__(self, motion: EdgeMotion, name: str, sheet: Sheet, lattice: Lattice, movers: np.ndarray):
        self.names: tuple[str, ...] = (name,)
        self.edge: str = motion.edge
        self.masses = lattice.edge_columns(motion.edge).ravel()
        self._held_as, self._part = motion.held_as, 1.0 / movers[self.masses, None]
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
