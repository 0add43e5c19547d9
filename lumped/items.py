"""What acts on a lattice beside springs, loads and chains: an item brings its own energy, force and tangent.

Problem, System and modes sum over the items of a scene, whatever they are, at rest and in motion; a scene
without any has an empty tuple. Displacements, velocities and forces are (n, 3) [m], [m/s], [N], forces
internal: the gradient of the energy. `Drive` says how far loads and commands are, or when it is.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from lumped.actuators import Drive
from sheetbench.answers.contact import ContactState


class LatticeItem(Protocol):
    """A physics of its own. name: of its part in an answer; moves: whether what it is fixed to does;
    resists: whether it takes energy. One that inherits this leaves out what has a default here."""

    name: str
    moves: bool

    @property
    def resists(self) -> bool:
        return False

    def add_force(self, u: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add the internal force; return the energy [J]."""

    def add_tangent(
        self, u: np.ndarray, drive: Drive, scale: float, blocks: np.ndarray, definite: bool = False
    ) -> None:
        """Add scale × the force's derivative to the pattern's blocks (b, 3, 3) [N/m]; definite: less what
        could make it indefinite."""

    def add_average_force(
        self, start: np.ndarray, end: np.ndarray, drives: tuple[Drive, Drive], force: np.ndarray
    ) -> None:
        """Add the force whose work from start to end is the energy stored."""

    def add_average_tangent(
        self, start: np.ndarray, end: np.ndarray, drives: tuple[Drive, Drive], blocks: np.ndarray
    ) -> None:
        """Add its derivative by `end`, the symmetric part of it."""

    def add_resistance(self, u: np.ndarray, v: np.ndarray, drive: Drive, force: np.ndarray) -> float:
        """Add what resists the velocity; return the power taken [W]."""
        return 0.0

    def add_resistance_tangent(
        self, u: np.ndarray, v: np.ndarray, drive: Drive, scale: float, blocks: np.ndarray
    ) -> None:
        """Add scale × its derivative by the velocity [N·s/m]."""

    def work(self, force: np.ndarray, start: float, end: float) -> float:
        """Return the work [J] that a force (3,) of what it is fixed to does on the sheet between two times
        [s]."""
        return 0.0

    def power(self, force: np.ndarray, time: float) -> float:
        """Return its power [W] at a time [s]."""
        return 0.0

    def exerted(self, u: np.ndarray, drive: Drive, v: np.ndarray | None = None) -> np.ndarray:
        """Return its forces on the masses (n, 3) [N], at a velocity (n, 3) [m/s] in motion."""
        force = np.zeros_like(u)
        self.add_force(u, drive, force)
        if v is not None:
            self.add_resistance(u, v, drive, force)
        return -force

    def step_share(self, u: np.ndarray, move: np.ndarray, drive: Drive, since: Drive | None = None) -> float:
        """Return the share of a move up to which what the item says holds, 1 for all of it; since: where
        what it is fixed to is as the move begins."""
        return 1.0

    def stiffest(self, mass: np.ndarray) -> float:
        """Return by how much it may raise a squared frequency ω² [1/s²] at most; mass: (n,) [kg]."""

    def move_freely(self, mass: np.ndarray, squared: float) -> None:
        """Take what stiffness it has in motion, beside springs whose highest frequency has this ω²."""

    def rounding(self) -> float:
        """Return what rounding of displacements leaves of its forces, as a norm [N]."""
        return 0.0

    def report(self, u: np.ndarray, drive: Drive) -> ContactState:
        """Return what there is to say of it at an equilibrium or a sample."""
        return ContactState(0.0, 0.0, 0, 0)
