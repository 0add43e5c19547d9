"""Steps of velocity Verlet (`lumped.dynamics.explicit.verlet`) in one compiled call.

Vectors are flat, at the places of a `lumped.springs.packing.Packing`. The predicted velocity is
w = v₀ + h a₀, the damping matrix at u₁ D, which is symmetric. The difference of D v₁ and D w comes from one
more pass over the dampers, and the power at a step's start is the power at the end of the step before:

    D v₁ = D w + D δ,   v₁·D v₁ = w·D w + 2 w·D δ + δ·D δ,   δ = v₁ − w.

Prescribed motions come in tables, a row a time.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.pressure import add_couples, add_surface_forces
from lumped.springs.packed_forces import THREE, at_places, average, distribute_over_layers
from lumped.springs.packing import Packing, Scratch
from lumped.springs.tiles import NUMBA_FALSE, NUMBA_TRUE, OPTIONS
from sheetbench.numerics.aliasing import zeros
from sheetbench.numerics.options import inner, njit


class ExplicitLoads(NamedTuple):
    """Loads of explicit steps. dead: (parts, 3 s) [N], to be scaled by each history, the first by none;
    positions: at rest (3 s,) [m]; cells: (c, 4) places on the mid-surface of cells under pressure: (parts, c)
    [Pa]; columns: places (e, 3, layers) of moments (e,) [N·m] (`lumped.pressure.add_couples`); owners: (e,)
    the moments' parts."""

    dead: np.ndarray
    positions: np.ndarray
    cells: np.ndarray
    pressure: np.ndarray
    columns: np.ndarray
    moments: np.ndarray
    owners: np.ndarray


class ExplicitArrays(NamedTuple):
    """Constant arrays of explicit steps, at s places. mass, inverse_mass: (3 s,) [kg], [1/kg], the inverse
    zero of held components; rate: (3 s,) or empty, damping of each mass [N·s/m]; held: (h, layers) places
    whose mean is held; driven: places that g(t) moves; damped: whether there are dampers; nonconservative:
    whether loads change or follow the sheet."""

    packing: Packing
    loads: ExplicitLoads
    mass: np.ndarray
    inverse_mass: np.ndarray
    rate: np.ndarray
    held: np.ndarray
    driven: np.ndarray
    damped: bool
    nonconservative: bool


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
    """Advance u, v and a (3 s,) by `steps` steps of h [s]. factors: (steps + 1, parts) of the loads'
    histories; place and place_rate: (steps + 1, driven) [m], [m/s] of prescribed motions.

    Return whether all numbers are finite (otherwise u, v and a are invalid), the number of finite steps, the
    energy [J] that dampers took, and the work done [J].
    """
    size, count = arrays.packing.size, arrays.packing.layers * arrays.packing.plane
    packing, driven, rate, exerted = arrays.packing, arrays.driven, arrays.rate, zeros(len(arrays.driven))
    w, d, force, resisting = zeros(u.shape), zeros(u.shape), zeros(u.shape), zeros(u.shape)
    tile, load = zeros(packing.length), zeros(u.shape)
    predictor, corrector = Scratch(u, w, force, tile), Scratch(u, d, resisting, tile)
    before, taken, work, power = zeros(u.shape), 0.0, 0.0, 0.0
    add_loads(arrays, factors[0], u, load)
    if arrays.damped or len(driven):
        w[:] = v
        power = at_places(NUMBA_TRUE, NUMBA_TRUE, packing.damped, NUMBA_TRUE, packing, predictor)[1]
        power += _add_damping(rate, v, force)
        for i in range(len(driven)):
            exerted[i] = _exerted(arrays, driven[i], a, force, load)
    for n in range(steps):
        for q in range(THREE):
            for i in range(q * size, q * size + count):
                w[i] = v[i] + h * a[i]
                v[i] += 0.5 * h * a[i]
                d[i] = h * v[i]
            for i in range(q * size, q * size + count):
                u[i] += d[i]
        for i in range(len(driven)):
            p, jump = driven[i], place[n + 1, i] - place[n, i] - h * place_rate[n, i]
            d[p], u[p] = d[p] + jump, u[p] + jump
            v[p] += place_rate[n + 1, i] - place_rate[n, i]
        if arrays.nonconservative:
            load, before = before, load
            add_loads(arrays, factors[n + 1], u, load)
            work += _work_of_loads(arrays.loads.dead[0], before, load, d)
        taking = at_places(NUMBA_TRUE, NUMBA_TRUE, packing.damped, NUMBA_TRUE, packing, predictor)[1]
        taking += _add_damping(rate, w, force)
        if not _accelerate(0.5 * h, arrays, load, force, a, v):
            return False, n, taken, work
        if arrays.damped:
            for i in range(len(d)):
                d[i] = v[i] - w[i]
            resisting[:] = 0.0
            if packing.damped:
                fresh = not packing.keeping
                taking += at_places(fresh, NUMBA_FALSE, NUMBA_TRUE, NUMBA_TRUE, packing, corrector)[1]
            taking += _add_damping(rate, d, resisting)
            for i in range(len(d)):
                taking += 2.0 * w[i] * resisting[i]
                force[i] += resisting[i]
            taken += 0.5 * h * (power + taking)
            power = taking
            if not _accelerate(0.0, arrays, load, force, a, v):
                return False, n, taken, work
        for i in range(len(driven)):  # by the trapezoidal rule, and the gain of kinetic energy
            p, last = driven[i], exerted[i]
            exerted[i] = _exerted(arrays, p, a, force, load)
            work += 0.5 * (last + exerted[i]) * (place[n + 1, i] - place[n, i])
            work += 0.5 * arrays.mass[p] * (place_rate[n + 1, i] ** 2 - place_rate[n, i] ** 2)
    return True, steps, taken, work


@njit(**OPTIONS)
def _add_damping(rate: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
    """Add the forces of the masses' damping, if any; return the power taken [W]."""
    power = 0.0
    for i in range(len(rate)):
        force[i] += rate[i] * v[i]
        power += rate[i] * v[i] * v[i]
    return power


@njit(**OPTIONS)
def _accelerate(
    half: float, arrays: ExplicitArrays, load: np.ndarray, force: np.ndarray, a: np.ndarray, v: np.ndarray
) -> bool:
    """Set a = T M⁻¹ Tᵀ (load − force), and advance v by `half` a step [s] of it; return whether all numbers
    are finite."""
    inverse, lost, size = arrays.inverse_mass, 0.0, arrays.packing.size
    for q in range(THREE):
        for i in range(q * size, q * size + arrays.packing.layers * arrays.packing.plane):
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
    """Return the force [N] that holds a component."""
    return arrays.mass[p] * a[p] + force[p] - load[p]


@njit(**OPTIONS)
def add_loads(arrays: ExplicitArrays, factors: np.ndarray, u: np.ndarray, load: np.ndarray) -> None:
    """Set `load` [N] to the loads at displacement u, scaled by the factors of their histories."""
    packing, loads = arrays.packing, arrays.loads
    load[:] = loads.dead[0]
    for part in range(1, len(factors)):
        for i in range(len(load)):
            load[i] += factors[part] * loads.dead[part, i]
    if len(loads.cells) or len(loads.moments):
        displaced, pressure = loads.positions + u, zeros(len(loads.cells))
        x, following = displaced.reshape(3, -1).T, load.reshape(3, -1).T
        add_couples(x, loads.columns, factors[loads.owners] * loads.moments, following)
        for part in range(len(factors)):
            for c in range(len(pressure)):
                pressure[c] += factors[part] * loads.pressure[part, c]
        if len(pressure):
            average(packing, displaced)
            add_surface_forces(x, loads.cells, pressure, following)
            distribute_over_layers(packing, load)


@njit(**OPTIONS)
def _work_of_loads(still: np.ndarray, before: np.ndarray, after: np.ndarray, moved: np.ndarray) -> float:
    """Return the work [J] of the loads less the constant dead loads, by the trapezoidal rule."""
    work = 0.0
    for i in range(len(moved)):
        work += (0.5 * (before[i] + after[i]) - still[i]) * moved[i]
    return work
