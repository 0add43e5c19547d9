"""The stages of a Runge–Kutta step in one compiled call, where `compiled_newton` beside this file serves.

Every stage starts from the earlier ones, is corrected with the current factors, and puts its velocity,
acceleration and damping power into tables whose first row is the step's start. The power is that after the
last correction, which is small in the displacement but lies along stiff springs, whose dampers dissipate
τ k v², always of one sign. The call returns early if a stage needs new factors, and resumes with them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.dynamics.damping import add_damping_again
from lumped.dynamics.implicit.compiled_newton import Arrays, NewtonLimits, iterate
from lumped.springs.tiles import NUMBA_FALSE
from sheetbench.numerics.aliasing import empty
from sheetbench.numerics.options import njit


class Stages(NamedTuple):
    """Stages of a step, the first its start: times (s,) [s]; displacements, velocities, accelerations
    (s, n, 3); power [W] that dampers take, and that moving supports and loads without a potential put in,
    (s, 2)."""

    time: np.ndarray
    u: np.ndarray
    v: np.ndarray
    a: np.ndarray
    power: np.ndarray


class Step(NamedTuple):
    """Common data of a step's stages. length: [s]; weights: coefficients (s, s) of velocities and
    accelerations; guesses: (s, s) of an acceleration's guess; damping_coefficient, mass_coefficient: c₁ and
    c₂ of the equation; shifts: supports' displacement beyond that by the stages' velocities, (s, n, 3) [m];
    turns: their velocities less the start's, (s, n, 3) [m/s], both empty without moving supports; loads: (s,
    n, 3), or (1, n, 3) if constant [N]."""

    length: float
    weights: np.ndarray
    guesses: np.ndarray
    damping_coefficient: float
    mass_coefficient: float
    shifts: np.ndarray
    turns: np.ndarray
    loads: np.ndarray


@njit
def solve_stages(
    first: int,
    remaining: int,
    step: Step,
    stages: Stages,
    limits: NewtonLimits,
    arrays: Arrays,
    factors: np.ndarray,
) -> tuple[bool, int, int, int]:
    """Solve the stages from `first` on. remaining: corrections left for an interrupted first stage, 0 to
    begin it. Return whether all are solved, else the unsolved stage and its remaining corrections; and the
    number of corrections."""
    made, by = 0, (step.mass_coefficient, step.damping_coefficient)
    bases_u, bases_v = arrays.base_u, arrays.base_v
    base_u, base_v = bases_u.reshape(-1), bases_v.reshape(-1)
    for i in range(first, len(stages.u)):
        u, v, a = stages.u[i].reshape(-1), stages.v[i].reshape(-1), stages.a[i].reshape(-1)
        _begin(i, step, stages, base_u, base_v)
        if i > first or remaining == 0:
            remaining = limits.corrections
            _guess(i, step, stages, base_u, u)
        at = min(i, len(step.loads) - 1)
        given = remaining
        solved, remaining = iterate(
            given, stages.u[i], bases_u, bases_v, by, step.loads[at], limits, arrays, factors
        )
        made += given - remaining
        if not solved:
            return False, i, remaining, made
        for row in range(len(u)):
            change = u[row] - base_u[row]
            v[row] = base_v[row] + step.damping_coefficient * change
            a[row] = step.mass_coefficient * change
        forces = arrays.forces
        power = add_damping_again(forces, stages.u[i], stages.v[i], NUMBA_FALSE, arrays.force)
        stages.power[i, 0] = power
    return True, len(stages.u), 0, made


@njit
def _begin(i: int, step: Step, stages: Stages, base_u: np.ndarray, base_v: np.ndarray) -> None:
    """Set û and v̂ of stage i."""
    start, speed = stages.u[0].reshape(-1), stages.v[0].reshape(-1)
    for row in range(len(base_u)):
        base_u[row], base_v[row] = start[row], speed[row]
    for j in range(i):
        weight = step.length * step.weights[i, j]
        if weight != 0.0:
            v, a = stages.v[j].reshape(-1), stages.a[j].reshape(-1)
            for row in range(len(base_u)):
                base_u[row] += weight * v[row]
                base_v[row] += weight * a[row]
    if len(step.shifts):
        shift, turn = step.shifts[i].reshape(-1), step.turns[i].reshape(-1)
        for row in range(len(base_u)):
            base_u[row] += shift[row]
            base_v[row] += turn[row]
    own = 1.0 / step.damping_coefficient
    for row in range(len(base_u)):
        base_u[row] += own * base_v[row]


@njit
def _guess(i: int, step: Step, stages: Stages, base_u: np.ndarray, u: np.ndarray) -> None:
    """Set u of stage i, extrapolated from the accelerations of earlier stages."""
    u[:] = base_u
    for j in range(i):
        weight = step.guesses[i, j] / (step.damping_coefficient * step.damping_coefficient)
        if weight != 0.0:
            a = stages.a[j].reshape(-1)
            for row in range(len(u)):
                u[row] += weight * a[row]


@njit
def largest(weights: np.ndarray, tables: np.ndarray) -> float:
    """Return the largest component of a weighted sum, weights (s,), of tables (s, n, 3)."""
    found, flat = 0.0, tables.reshape(len(tables), -1)
    for row in range(flat.shape[1]):
        total = 0.0
        for i in range(len(weights)):
            total += weights[i] * flat[i, row]
        found = max(found, abs(total))
    return found


@njit
def polynomials(
    displacement: np.ndarray, velocity: np.ndarray, acceleration: np.ndarray, h: float, theta: np.ndarray
) -> np.ndarray:
    """Return displacements, velocities and accelerations (3, k, n, 3) at shares θ (k,) of a step of length h
    [s], by the polynomial through the first and the last of the stages (s, n, 3)."""
    u0, v0, a0 = displacement[0].ravel(), velocity[0].ravel(), acceleration[0].ravel()
    u1, v1, a1 = displacement[-1].ravel(), velocity[-1].ravel(), acceleration[-1].ravel()
    curve, out = empty((6, len(u0))), empty((3, len(theta), len(u0)))
    for i in range(len(u0)):
        change = u1[i] - u0[i] - h * v0[i] - 0.5 * h * h * a0[i]
        speed = h * (v1[i] - v0[i] - h * a0[i])
        bend = h * h * (a1[i] - a0[i])
        curve[0, i], curve[1, i], curve[2, i] = u0[i], h * v0[i], 0.5 * h * h * a0[i]
        curve[3, i] = 10.0 * change - 4.0 * speed + 0.5 * bend
        curve[4, i] = -15.0 * change + 7.0 * speed - bend
        curve[5, i] = 6.0 * change - 3.0 * speed + 0.5 * bend
    rate = 1.0 / h
    for k in range(len(theta)):
        for i in range(len(u0)):
            u = v = a = 0.0
            for power in range(5, -1, -1):  # Horner's rule, with the derivatives
                a = a * theta[k] + 2.0 * v
                v = v * theta[k] + u
                u = u * theta[k] + curve[power, i]
            out[0, k, i], out[1, k, i], out[2, k, i] = u, v * rate, a * rate * rate
    return out.reshape(3, len(theta), -1, 3)
