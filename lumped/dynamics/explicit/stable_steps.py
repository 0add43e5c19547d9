"""Stable steps and damping of a lattice for time loops of other programs, with an acceleration a(x, v) of
each mass, dampers included, at its place and velocity:

    symplectic Euler   v ← v + h a(x, v),  x ← x + h v
    velocity Verlet    w = v + h/2 a(x, v),  x ← x + h w,  v ← w + h/2 a(x, w)

A motion of frequency ω and damping c is multiplied in a step by a 2 × 2 matrix, and stays bounded as long as
|trace| ≤ 1 + det and det ≤ 1 (Jury). The condition must hold for every ω up to the lattice's highest, ω_max,
with its damping: c = α + β ω² for dampers proportional to masses and stiffness, else every c up to the
largest. Undamped both limits are 2/ω_max; large rotations and tension raise ω_max, so a shorter step is
advised. ω_max is the higher frequency of the flat sheet and its equilibrium.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np

from lumped.dynamics.explicit.step_limit import SAFETY, TOUCHING, step_limit
from lumped.dynamics.system import System

Pair = tuple[Any, Any]  # place and velocity
TRIED, MODES = 4000, 64  # numbers of steps and of frequencies that are examined
LATE_TIME = 1e9  # s: every history has its last value


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
    """Stable steps of a lattice. advised: step [s] by loop, `share` of its limit; highest, lowest: [Hz]
    frequencies, the lowest of the flat sheet; exact: whether a step beyond the limit is unstable, which holds
    for proportional dampers without obstacles."""

    advised: dict[str, float]
    highest: float
    lowest: float
    share: float
    exact: bool

    @property
    def critical_rate(self) -> float:
        """Critical damping of the lowest mode by damping proportional to masses [1/s], without the springs'
        dampers."""
        return 4.0 * np.pi * self.lowest

    def as_dict(self) -> dict[str, Any]:
        """Return the steps as a JSON object."""
        steps = {"largest_step": self.advised, "exact": self.exact}
        rate = {"critical_damping_rate": self.critical_rate}
        return {**steps, **rate, "highest_frequency": self.highest, "lowest_frequency": self.lowest}


def stable_steps(system: System, shapes: Iterable[np.ndarray], lowest: float) -> StableSteps:
    """Return the stable steps of a system with the loop's masses; shapes: displacements (size, 3) [m] of the
    motion's extremes; lowest: natural frequency [Hz]."""
    limits = [step_limit(system, u, LATE_TIME) for u in shapes]
    highest = max(limit.frequency for limit in limits)
    resistance = max(2.0 * limit.damping_ratio * limit.frequency for limit in limits)
    proportional, safety = system.damping.proportional, TOUCHING if system.contacts else SAFETY
    rate = system.scene.material.damping_rate if proportional else None
    advised = {name: safety * limit_of(name, highest, resistance, rate) for name in LOOPS}
    exact = proportional and not system.contacts
    return StableSteps(advised, highest / (2.0 * np.pi), lowest, safety, exact)


def limit_of(loop: str, frequency: float, resistance: float = 0.0, rate: float | None = 0.0) -> float:
    """Return the largest step [s] at which a time loop is stable for all frequencies up to `frequency`
    [rad/s]. resistance: damping rate [1/s] at the highest frequency; rate: its mass-proportional part, or
    None if every frequency may have any damping up to `resistance`."""
    shares = np.linspace(0.0, 1.0, MODES + 1)[1:]
    omega, damping = frequency * shares, np.zeros(MODES)
    if rate is not None:
        damping = rate + (resistance - rate) * shares**2
    elif resistance > 0.0:
        omega, damping = (grid.ravel() for grid in np.meshgrid(omega, resistance * shares))
    longest = 4.0 / max(frequency, 0.5 * resistance)
    h = longest * np.linspace(0.0, 1.0, TRIED + 1)[1:, None]

    def acceleration(x: Any, v: Any) -> Any:
        return -(omega**2) * x - damping * v

    (xx, vx), (xv, vv) = (LOOPS[loop](x, v, h, acceleration) for x, v in ((1.0, 0.0), (0.0, 1.0)))
    trace, determinant = xx + vv, xx * vv - xv * vx
    within = (np.abs(trace) <= 1.0 + determinant + 1e-9) & (determinant <= 1.0 + 1e-9)
    stable = within.all(axis=1)
    return float(h[TRIED - 1 if stable.all() else max(int(np.argmin(stable)) - 1, 0), 0])
