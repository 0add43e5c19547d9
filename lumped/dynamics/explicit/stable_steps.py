"""Steps and damping for a user's own loop over the masses of a lattice.

The acceleration at a place and a velocity, dampers included, is a(x, v):

    symplectic Euler   v ← v + h a(x, v),  x ← x + h v
    velocity Verlet    w = v + h/2 a(x, v),  x ← x + h w,  v ← w + h/2 a(x, w)

A motion of frequency ω and damping c is multiplied in a step by a matrix of two rows, and stays as long as
|trace| ≤ 1 + det and det ≤ 1 (Jury). These hold for every ω up to the lattice's highest, ω_max, with its
damping: c = α + β ω² where dampers are in proportion to masses and stiffness, else every c up to the largest.
Undamped both limits are 2/ω_max; large rotations and tension raise ω_max, so less is advised. ω_max is the
higher one of the flat sheet and of its equilibrium.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from lumped.dynamics.explicit.step_limit import SAFETY, TOUCHING, step_limit
from lumped.dynamics.system import System

Pair = tuple[Any, Any]  # place and velocity
TRIED, MODES = 4000, 64  # steps up to one that is unstable; frequencies up to the highest
FOREVER = 1e9  # s, when every history has its last value


def symplectic_euler(x: Any, v: Any, h: Any, acceleration: Callable[[Any, Any], Any]) -> Pair:
    """Return place and velocity a step of h later."""
    v = v + h * acceleration(x, v)
    return x + h * v, v


def velocity_verlet(x: Any, v: Any, h: Any, acceleration: Callable[[Any, Any], Any]) -> Pair:
    """Return place and velocity a step of h later."""
    w = v + 0.5 * h * acceleration(x, v)
    x = x + h * w
    return x, w + 0.5 * h * acceleration(x, w)


LOOPS = {"symplectic_euler": symplectic_euler, "velocity_verlet": velocity_verlet}


@dataclass(frozen=True)
class StableSteps:
    """advised: step [s] by loop, this share of its limit; frequencies [Hz]: the highest, and the lowest of
    the flat sheet; exact: whether a somewhat longer step is unstable, as where dampers are in proportion and
    nothing is touched."""

    advised: dict[str, float]
    highest: float
    lowest: float
    share: float
    exact: bool

    @property
    def critical_rate(self) -> float:
        """Damping in proportion to masses [1/s] at which the lowest mode just does not swing, without the
        springs' dampers."""
        return 4.0 * np.pi * self.lowest

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        own = {"largest_step": self.advised, "exact": self.exact, "critical_damping_rate": self.critical_rate}
        return {**own, "highest_frequency": self.highest, "lowest_frequency": self.lowest}


def stable_steps(system: System, shapes: Iterable[np.ndarray], lowest: float) -> StableSteps:
    """Return the steps of a system with the masses of the loop; shapes: displacements (size, 3) [m] between
    which it moves; lowest: natural frequency [Hz]."""
    limits = [step_limit(system, u, FOREVER) for u in shapes]
    highest = max(limit.frequency for limit in limits)
    resistance = max(2.0 * limit.damping_ratio * limit.frequency for limit in limits)
    proportional, safety = system.damping.proportional, TOUCHING if system.items else SAFETY
    rate = system.scene.material.damping_rate if proportional else None
    advised = {name: safety * limit_of(name, highest, resistance, rate) for name in LOOPS}
    exact = proportional and not system.items
    return StableSteps(advised, highest / (2.0 * np.pi), lowest, safety, exact)


def limit_of(loop: str, frequency: float, resistance: float = 0.0, rate: float | None = 0.0) -> float:
    """Return the largest stable step [s] of a loop for frequencies up to one [rad/s]; resistance: damping at
    the highest [1/s], of which `rate` in proportion to masses, or None for damping that may go with any of
    them."""
    shares = np.linspace(0.0, 1.0, MODES + 1)[1:]
    omega, damping = frequency * shares, np.zeros(MODES)
    if rate is not None:
        damping = rate + (resistance - rate) * shares**2
    elif resistance > 0.0:
        omega, damping = (each.ravel() for each in np.meshgrid(omega, resistance * shares))
    longest = 4.0 / max(frequency, 0.5 * resistance)
    h = longest * np.linspace(0.0, 1.0, TRIED + 1)[1:, None]

    def acceleration(x: Any, v: Any) -> Any:
        return -(omega**2) * x - damping * v

    (xx, vx), (xv, vv) = (LOOPS[loop](x, v, h, acceleration) for x, v in ((1.0, 0.0), (0.0, 1.0)))
    trace, determinant = xx + vv, xx * vv - xv * vx
    within = (np.abs(trace) <= 1.0 + determinant + 1e-9) & (determinant <= 1.0 + 1e-9)
    stable = within.all(axis=1)
    return float(h[TRIED - 1 if stable.all() else max(int(np.argmin(stable)) - 1, 0), 0])
