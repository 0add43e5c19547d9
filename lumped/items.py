"""What acts on a lattice beside springs, loads and chains: an item brings its own energy, force and tangent.

Problem, System and modes sum over the items of a scene, whatever they are, at rest and in motion; a scene
without any has an empty tuple. Displacements, velocities and forces are (n, 3) [m], [m/s], [N], forces
internal: the gradient of the energy. `Drive` says how far loads and commands are, or when it is.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

import numpy as np

from lumped.actuators import Drive

Placed = tuple[np.ndarray, Drive]  # where the masses are, and when
Since = Placed | None  # where a step begins, of which a mean is returned


class LatticeItem(Protocol):
    """A physics of its own. name: of its part in an answer; moves: whether what it is fixed to does, with its
    place (3,) [m] by how far commands are and velocity (3,) [m/s] at a time [s]; resists: whether it takes
    energy. One that inherits this leaves out what has a default here."""

    name: str
    moves: bool
    place: Callable[[float, float | None], np.ndarray]
    velocity: Callable[[float], np.ndarray]
    resists: bool

    def add_force(self, at: Placed, force: np.ndarray, since: Since = None) -> float:
        """Add the internal force, or with the start of a step the one whose work in it is the energy stored;
        return the energy [J]."""

    def add_tangent(
        self, at: Placed, scale: float, blocks: np.ndarray, definite: bool = False, since: Since = None
    ) -> None:
        """Add scale × the force's derivative to the pattern's blocks (b, 3, 3) [N/m], of a step's mean one
        the symmetric part of that by its end; definite: less what could make it indefinite."""

    def add_resistance(self, at: Placed, v: np.ndarray, force: np.ndarray) -> float:
        """Add what resists the velocity; return the power taken [W]."""
        return 0.0

    def add_resistance_tangent(self, at: Placed, v: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        """Add scale × its derivative by the velocity [N·s/m]."""

    def exerted(self, at: Placed, v: np.ndarray | None = None) -> np.ndarray:
        """Return its forces on the masses (n, 3) [N], at a velocity (n, 3) [m/s] in motion."""
        force = np.zeros_like(at[0])
        self.add_force(at, force)
        if v is not None:
            self.add_resistance(at, v, force)
        return -force

    def stiffest(self, mass: np.ndarray) -> float:
        """Return by how much it may raise a squared frequency ω² [1/s²] at most; mass: (n,) [kg]."""

    def move_freely(self, mass: np.ndarray, squared: float) -> None:
        """Take what stiffness it has in motion, beside springs whose highest frequency has this ω²."""

    def rounding(self, at: Placed) -> float:
        """Return what rounding of displacements leaves of its forces there, as a norm [N]."""
        return 0.0
