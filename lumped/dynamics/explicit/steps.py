"""Steps of velocity Verlet in one compiled call, as `verlet` beside this file has them.

Vectors are flat, at the places of a `lumped.springs.packing.Packing`. With the predicted velocity
w = v₀ + h a₀ and the damping matrix D at u₁, which is symmetric, what D v₁ is beyond D w comes from one more
pass over the dampers, and the power at a step's start is that at the end of the step before:

    D v₁ = D w + D δ,   v₁·D v₁ = w·D w + 2 w·D δ + δ·D δ,   δ = v₁ − w.

What is prescribed over time comes in tables, a row a moment.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.dynamics.explicit.follower_loads import Followers, add_followers
from lumped.springs.all_forces import add_at_places, add_damping_again
from lumped.springs.packing import Packing
from lumped.springs.tiles import NUMBA_TRUE, OPTIONS
from sheetbench.numerics.typed import njit


class ExplicitArrays(NamedTuple):
    """What stays the same from step to step, at s places. mass, inverse_mass: (3 s,) [kg], the latter zero
    where supports hold; rate: (3 s,) or empty, damping of each mass [N·s/m]; columns: (h, layers) places
    whose mean is held; dead: (parts, 3 s) loads [N] to be scaled by each history, the first by none; driven:
    places that g(t) moves. damped, working: whether anything takes energy, whether loads change or follow."""

    packing: Packing
    mass: np.ndarray
    inverse_mass: np.ndarray
    rate: np.ndarray
    columns: np.ndarray
    dead: np.ndarray
    followers: Followers
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
    u: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
) -> tuple[bool, int, float, float]:
    """Take u, v and a (3 s,) `steps` steps of h [s] on. factors: (steps + 1, parts) of the loads' histories;
    place and place_rate: (steps + 1, driven) [m], [m/s].

    Whether no number overflowed, else u, v and a are spoilt; the steps before that; the energy that dampers
    took and the work done [J].
    """
    packing, driven, rate = arrays.packing, arrays.driven, arrays.rate
    w, d, moved = np.zeros_like(u), np.zeros_like(u), np.zeros_like(u)  # predicted velocity, its correction
    force, damping, load, load_before = np.zeros_like(u), np.zeros_like(u), np.zeros_like(u), np.zeros_like(u)
    tile, exerted = np.zeros(packing.length), np.zeros(len(driven))
    taken = work = power = 0.0
    external(arrays, factors[0], u, load)
    if arrays.damped or len(driven):
        w[:] = v
        force[:] = 0.0
        _, power = add_at_places(u, w, NUMBA_TRUE, packing.damped, packing, force, tile)
        power += resist(rate, w, force)
        for i in range(len(driven)):
            exerted[i] = exerted_on(arrays, driven[i], a, force, load)
    for n in range(steps):
        _predict(h, arrays, u, v, a, w, moved)
        for i in range(len(driven)):
            p, jump = driven[i], place[n + 1, i] - place[n, i] - h * place_rate[n, i]
            u[p] += jump
            moved[p] += jump
            v[p] += place_rate[n + 1, i] - place_rate[n, i]
        if arrays.working:
            load_before[:] = load
            external(arrays, factors[n + 1], u, load)
        force[:] = 0.0
        _, now = add_at_places(u, w, NUMBA_TRUE, packing.damped, packing, force, tile)
        now += resist(rate, w, force)
        if not _accelerate(0.5 * h, arrays, load, force, a, v):
            return False, n, taken, work
        if arrays.damped:
            for i in range(len(d)):
                d[i] = v[i] - w[i]
            damping[:] = 0.0
            beyond = resist(rate, d, damping)
            if packing.damped:
                beyond += add_damping_again(u, d, packing, damping, tile)
            now += 2.0 * _correct(arrays, w, damping, force) + beyond
            taken += 0.5 * h * (power + now)
            power = now
            if not _accelerate(0.0, arrays, load, force, a, v):
                return False, n, taken, work
        if arrays.working:
            work += work_of_loads(arrays, load_before, load, moved)
        work += work_of_supports(arrays, exerted, (a, force, load), place[n : n + 2], place_rate[n : n + 2])
    return True, steps, taken, work


@njit(**OPTIONS)
def _predict(
    h: float,
    arrays: ExplicitArrays,
    u: np.ndarray,
    v: np.ndarray,
    a: np.ndarray,
    w: np.ndarray,
    moved: np.ndarray,
) -> None:
    """w = v + h a where there are dampers, v half a step and u a step on; what u moved where loads work."""
    count = arrays.packing.layers * arrays.packing.plane
    size = arrays.packing.size
    for q in range(3):
        first = np.uint64(q) * size
        if arrays.damped:
            for i in range(count):
                w[first + i] = v[first + i] + h * a[first + i]
        for i in range(count):
            half = v[first + i] + 0.5 * h * a[first + i]
            v[first + i] = half
            u[first + i] += h * half
        if arrays.working:
            for i in range(count):
                moved[first + i] = h * v[first + i]


@njit(**OPTIONS)
def _accelerate(
    half: float, arrays: ExplicitArrays, load: np.ndarray, force: np.ndarray, a: np.ndarray, v: np.ndarray
) -> bool:
    """a = T M⁻¹ Tᵀ (load − force), and v by half a step [s] of it; whether all is finite."""
    count = arrays.packing.layers * arrays.packing.plane
    size, inverse = arrays.packing.size, arrays.inverse_mass
    lost = 0.0
    for q in range(3):
        first = np.uint64(q) * size
        for i in range(count):
            gained = (load[first + i] - force[first + i]) * inverse[first + i]
            a[first + i] = gained
            v[first + i] += half * gained
            lost += 0.0 * gained  # not a number if any is not finite
    for c in range(len(arrays.columns)):
        mean = weight = 0.0
        for p in arrays.columns[c]:
            mean += a[p]
            weight += inverse[p]
        for p in arrays.columns[c]:
            back = mean / weight * inverse[p]
            a[p] -= back
            v[p] -= half * back
    return lost == 0.0


@njit(**OPTIONS)
def resist(rate: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
    """Add the forces of the masses' own damping, if there is any; the power taken [W]."""
    power = 0.0
    for i in range(len(rate)):
        resisting = rate[i] * v[i]
        power += resisting * v[i]
        force[i] += resisting
    return power


@njit(**OPTIONS)
def _correct(arrays: ExplicitArrays, w: np.ndarray, damping: np.ndarray, force: np.ndarray) -> float:
    """Add the correction of the damping force to the force; its power on the predicted velocity [W]."""
    count = arrays.packing.layers * arrays.packing.plane
    power = 0.0
    for q in range(3):
        first = np.uint64(q) * arrays.packing.size
        for i in range(count):
            power += w[first + i] * damping[first + i]
            force[first + i] += damping[first + i]
    return power


@njit(**OPTIONS)
def exerted_on(arrays: ExplicitArrays, p: int, a: np.ndarray, force: np.ndarray, load: np.ndarray) -> float:
    """What holds a place [N]."""
    return arrays.mass[p] * a[p] + force[p] - load[p]


@njit(**OPTIONS)
def work_of_supports(
    arrays: ExplicitArrays,
    exerted: np.ndarray,
    at: tuple[np.ndarray, np.ndarray, np.ndarray],
    place: np.ndarray,
    rate: np.ndarray,
) -> float:
    """Of supports in motion over a step [J]: of what they exert, by the trapezoidal rule, and what the masses
    that they hold gain by their prescribed rates.

    exerted: at the step's start (k,) [N], which the end's takes the place of; at: accelerations, forces and
    loads at the end; place, rate: of what is driven (2, k), at both ends.
    """
    (a, force, load), driven, work = at, arrays.driven, 0.0
    for i in range(len(driven)):
        now = exerted_on(arrays, driven[i], a, force, load)
        work += 0.5 * (exerted[i] + now) * (place[1, i] - place[0, i])
        work += 0.5 * arrays.mass[driven[i]] * (rate[1, i] ** 2 - rate[0, i] ** 2)
        exerted[i] = now
    return work


@njit(**OPTIONS)
def external(arrays: ExplicitArrays, factors: np.ndarray, u: np.ndarray, load: np.ndarray) -> None:
    """The loads at displacement u, scaled by the factors of their histories."""
    load[:] = arrays.dead[0]
    for part in range(1, len(arrays.dead)):
        for i in range(len(load)):
            load[i] += factors[part] * arrays.dead[part, i]
    add_followers(arrays.packing, arrays.followers, factors, u, load)


@njit(**OPTIONS)
def work_of_loads(arrays: ExplicitArrays, before: np.ndarray, after: np.ndarray, moved: np.ndarray) -> float:
    """Work [J] of what loads are beyond those without a history, by the trapezoidal rule."""
    count = arrays.packing.layers * arrays.packing.plane
    work = 0.0
    for q in range(3):
        first = np.uint64(q) * arrays.packing.size
        for i in range(count):
            mean = 0.5 * (before[first + i] + after[first + i]) - arrays.dead[0, first + i]
            work += mean * moved[first + i]
    return work
