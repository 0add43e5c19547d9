"""Steps of velocity Verlet in one compiled call, as `verlet` beside this file has them.

With the predicted velocity w = v₀ + h a₀ and the damping matrix D at u₁, which is symmetric, what D v₁ is
beyond D w comes from one more pass over the dampers, and the power at a step's start is that at the end of
the step before:

    D v₁ = D w + D δ,   v₁·D v₁ = w·D w + 2 w·D δ + δ·D δ,   δ = v₁ − w.

What is prescribed over time comes in tables, a row a moment.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.dynamics.damping import MovingForces, add_damping_again, add_forces
from lumped.pressure import add_couples
from lumped.pressure import add_forces as add_pressure
from lumped.springs.tiles import NUMBA_TRUE, OPTIONS
from sheetbench.numerics.typed import inner, njit


class ExplicitLoads(NamedTuple):
    """dead: (parts, n, 3) [N], to be scaled by each history, the first by none; positions: at rest (n, 3)
    [m]; cells: (c, 4, layers) masses of cells under pressure: (parts, c) [Pa]; columns: (e, 3, layers) of
    moments (e,) [N·m], as `lumped.pressure.add_couples` has them; owners: (e,) parts of those."""

    dead: np.ndarray
    positions: np.ndarray
    cells: np.ndarray
    pressure: np.ndarray
    columns: np.ndarray
    moments: np.ndarray
    owners: np.ndarray


class ExplicitArrays(NamedTuple):
    """What stays the same from step to step, of n masses whose components are numbered as they lie. mass,
    inverse_mass: (3 n,) [kg], the latter zero where supports hold; held: (h, layers) components whose mean
    is held; driven: components that g(t) moves; damped, working: whether anything takes energy, whether loads
    change or follow."""

    forces: MovingForces
    loads: ExplicitLoads
    mass: np.ndarray
    inverse_mass: np.ndarray
    held: np.ndarray
    driven: np.ndarray
    damped: bool
    working: bool


@njit(**OPTIONS)
def march(
    steps: int,
    h: float,
    arrays: ExplicitArrays,
    factors: np.ndarray,
    place: np.ndarray,
    place_rate: np.ndarray,
    states: np.ndarray,
) -> tuple[bool, int, float, float]:
    """Take u, v and a, (3, n, 3), `steps` steps of h [s] on. factors: (steps + 1, parts) of the loads'
    histories; place and place_rate: (steps + 1, driven) [m], [m/s].

    Whether no number overflowed, else the state is spoilt; the steps before that; the energy that dampers
    took and the work done [J].
    """
    forces, driven, damped = arrays.forces, arrays.driven, arrays.damped
    room, exerted = np.zeros((5, *states[0].shape)), np.zeros(len(driven))
    u, v, a = _flat(states, 0), _flat(states, 1), _flat(states, 2)
    w, d, f, resisting, load = _flat(room, 0), _flat(room, 1), _flat(room, 2), _flat(room, 3), _flat(room, 4)
    taken = work = power = 0.0
    add_loads(arrays.loads, factors[0], states[0], room[4])
    if damped or len(driven):
        power = add_forces(forces, states[0], states[1], NUMBA_TRUE, damped, room[2])[1]
        for i in range(len(driven)):
            exerted[i] = _exerted(arrays, driven[i], a, f, load)
    for n in range(steps):
        for i in range(len(u)):
            w[i] = v[i] + h * a[i]
            v[i] += 0.5 * h * a[i]
            d[i] = h * v[i]
        for i in range(len(driven)):
            d[driven[i]] += place[n + 1, i] - place[n, i] - h * place_rate[n, i]
            v[driven[i]] += place_rate[n + 1, i] - place_rate[n, i]
        for i in range(len(u)):
            u[i] += d[i]
        if arrays.working:
            work += 0.5 * _work_of_loads(arrays.loads, load, d)
            add_loads(arrays.loads, factors[n + 1], states[0], room[4])
            work += 0.5 * _work_of_loads(arrays.loads, load, d)
        f[:] = 0.0
        now = add_forces(forces, states[0], room[0], NUMBA_TRUE, damped, room[2])[1]
        if not _accelerate(0.5 * h, arrays, load, f, a, v):
            return False, n, taken, work
        if damped:
            for i in range(len(d)):
                d[i] = v[i] - w[i]
            resisting[:] = 0.0
            now += add_damping_again(forces, states[0], room[1], NUMBA_TRUE, room[3])
            for i in range(len(d)):
                now += 2.0 * w[i] * resisting[i]
                f[i] += resisting[i]
            taken += 0.5 * h * (power + now)
            power = now
            if not _accelerate(0.0, arrays, load, f, a, v):
                return False, n, taken, work
        for i in range(len(driven)):  # by the trapezoidal rule, and what the masses gain by their rates
            p, before = driven[i], exerted[i]
            exerted[i] = _exerted(arrays, p, a, f, load)
            work += 0.5 * (before + exerted[i]) * (place[n + 1, i] - place[n, i])
            work += 0.5 * arrays.mass[p] * (place_rate[n + 1, i] ** 2 - place_rate[n, i] ** 2)
    return True, steps, taken, work


@inner(**OPTIONS)
def _flat(vectors: np.ndarray, i: int) -> np.ndarray:
    """Vector i of (k, n, 3), flat."""
    return vectors[i].reshape(-1)


@njit(**OPTIONS)
def _accelerate(
    half: float, arrays: ExplicitArrays, load: np.ndarray, force: np.ndarray, a: np.ndarray, v: np.ndarray
) -> bool:
    """a = T M⁻¹ Tᵀ (load − force), and v by half a step [s] of it; whether all is finite."""
    inverse, lost = arrays.inverse_mass, 0.0
    for i in range(len(a)):
        gained = (load[i] - force[i]) * inverse[i]
        a[i] = gained
        v[i] += half * gained
        lost += 0.0 * gained  # not a number if any is not finite
    for c in range(len(arrays.held)):
        mean = weight = 0.0
        for p in arrays.held[c]:
            mean += a[p]
            weight += inverse[p]
        for p in arrays.held[c]:
            back = mean / weight * inverse[p]
            a[p] -= back
            v[p] -= half * back
    return lost == 0.0


@inner(**OPTIONS)
def _exerted(arrays: ExplicitArrays, p: int, a: np.ndarray, force: np.ndarray, load: np.ndarray) -> float:
    """What holds a component [N]."""
    return arrays.mass[p] * a[p] + force[p] - load[p]


@njit(**OPTIONS)
def add_loads(loads: ExplicitLoads, factors: np.ndarray, u: np.ndarray, out: np.ndarray) -> None:
    """Put the loads at displacement u (n, 3) [m], scaled by the factors of their histories, in `out` [N]."""
    out[:] = loads.dead[0]
    pressure, moments = factors[0] * loads.pressure[0], np.empty(len(loads.moments))
    for part in range(1, len(factors)):
        out += factors[part] * loads.dead[part]
        pressure += factors[part] * loads.pressure[part]
    if len(loads.cells):
        add_pressure(loads.positions + u, loads.cells, pressure, out)
    for e in range(len(moments)):
        moments[e] = factors[loads.owners[e]] * loads.moments[e]
    if len(moments):
        add_couples(loads.positions + u, loads.columns, moments, out)


@njit(**OPTIONS)
def _work_of_loads(loads: ExplicitLoads, load: np.ndarray, moved: np.ndarray) -> float:
    """Work [J] of what loads are beyond those without a history."""
    still, work = loads.dead[0].reshape(-1), 0.0
    for i in range(len(moved)):
        work += (load[i] - still[i]) * moved[i]
    return work
