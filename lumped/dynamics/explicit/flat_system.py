"""A system without chains as arrays for compiled steps.

Prescribed motions and the factors of loads are tabulated for a number of steps at a time.
"""

import numpy as np

from lumped.dynamics.explicit.steps import ExplicitArrays, ExplicitLoads, march
from lumped.dynamics.system import State, System
from sheetbench.numerics.time.method import Advance, StepFailed

CALL, PER_SPRING = 0.03, 1e-8  # approximate time [s] of a call, and of a step of a spring
LEAST = 8  # steps of a call


class FlatSystem:
    """A system without chains at the places of a packing. arrays: for compiled steps; at_once: number of
    steps of a call."""

    def __init__(self, system: System):
        lattice, packing, parts = system.assembly.lattice, system.packing, system.problem.loads.parts
        self._system, self._parts = system, parts
        self._size, count = 3 * int(packing.size), len(packing.order)
        self._places = np.empty((count, 3), dtype=np.uint64)
        self._places[packing.order] = np.arange(count)[:, None] + np.arange(3) * int(packing.size)
        self._driven = np.argwhere(system.prescribed.components)
        free, held = _freedom(system)
        of_masses = system.lattice_mass, system.damping.rate
        mass, rate = (self._at_places(np.repeat(x[:, None], 3, 1)) for x in of_masses)
        self.at_once = max(LEAST, round(CALL / (sum(map(len, system.assembly.springs)) * PER_SPRING)))
        pressure = np.stack([part.pressure for part in parts])
        cells = count + self._places[lattice.mid_cells[:, :, 0], 0]
        self.arrays = ExplicitArrays(
            packing,
            ExplicitLoads(
                np.stack([self._at_places(part.dead) for part in parts]),
                self._at_places(lattice.positions),
                cells if pressure.any() else cells[:0],
                pressure,
                self._places[np.concatenate([part.columns for part in parts]), 0],
                np.concatenate([part.moments for part in parts]),
                np.repeat(np.arange(len(parts)), [len(part.moments) for part in parts]),
            ),
            mass,
            np.divide(1.0, mass, out=np.zeros_like(mass), where=self._at_places(free) > 0.0),
            rate if rate.any() else np.empty(0),
            self._places.ravel()[held],
            self._places[tuple(self._driven.T)],
            system.damping.present,
            system.nonconservative,
        )

    def march(self, state: State, step: float, most: int) -> Advance[State]:
        """Return at most `most` steps, as many as take some hundredths of a second, at least `LEAST`, fewer
        before a step that fails. Raises StepFailed if the first one fails."""
        count = min(most, self.at_once)
        while True:
            vectors = [self._at_places(vector) for vector in (state.u, state.v, state.a)]
            times = np.cumsum(np.append(state.time, np.full(count, step)))  # summed step by step
            tables = self._factors(times), *self._prescribed(times)
            finite, steps, dissipated, work = march(count, step, self.arrays, *tables, *vectors)
            if finite:
                after = State(float(times[steps]), *(vector[self._places] for vector in vectors))
                return Advance(after, dissipated, work, steps)
            if steps == 0:
                raise StepFailed("a number overflowed")
            count = steps

    def compile(self) -> None:
        """Compile the steps, or load them from the cache, by a call of no steps."""
        vectors, times = np.zeros((3, *self.arrays.mass.shape)), np.zeros(1)
        march(0, 1.0, self.arrays, self._factors(times), *self._prescribed(times), *vectors)

    def _at_places(self, vector: np.ndarray) -> np.ndarray:
        """Return a vector (n, 3) at the places, (3 s,)."""
        out = np.zeros(self._size)
        out[self._places] = vector
        return out

    def _factors(self, times: np.ndarray) -> np.ndarray:
        """Return the factors of the loads' histories at times (k,) [s], (k, parts)."""
        ones = np.ones(len(times))
        return np.stack([ones if p.history is None else p.history.at(times) for p in self._parts], axis=1)

    def _prescribed(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return prescribed displacements [m] and velocities [m/s] at times (k,) [s], (k, driven) each."""
        if not len(self._driven):
            empty = np.empty((len(times), 0))
            return empty, empty
        system, (rows, axes) = self._system, self._driven.T
        place, rate = np.zeros((2, len(times), *system.prescribed.components.shape))
        for moved, axis, course in system.prescribed.by_supports:
            place[:, moved, axis] = course.at(times)[:, axis, None]
            rate[:, moved, axis] = course.slope(times)[:, axis, None]
        if system.coupling is not None:
            for at, time in enumerate(times):
                place[at] += system.coupling.prescribed_displacement(system.drive(time))
                rate[at] += system.coupling.prescribed_velocity(time)
        # C order, as without prescribed motions, or steps are compiled a second time
        return np.ascontiguousarray(place[:, rows, axes]), np.ascontiguousarray(rate[:, rows, axes])


def _freedom(system: System) -> tuple[np.ndarray, np.ndarray]:
    """Return whether components can move, (n, 3) bool, and the columns (h, layers) of flat components whose
    mean is held."""
    entries = system.transform.tocoo()
    free = np.zeros(system.transform.shape[0], dtype=bool)
    free[entries.row] = True
    component = np.empty(system.transform.shape[1], dtype=int)
    component[entries.col[entries.data > 0.0]] = entries.row[entries.data > 0.0]
    held = entries.data < 0.0  # the last of a column is minus the sum of the others
    rows, others = entries.row[held], component[entries.col[held]]
    layers = system.assembly.lattice.grid[2]
    order = np.argsort(rows, kind="stable")
    rows, others = rows[order].reshape(-1, layers - 1), others[order].reshape(-1, layers - 1)
    return free.reshape(-1, 3), np.concatenate([others, rows[:, :1]], axis=1)
