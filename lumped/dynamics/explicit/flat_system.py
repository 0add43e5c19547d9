"""A system as flat arrays, for steps that are compiled; states there and back.

Everything but chains, whose constraints and joints are not compiled. What is prescribed over time, and the
factors of loads, are tabulated for a number of steps at a time.
"""

from __future__ import annotations

import numpy as np

from lumped.dynamics.explicit.follower_loads import Followers
from lumped.dynamics.explicit.steps import ExplicitArrays, march
from lumped.dynamics.system import State, System
from sheetbench.numerics.time.method import Advance, StepFailed

CALL, PER_SPRING = 0.03, 1e-8  # s that a call takes, about, and a step of a spring
LEAST = 8  # steps of a call: to lay a large lattice out for it and back takes as long as two of them


class FlatSystem:
    """A system without chains at the places of a packing. size: of flat vectors; arrays: what compiled steps
    take; at_once: steps of a call."""

    def __init__(self, system: System):
        assembly, self._parts = system.assembly, system.problem.loads.parts
        self._system, self._shape = system, (*system.lattice_mass.shape, 3)
        packing = system.packing
        count = len(packing.order)
        self._order, self._count, self._stride = packing.order, count, int(packing.size)
        self._place = np.empty(count, dtype=int)
        self._place[packing.order] = np.arange(count)
        mass = self.flat(np.repeat(system.lattice_mass[:, None], 3, axis=1))
        free, columns = _freedom(system)
        inverse = np.zeros_like(mass)
        moving = self.flat(np.where(free, 1.0, 0.0)) > 0.0
        inverse[moving] = 1.0 / mass[moving]
        rate = self.flat(np.repeat(system.damping.rate[:, None], 3, axis=1))
        self._driven = np.argwhere(system.prescribed.components)
        springs = sum(map(len, assembly.springs))
        self.at_once = max(LEAST, round(CALL / (springs * PER_SPRING)))
        self.size = 3 * self._stride
        self.arrays = ExplicitArrays(
            packing,
            mass,
            inverse,
            rate if rate.any() else np.empty(0),
            self.places(columns // 3, columns % 3),
            np.stack([self.flat(part.dead) for part in self._parts]),
            self._followers(),
            self.places(*self._driven.T),
            system.damping.present,
            system.working,
        )

    def march(self, state: State, step: float, most: int) -> Advance[State]:
        """At most so many steps, as many as take some hundredths of a second, or `LEAST`; fewer before one
        that fails. Raises StepFailed where the first one fails."""
        count = min(most, self.at_once)
        while True:
            u, v, a = (self.flat(vector) for vector in (state.u, state.v, state.a))
            times = np.cumsum(np.append(state.time, np.full(count, step)))  # as they add up one by one
            tables = self._factors(times), *self._placed(times)
            whole, taken, dissipated, work = march(count, step, self.arrays, *tables, u, v, a)
            if whole:
                after = State(float(times[taken]), self.by_mass(u), self.by_mass(v), self.by_mass(a))
                return Advance(after, dissipated, work, taken)
            if taken == 0:
                raise StepFailed("a number overflowed")
            count = taken

    def compile(self) -> None:
        """Compile the steps, or load what was compiled, before there is anything to do."""
        still, at_once = np.zeros(self.size), np.zeros(1)
        tables = self._factors(at_once), *self._placed(at_once)
        march(0, 1.0, self.arrays, *tables, still, still.copy(), still.copy())

    def flat(self, vector: np.ndarray) -> np.ndarray:
        """A vector (n, 3) at the places, (3 s,)."""
        out = np.zeros((3, self._stride))
        out[:, : self._count] = vector[self._order].T
        return out.ravel()

    def by_mass(self, flat: np.ndarray) -> np.ndarray:
        """A vector (3 s,) by masses, (n, 3)."""
        out = np.empty(self._shape)
        out[self._order] = flat.reshape(3, self._stride)[:, : self._count].T
        return out

    def _factors(self, times: np.ndarray) -> np.ndarray:
        """Factors of the loads' histories at times (k,) [s], (k, parts)."""
        ones = np.ones(len(times))
        return np.stack([ones if p.history is None else p.history.at(times) for p in self._parts], axis=1)

    def _placed(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacement [m] of what is driven, and its velocity [m/s], at times (k,) [s]: (k, driven) each."""
        if not len(self._driven):
            nothing = np.empty((len(times), 0))
            return nothing, nothing
        system, (rows, axes) = self._system, self._driven.T
        place, rate = np.zeros((2, len(times), *self._shape))
        for moved, axis, course in system.prescribed.by_supports:
            place[:, moved, axis] += course.at(times)[:, axis, None]
            rate[:, moved, axis] += course.slope(times)[:, axis, None]
        if system.coupling is not None:
            for at, time in enumerate(times):
                place[at] += system.coupling.driven(system.drive(time))
                rate[at] += system.coupling.driven_velocity(time)
        # in rows, as they are where nothing is driven, or steps are compiled a second time
        return np.ascontiguousarray(place[:, rows, axes]), np.ascontiguousarray(rate[:, rows, axes])

    def places(self, masses: np.ndarray, axes: np.ndarray) -> np.ndarray:
        """Flat places of components of masses."""
        return (axes * self._stride + self._place[masses]).astype(np.uint64)

    def _followers(self) -> Followers:
        lattice = self._system.assembly.lattice
        layers, plane = lattice.grid[2], self._count // lattice.grid[2]
        positions = self.flat(lattice.positions).reshape(3, self._stride)
        by_layer = positions[:, : self._count].reshape(3, layers, plane)
        positions[:, self._count : self._count + plane] = by_layer.mean(axis=1)
        pressure = np.stack([part.pressure for part in self._parts])
        cells = lattice.mid_cells
        columns, strengths, owners = [np.empty((0, 4))], [np.empty(0)], [np.empty(0)]
        for number, part in enumerate(self._parts):
            for edge, moment, turn in part.moments:
                mid = self._count + self._place[edge[:, 0]] % plane
                before, after = np.append(mid[0], mid[:-1]), np.append(mid[1:], mid[-1])
                columns.append(np.stack([*self._place[edge[:, [-1, 0]]].T, before, after], axis=1))
                strengths.append(turn * moment)
                owners.append(np.full(len(edge), number))
        return Followers(
            positions.ravel(),
            pressure,
            (
                self._count + self._place[cells[:, :, 0]] % plane if pressure.any() else np.empty((0, 4))
            ).astype(np.uint64),
            np.concatenate(columns).astype(np.uint64),
            np.concatenate(strengths),
            np.concatenate(owners).astype(int),
        )


def _freedom(system: System) -> tuple[np.ndarray, np.ndarray]:
    """Which components can move, (n, 3) bool, and columns (h, layers) of those, flat, whose mean is held."""
    entries = system.transform.tocoo()
    free = np.zeros(system.transform.shape[0], dtype=bool)
    free[entries.row] = True
    own = np.empty(system.transform.shape[1], dtype=int)
    own[entries.col[entries.data > 0.0]] = entries.row[entries.data > 0.0]
    held = entries.data < 0.0  # the last of a column is less the sum of the others
    rows, others = entries.row[held], own[entries.col[held]]
    layers = system.assembly.lattice.grid[2]
    order = np.argsort(rows, kind="stable")
    rows, others = rows[order].reshape(-1, layers - 1), others[order].reshape(-1, layers - 1)
    return free.reshape(-1, 3), np.concatenate([others, rows[:, :1]], axis=1)
