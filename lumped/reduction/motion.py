"""Generalised-α for the coordinates of a condensed model, whole runs of steps in one compiled call.

    q̈ + C(q) q̇ + ∂E/∂q = Φᵀ f_ext(t)

as `lumped.dynamics.generalised_alpha` has it, with a Newton iteration whose matrix leaves out ∂C/∂q.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import njit

from lumped.reduction.condensed import Condensed
from lumped.reduction.monomials import add_force, values

CORRECTIONS = 30
CLOSE = 1e-10  # last correction relative to the largest coordinate


class Coefficients(NamedTuple):
    """αm, αf, β, γ of the method."""

    am: float
    af: float
    beta: float
    gamma: float


class Coordinates(NamedTuple):
    """Coordinates, velocities, accelerations and the algorithm's accelerations, (r,) each."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    algorithm: np.ndarray


@njit(cache=True)
def dampers(model: Condensed, q: np.ndarray) -> np.ndarray:
    """C(q), (r, r)."""
    found, terms = model.damping_at_rest.copy(), values(model.damping, q)
    for m in range(len(terms)):
        found += terms[m] * model.damping_weights[m]
    return found


@njit(cache=True)
def march(
    state: Coordinates, forces: np.ndarray, h: float, model: Condensed, method: Coefficients
) -> tuple[int, float]:
    """As many steps of h [s] as there are rows in forces (n, r), from the state, which is moved along: how
    many were taken before one found no solution, and what the dampers took [J]."""
    count = len(state.q)
    share = (1.0 - method.af) / (1.0 - method.am)
    by_u, by_v = 1.0 / (h * h * method.beta * share), method.gamma / (h * method.beta)
    taken, power = 0.0, state.v @ (dampers(model, state.q) @ state.v)
    for done in range(len(forces)):
        start = (method.af * state.a - method.am * state.algorithm) / (1.0 - method.am)
        base = state.q + h * state.v
        base += h * h * ((0.5 - method.beta) * state.algorithm + method.beta * start)
        speed = state.v + h * ((1.0 - method.gamma) * state.algorithm + method.gamma * start)
        q, solved = base + state.a / by_u, False
        for _ in range(CORRECTIONS):
            c = dampers(model, q)
            v, a = speed + by_v * (q - base), by_u * (q - base)
            left, matrix = a + c @ v + model.squares * q - forces[done], by_v * c
            for i in range(count):
                matrix[i, i] += by_u + model.squares[i]
            add_force(model.energy, model.weights, q, left, matrix)
            correction = np.linalg.solve(matrix, left)
            q -= correction
            largest = np.abs(q).max()
            if not np.isfinite(largest):
                break
            if np.abs(correction).max() <= CLOSE * largest:
                solved = True
                break
        if not solved:
            return done, taken
        a = by_u * (q - base)
        state.v[:] = speed + by_v * (q - base)
        state.q[:], state.a[:] = q, a
        state.algorithm[:] = start + share * a
        now = state.v @ (dampers(model, state.q) @ state.v)
        taken += 0.5 * h * (power + now)
        power = now
    return len(forces), taken
