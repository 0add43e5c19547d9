"""A system as flat arrays, for steps that are compiled; states there and back.

Everything but chains, whose constraints and joints are not compiled. What is prescribed over time, and the
factors of loads, are tabulated for a number of steps at a time.
"""

from __future__ import annotations

import numpy as np

from lumped.dynamics.explicit_steps import Motion, Room, march
from lumped.dynamics.follower_loads import Followers
from lumped.dynamics.integrator import Advance, StepFailed
from lumped.dynamics.system import State, System
from lumped.springs.packing import pack, scratch

CALL, PER_SPRING = 0.03, 3e-8  # s that a call takes, about, and a step of a spring


class FlatSystem:
    """A system without chains at the places of a packing. motion: what compiled steps take."""

    def __init__(self, system: System):
        assembly, self._parts = system.assembly, system.problem.loads.parts
        self._system, self._shape = system, (*system.lattice_mass.shape, 3)
        single = assembly.precision == "single"
        packing = system.packing
        if single:
            packing = pack(assembly.lattice, assembly.springs, system.damping.dampers, single)
        count, plane = len(packing.order), int(packing.plane)
        self._order, self._count, self._size = packing.order, count, count + plane
        self._place = np.empty(count, dtype=int)
        self._place[packing.order] = np.arange(count)
        mass = self.flat(self._of_masses(system.lattice_mass))
        free, columns = _freedom(system)
        inverse = np.zeros_like(mass)
        moving = self.flat(np.where(free, 1.0, 0.0)) > 0.0
        inverse[moving] = 1.0 / mass[moving]
        rate = self.flat(self._of_masses(system.damping.rate))
        self._driven = np.argwhere(system.driven)
        springs = sum(map(len, assembly.springs))
        self._at_once = max(1, round(CALL / (springs * PER_SPRING)))
        self.motion = Motion(
            packing,
            mass,
            inverse,
            rate if rate.any() else np.empty(0),
            self._places(columns // 3, columns % 3),
            np.stack([self.flat(part.dead) for part in self._parts]),
            self._followers(),
            self._places(*self._driven.T),
            system.damping.present,
            system.working,
            single,
        )
        still = np.zeros(3 * self._size)  # kernels are compiled, or loaded, before there is anything to do
        tables = self._factors(np.zeros(1)), *self._placed(np.zeros(1))
        march(0, 0.0, self.motion, *tables, still, still.copy(), still.copy(), self._room(still))

    def march(self, state: State, step: float, most: int) -> tuple[Advance, int]:
        """At most so many steps of velocity Verlet, as many as take some hundredths of a second; fewer before
        one that overflows. Raises StepFailed where that is the first."""
        steps = min(most, self._at_once)
        while True:
            u, v, a = (self.flat(vector) for vector in (state.u, state.v, state.a))
            times = np.cumsum(np.append(state.time, np.full(steps, step)))  # as they add up one by one
            tables = self._factors(times), *self._placed(times)
            taken, dissipated, work = march(steps, step, self.motion, *tables, u, v, a, self._room(u))
            if taken == steps:
                after = State(float(times[-1]), self.by_mass(u), self.by_mass(v), self.by_mass(a))
                return Advance(after, dissipated, work), steps
            if taken == 0:
                raise StepFailed("a number overflowed")
            steps = taken

    def flat(self, vector: np.ndarray) -> np.ndarray:
        """A vector (n, 3) at the places, (3 s,)."""
        out = np.zeros((3, self._size))
        out[:, : self._count] = vector[self._order].T
        return out.ravel()

    def by_mass(self, flat: np.ndarray) -> np.ndarray:
        """A vector (3 s,) by masses, (n, 3)."""
        out = np.empty(self._shape)
        out[self._order] = flat.reshape(3, self._size)[:, : self._count].T
        return out

    def _room(self, u: np.ndarray) -> Room:
        """Where steps of the displacement u (3 s,) are computed."""
        kind = self.motion.packing.rest.dtype
        x = np.zeros(len(u), kind) if self.motion.single else u
        w, d, force, damping = (np.zeros(len(u), kind) for _ in range(4))
        load, before, moved = (np.zeros(len(u)) for _ in range(3))
        tile = scratch(self.motion.packing).tile
        return Room(x, w, d, force, damping, tile, load, before, moved, np.zeros(len(self._driven)))

    def _factors(self, times: np.ndarray) -> np.ndarray:
        """Factors of the loads' histories at times (k,) [s], (k, parts)."""
        ones = np.ones(len(times))
        return np.stack([ones if p.history is None else p.history.at(times) for p in self._parts], axis=1)

    def _placed(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Displacement [m] of what is driven, and its velocity [m/s], at times (k,) [s]: (k, driven) each."""
        if not len(self._driven):
            nothing = np.empty((len(times), 0))
            return nothing, nothing
        rows, axes = self._driven.T
        place = np.stack([self._system.place(time)[rows, axes] for time in times])
        return place, np.stack([self._system.place_rate(time)[rows, axes] for time in times])

    def _of_masses(self, values: np.ndarray) -> np.ndarray:
        return np.repeat(values[:, None], 3, axis=1)

    def _places(self, masses: np.ndarray, axes: np.ndarray) -> np.ndarray:
        """Flat places of components of masses."""
        return (axes * self._size + self._place[masses]).astype(np.uint64)

    def _followers(self) -> Followers:
        lattice = self._system.assembly.lattice
        layers, plane = lattice.grid[2], self._count // lattice.grid[2]
        positions = self.flat(lattice.positions).reshape(3, self._size)
        positions[:, self._count :] = positions[:, : self._count].reshape(3, layers, plane).mean(axis=1)
        pressure = np.array([part.pressure for part in self._parts])
        cells = next(cells.nodes for cells in lattice.cells if cells.name == "mid_area")
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
