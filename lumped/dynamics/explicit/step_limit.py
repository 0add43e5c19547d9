"""The highest frequency of a lattice, and the largest stable step of explicit integration.

ω_max² is the largest eigenvalue of M⁻¹K on the free motions, by Lanczos, c_max the largest eigenvalue of
M⁻¹C, and ξ = c_max/2ω_max. A motion of frequency ω and damping c = 2 ξ ω is multiplied in a step of velocity
Verlet, with two evaluations of the dampers, by the matrix of

    det = 1 − z + z²/2 − xz/4,   trace = 2 − x − z + z²/2 + xz/4,   x = (ω h)²,  z = c h.

Both its eigenvalues stay within the unit circle as long as |trace| ≤ 1 + det and det ≤ 1 (Jury), that is

    z ≤ 2  and  x ≤ 4 − 2z + z²:   h ≤ (2/ω_max)/(ξ + √(1 − 3ξ²)) for ξ < 1/2,  (1/ω_max)/ξ beyond.

The undamped limit is 2/ω_max, and a damped one is never below (2/ω_max)(√(1 + ξ²) − ξ), the limit of central
differences with the velocity half a step old (Belytschko, Liu and Moran 2000, section 6.2). For damping
proportional to stiffness and mass the slower motions lie within the limit when the fastest does, and the
limit is exact. For other damping every x up to (ω_max h)² may occur with every z up to c_max h: then the
smallest x of the boundary counts, which is 3 from z = 1 on.
"""

import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from lumped.dynamics.system import System

SAFETY, TOUCHING = 0.9, 0.8  # advised share of the limit, without and with obstacles (`lumped.contact`)


@dataclass(frozen=True)
class StepLimit:
    """Limit of stability. frequency: ω_max [rad/s]; damping_ratio: ξ at ω_max; step: the largest stable one
    [s]; exact: whether it is exact; safety: share of it that is advised."""

    frequency: float
    damping_ratio: float
    step: float
    exact: bool = True
    safety: float = SAFETY

    @property
    def advised(self) -> float:
        """Advised step [s], shorter than the limit since large rotations and tension raise ω_max a little."""
        return self.safety * self.step

    @property
    def share(self) -> float:
        """Ratio of the step to the undamped limit."""
        return 0.5 * self.frequency * self.step

    def describe(self) -> str:
        """Return the limit and its origin as text."""
        turn = self.frequency * self.step
        law = "2/ω_max" if self.damping_ratio == 0.0 else f"{turn:.3g}/ω_max"
        highest = f"ω_max = {self.frequency:.4g} rad/s and ξ = {self.damping_ratio:.3g}"
        return f"{self.step:.4g} s = {law} with {highest}"


def turn_limit(ratio: float, exact: bool = True) -> float:
    """Return ω_max h at the limit for a damping ratio ξ at ω_max; exact: for damping proportional to
    stiffness and mass, else for any damping."""
    if not exact and ratio > 0.5 / math.sqrt(3.0):
        return min(math.sqrt(3.0), 1.0 / ratio)
    return 2.0 / (ratio + math.sqrt(1.0 - 3.0 * ratio**2)) if ratio < 0.5 else 1.0 / ratio


def step_limit(system: System, u: np.ndarray, time: float = 0.0) -> StepLimit:
    """Return the stability limit of explicit integration about a state at rest.

    Parameters
    ----------
    system : System
        Equations of motion.
    u : ndarray of shape (size, 3)
        Displacement [m].
    time : float, default 0
        Time [s] of commands and natural state.

    Returns
    -------
    StepLimit
        Highest frequency [rad/s], damping ratio and largest stable step [s]; without the air's drag, which
        vanishes at rest.

    Notes
    -----
    Jury's criterion for velocity Verlet; the module `lumped.dynamics.explicit.step_limit` derives it.
    """
    rest = np.zeros_like(u)
    stiffness = system.matrix(u, rest, time, 0.0, 0.0, 1.0)
    touching = sum(one.stiffest(system.lattice_mass) for one in system.contacts)
    frequency = math.sqrt(max(_largest_eigenvalue(system, stiffness), 0.0) + touching)
    ratio = 0.0
    if system.resists:
        damping = system.matrix(u, rest, time, 0.0, 1.0, 0.0)
        ratio = _largest_eigenvalue(system, damping) / (2.0 * frequency)
    exact = system.damping.proportional
    safety = TOUCHING if system.contacts else SAFETY
    return StepLimit(frequency, ratio, turn_limit(ratio, exact) / frequency, exact, safety)


def soften_contacts(system: System) -> None:
    """Set the stiffness in motion of a system's contacts, by the springs' highest frequency."""
    if system.contacts:
        rest = system.prescribed.place(0.0)
        springs = system.assembly.tangent(rest)
        squared = _largest_eigenvalue(system, springs)
        for one in system.contacts:
            one.set_motion_penalty(system.lattice_mass, squared)


def _largest_eigenvalue(system: System, blocks: np.ndarray) -> float:
    """Return the largest eigenvalue of M⁻¹A on the free motions, without multipliers, which have no mass."""
    size, moving = system.reduced_mass.shape[0], ~system.algebraic
    matrix = system.problem.system.matrix(blocks)[moving][:, moving]
    if not matrix.data.any():  # also of contact with a held edge alone
        return 0.0
    value = eigsh(
        matrix,
        k=1,
        M=system.reduced_mass,
        Minv=LinearOperator((size, size), matvec=lambda b: system.solve_mass(b.ravel()), dtype=float),
        which="LM",
        v0=np.random.default_rng(0).standard_normal(size),
        tol=1e-6,
        return_eigenvectors=False,
    )
    return float(value[0])
