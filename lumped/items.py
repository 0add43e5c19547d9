"""Items: physics of a lattice in addition to springs, loads and chains, each with energy, force and tangent.

Problem, System and modes sum over the items of a scene, at rest and in motion; a scene without any has an
empty tuple. Displacements, velocities and forces are (n, 3) [m], [m/s], [N]; forces are internal, the
gradient of the energy. `Drive` is the load factor or the time.
"""

from collections.abc import Callable
from typing import Protocol

import numpy as np

from lumped.actuators import Drive

Deformed = tuple[np.ndarray, Drive]  # displacement of the masses, and load factor or time
Since = Deformed | None  # start of the step over which a mean is returned


class LatticeItem(Protocol):
    """An item of a lattice. name: of its part in an answer; moves: whether the body that it is fixed to
    moves; place: (3,) [m] of the body by load factor and time [s]; velocity: (3,) [m/s] of the body at a time
    [s]; resists: whether it dissipates energy. Methods with a body are defaults."""

    name: str
    moves: bool
    place: Callable[[float, float | None], np.ndarray]
    velocity: Callable[[float], np.ndarray]
    resists: bool

    def add_force(self, at: Deformed, force: np.ndarray, since: Since = None) -> float:
        """Add the internal force, or, given the start of a step, the mean force whose work in the step is the
        energy's change; return the energy [J]."""

    def add_tangent(
        self, at: Deformed, scale: float, blocks: np.ndarray, definite: bool = False, since: Since = None
    ) -> None:
        """Add scale × the force's derivative to the pattern's blocks (b, 3, 3) [N/m]; for the mean force of a
        step the symmetric part of the derivative by the displacement at the step's end. definite: leave out
        parts that could make the tangent indefinite."""

    def add_resistance(self, at: Deformed, v: np.ndarray, force: np.ndarray) -> float:
        """Add the force that resists the velocity; return the power taken [W]."""
        return 0.0

    def add_resistance_tangent(self, at: Deformed, v: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        """Add scale × the derivative of the resisting force by the velocity [N·s/m]."""

    def exerted(self, at: Deformed, v: np.ndarray | None = None) -> np.ndarray:
        """Return the item's forces on the masses (n, 3) [N]; v: velocity (n, 3) [m/s] in motion."""
        force = np.zeros_like(at[0])
        self.add_force(at, force)
        if v is not None:
            self.add_resistance(at, v, force)
        return -force

    def stiffest(self, mass: np.ndarray) -> float:
        """Return a bound of the increase of squared frequencies ω² [1/s²] by the item; mass: (n,) [kg]."""

    def move_freely(self, mass: np.ndarray, squared: float) -> None:
        """Set the item's stiffness in motion, relative to the springs' highest squared frequency [1/s²]."""

    def rounding(self, at: Deformed) -> float:
        """Return the norm [N] of the error of its forces by rounding of displacements."""
        return 0.0
