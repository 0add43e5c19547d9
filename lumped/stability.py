"""The highest frequency of a lattice, and the largest stable step of explicit integration.

ω_max² is the largest eigenvalue of M⁻¹K on the free motions (those the actuators' constraints allow), by
Lanczos; c_max that of M⁻¹C. With ξ = c_max/2ω_max, the damping ratio at ω_max where damping is proportional
to stiffness and an upper bound of it elsewhere, central differences are stable for

    h ≤ (2/ω_max) (√(1 + ξ²) − ξ).                 Belytschko, Liu and Moran (2000), section 6.2
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse.linalg import LinearOperator, eigsh

from lumped.dynamics.constraints import Projection
from lumped.dynamics.system import System

SAFETY = 0.9  # of the default step: large rotations and tension raise ω_max a little


@dataclass(frozen=True)
class StepLimit:
    """ω_max [rad/s], damping ratio ξ there, and the largest stable step [s]."""

    frequency: float
    damping_ratio: float
    step: float

    def describe(self) -> str:
        """The limit and where it comes from."""
        return (
            f"{self.step:.4g} s = (2/ω_max)(√(1 + ξ²) − ξ) with ω_max = {self.frequency:.4g} rad/s "
            f"and ξ = {self.damping_ratio:.3g}"
        )


def step_limit(system: System, u: np.ndarray, time: float = 0.0) -> StepLimit:
    """The limit at displacement u (size, 3) [m]."""
    nothing = np.zeros_like(u)
    stiffness = system.matrix(u, nothing, time, 0.0, 0.0, 1.0)
    frequency = math.sqrt(max(_largest(system, stiffness, u), 0.0))
    ratio = 0.0
    if system.damping.present:
        damping = system.matrix(u, nothing, time, 0.0, 1.0, 0.0)
        ratio = _largest(system, damping, u) / (2.0 * frequency)
    return StepLimit(frequency, ratio, 2.0 / frequency * (math.sqrt(1.0 + ratio**2) - ratio))


def _largest(system: System, blocks: np.ndarray, u: np.ndarray) -> float:
    """Largest eigenvalue of M⁻¹A on the admissible motions."""
    size = system.reduced_mass.shape[0]
    projection = Projection(system)
    gradient = projection.jacobian(u) if projection.active else np.empty((0, 0))
    matrix = system.problem.system.matrix(blocks)
    kept = np.flatnonzero(~system.algebraic)
    matrix = matrix[kept][:, kept]

    def project(v: np.ndarray) -> np.ndarray:
        return system.contract(projection.tangential(system.expand(v), gradient)[0])

    def apply(x: np.ndarray) -> np.ndarray:
        force: np.ndarray = matrix @ (project(x.ravel()) if projection.active else x.ravel())
        if projection.active:
            force = system.reduced_mass @ project(system.solve_mass(force))
        return force

    value = eigsh(
        LinearOperator((size, size), matvec=apply, dtype=float),
        k=1,
        M=system.reduced_mass,
        Minv=LinearOperator((size, size), matvec=lambda b: system.solve_mass(b.ravel()), dtype=float),
        which="LM",
        v0=np.random.default_rng(0).standard_normal(size),
        tol=1e-6,
        return_eigenvectors=False,
    )
    return float(value[0])
