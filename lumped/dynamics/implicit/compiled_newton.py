"""Newton's iteration for the equation of an implicit step, compiled: small lattices without chains.

The force of all springs and dampers, the residual, the substitution with kept factors and the norm of the
correction are one call that allocates nothing; Python assembles and factors the tangent. For the equation and
the limits of the iteration see `lumped.dynamics.implicit.newton`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.dynamics.damping import MovingForces, add_forces
from lumped.dynamics.system import System
from lumped.springs.tiles import NUMBA_TRUE
from sheetbench.numerics import banded
from sheetbench.numerics.options import njit, typed
from sheetbench.numerics.sparse_products import Rows, add_product, csr_arrays


class Arrays(NamedTuple):
    """The equations of motion and the work arrays of the iteration. forces, mass: of all rows; free: T with
    its columns in the band's order; unknowns: number of columns; width: of the band; force, velocity, base_u,
    base_v: (n, 3), the last two û and v̂; right: right side in the band's order, padded."""

    forces: MovingForces
    mass: Rows
    free: Rows
    unknowns: int
    width: int
    force: np.ndarray
    velocity: np.ndarray
    base_u: np.ndarray
    base_v: np.ndarray
    right: np.ndarray


class NewtonLimits(NamedTuple):
    """Limits of a correction's largest component [m]: the last correction is below `tolerance`, a diverging
    one above `largest`. stale: ratio of successive corrections above which factors are renewed; corrections:
    largest number for an equation."""

    tolerance: float
    largest: float
    stale: float
    corrections: int


class Compiled(NamedTuple):
    """Arguments of the compiled iteration except the factors; base_u, base_v: its û and v̂ (n, 3)."""

    arrays: Arrays
    base_u: np.ndarray
    base_v: np.ndarray
    band: banded.Band


def compiled_of(system: System) -> Compiled | None:
    """Return the iteration of a system whose forces are all compiled, with its factors in a band."""
    problem, band = system.problem, system.problem.system.band
    plain = system.coupling is None and system.packed and not system.contacts
    if band is None or not plain or not problem.conservative or problem.loads.follow:
        return None
    free = csr_arrays(system.transform[:, band.order])
    force, velocity, base_u, base_v = np.zeros((4, system.assembly.pattern.size, 3))
    right = banded.padded_vector(len(band.order), band.width)
    equation = system.forces, system.mass_rows, free, len(band.order), band.width
    arrays = Arrays(*equation, force, velocity, base_u, base_v, right)
    return Compiled(typed(arrays), arrays.base_u, arrays.base_v, band)


@njit
def iterate(
    remaining: int,
    u: np.ndarray,
    base_u: np.ndarray,
    base_v: np.ndarray,
    by: tuple[float, float],
    external: np.ndarray,
    limits: NewtonLimits,
    arrays: Arrays,
    factors: np.ndarray,
) -> tuple[bool, int]:
    """Solve the equation with û, v̂ (n, 3), c₂ and c₁, and loads (n, 3), for u in place.
    Return whether it is solved, and the number of corrections that remain of `remaining`, with other factors;
    0 without a solution."""
    last = np.inf
    while remaining > 0:
        length = correct(u, base_u, base_v, by, external, arrays, factors)
        remaining -= 1
        if length < limits.tolerance:
            return True, remaining
        if not length <= limits.largest:
            break
        if length > limits.stale * last:
            return False, remaining
        last = length
    return False, 0


@njit
def correct(
    u: np.ndarray,
    base_u: np.ndarray,
    base_v: np.ndarray,
    by: tuple[float, float],
    external: np.ndarray,
    arrays: Arrays,
    factors: np.ndarray,
) -> float:
    """Correct u (n, 3) in place; return the largest component of that [m], NaN if it is not finite."""
    mass_coefficient, damping_coefficient = by
    force, velocity, right = arrays.force, arrays.velocity, arrays.right
    free = arrays.free
    moved, held, began = u.reshape(-1), base_u.reshape(-1), base_v.reshape(-1)
    pull, speed, acting = force.reshape(-1), velocity.reshape(-1), external.reshape(-1)
    for row in range(len(moved)):
        speed[row], pull[row] = moved[row] - held[row], -acting[row]
    add_product(arrays.mass, mass_coefficient, speed, pull)
    for row in range(len(moved)):
        speed[row] = began[row] + damping_coefficient * speed[row]
    add_forces(arrays.forces, u, velocity, NUMBA_TRUE, NUMBA_TRUE, force)
    right[:] = 0.0
    for row in range(len(moved)):
        for e in range(free.pointers[row], free.pointers[row + 1]):
            right[free.columns[e]] -= free.values[e] * pull[row]
    banded.substitute(factors, arrays.unknowns, arrays.width, right)
    length = total = 0.0
    for row in range(len(moved)):
        step = 0.0
        for e in range(free.pointers[row], free.pointers[row + 1]):
            step += free.values[e] * right[free.columns[e]]
        moved[row] += step
        total += step
        length = max(length, abs(step))
    return length if np.isfinite(total) else np.nan


@njit
def excess(
    u: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    by: tuple[float, float],
    external: np.ndarray,
    arrays: Arrays,
    factors: np.ndarray,
) -> float:
    """Return half the work [J] of the residual at a state (n, 3) along its own correction, in the equation
    with c₂ and c₁."""
    corrected, base_u, base_v, work = u.copy(), arrays.base_u, arrays.base_v, 0.0
    for i in range(len(u)):
        for q in range(3):
            base_u[i, q], base_v[i, q] = u[i, q] - a[i, q] / by[0], v[i, q] - a[i, q] / by[1]
    correct(corrected, base_u, base_v, by, external, arrays, factors)
    for i in range(len(u)):
        for q in range(3):
            work += 0.5 * arrays.force[i, q] * (u[i, q] - corrected[i, q])
    return work
