"""What a run says of its samples: energies, probes, reactions, actuator forces, as rows of numbers; strains,
states that mean nothing, and where the sheet is fastest.

All rows of a step in one compiled call, for systems without chains and branches; call
by call for the others.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.dynamics.damping import MovingForces, add_forces
from lumped.dynamics.integrator import LatticeSamples
from lumped.dynamics.system import System
from lumped.mid_surface import MidSurface
from lumped.springs.tiles import NUMBA_TRUE
from lumped.statics.faults import fastest, inspect
from lumped.statics.problem import STRETCH
from sheetbench.numerics.aliasing import empty
from sheetbench.numerics.continuation.path import Fault
from sheetbench.numerics.options import njit, typed
from sheetbench.numerics.sparse_products import Rows, add_product, csr_arrays, product
from sheetbench.runs.record import columns_of, width
from sheetbench.scenes import outside_model

ROUNDED = 1e-9  # of the energy of the flat sheet, of a natural state, below which all is rounding


class Observed(NamedTuple):
    """Forces; M; loads with a potential (n, 3) [N]; what takes a displacement to the probes', (3 p, 3 n), and
    forces on masses to those of each support, (3 s, 3 n)."""

    forces: MovingForces
    mass: Rows
    dead: np.ndarray
    probes: Rows
    supports: Rows


class LatticeObserver:
    """The observer (`sheetbench.runs.run`) of a system. drawn: rows of the displacement that make a frame."""

    def __init__(self, system: System, drawn: np.ndarray | None = None):
        flat = np.zeros((system.assembly.pattern.size, 3))
        self.least_energy = ROUNDED * system.assembly.force(flat)[0]
        self._system, self._drawn = system, slice(None) if drawn is None else drawn
        scene, lattice = system.scene, system.assembly.lattice
        self._probes = MidSurface(lattice, scene.probe_points())
        self._supports = list(system.problem.constraints.holders)
        nothing = np.zeros((system.assembly.pattern.size, 3))
        actuators = system.coupling.wrenches(nothing, nothing) if system.coupling is not None else {}
        holders = system.coupling.reactions(nothing) if system.coupling is not None else {}
        exerting = [*self._supports, *(item.name for item in system.items), *holders]
        self.columns = columns_of(scene, exerting, actuators)
        self._width = width(self.columns)
        self._observed: Observed | None = None
        if system.packed and system.coupling is None and not system.items:
            masses = system.assembly.pattern.size
            observed = Observed(
                system.forces,
                system.mass_rows,
                system.problem.loads.dead,
                csr_arrays(self._probes.matrix(masses)),
                system.problem.constraints.summed,
            )
            self._observed = typed(observed)

    def inspect(self, samples: LatticeSamples, count: int) -> tuple[np.ndarray, Fault | None]:
        """Return the largest strain of a link in each of the first samples before one that means nothing, and
        why that one does not: `lumped.statics.faults`."""
        assembly, strains, fault = self._system.assembly, np.empty(0), None
        if assembly.natural is None:
            return inspect(assembly, samples.u[:count])
        while fault is None and len(strains) < count:
            i = len(strains)
            found, fault = inspect(assembly.at(time=float(samples.time[i])), samples.u[i : i + 1])
            strains = np.append(strains, found)
        return strains, fault

    def beyond(self, stretch: float) -> str:
        """Return a clause where the law of strain does not hold that far, else ""."""
        system = self._system
        return "" if system.assembly.any_strain else outside_model(system.scene, stretch, STRETCH)

    def fastest(self, samples: LatticeSamples, i: int) -> str:
        """Return the fastest mass's place."""
        return fastest(self._system.assembly.lattice, samples.v[i])

    def frame(self, samples: LatticeSamples, i: int) -> np.ndarray:
        """Return the drawn rows of a displacement."""
        return samples.u[i][self._drawn]

    def rows(self, samples: LatticeSamples) -> np.ndarray:
        """Return the numbers of samples, (k, width)."""
        system, rows = self._system, np.empty((len(samples.time), self._width))
        rows[:, 0], rows[:, 4], rows[:, 5] = samples.time, samples.dissipated, samples.work
        motion = system.prescribed
        if motion.by_supports:  # integrators have the accelerations beside what is prescribed
            placed = np.array([motion.support_acceleration(time) for time in samples.time.tolist()])
            samples = samples._replace(a=samples.a + placed)
        if self._observed is None:
            for i, row in enumerate(rows):
                self._fill(row, samples, i)
            return rows
        loads = system.problem.loads.dead[None]
        if system.working:
            loads = np.array([system.external(*at) for at in zip(samples.u, samples.time, strict=True)])
        observe(samples.u, samples.v, samples.a, loads, self._observed, rows)
        return rows

    def _fill(self, row: np.ndarray, samples: LatticeSamples, i: int) -> None:
        """Fill the row of sample i but for what it knows."""
        system, u = self._system, samples.u[i]
        energies, exerted = system.balance(samples.state(i))
        row[1:4] = list(energies.values())
        reactions, _ = system.problem.constraints.reactions(exerted)
        parts = [self._probes.of(u), *(reactions[edge] for edge in self._supports)]
        state = samples.state(i)
        parts.extend(one.exerted((u, system.drive(state.time)), state.v).sum(axis=0) for one in system.items)
        if system.coupling is not None:
            parts.extend(system.coupling.reactions(exerted).values())
            parts.extend(system.coupling.wrenches(u, exerted).values())
        row[6:] = np.concatenate([part.ravel() for part in parts])


@njit
def observe(
    u: np.ndarray, v: np.ndarray, a: np.ndarray, loads: np.ndarray, observed: Observed, rows: np.ndarray
) -> None:
    """Fill the rows of states (k, n, 3) under loads (k, n, 3), or (1, n, 3) if they stay the same [N]: the
    kinetic, elastic and potential energy [J], the probes' displacements [m], the supports' forces [N]."""
    mass, dead = observed.mass, observed.dead.ravel()
    first, last, exerted = 6, 5 + len(observed.probes.pointers), empty(u[0].shape)
    for k in range(len(u)):
        exerted[:] = 0.0
        elastic, _ = add_forces(observed.forces, u[k], v[k], NUMBA_TRUE, NUMBA_TRUE, exerted)
        forces, speed, gained = exerted.ravel(), v[k].ravel(), a[k].ravel()
        place, acting = u[k].ravel(), loads[min(k, len(loads) - 1)].ravel()
        momentum, kinetic, potential = product(mass, speed), 0.0, 0.0
        for row in range(len(forces)):
            forces[row] -= acting[row]
            potential -= dead[row] * place[row]
            kinetic += 0.5 * speed[row] * momentum[row]
        add_product(mass, 1.0, gained, forces)
        rows[k, 1], rows[k, 2], rows[k, 3] = kinetic, elastic, potential
        rows[k, first:last] = product(observed.probes, place)
        rows[k, last:] = product(observed.supports, forces)
