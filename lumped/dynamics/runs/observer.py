"""Rows of numbers from the samples of a run: energies, probes, reactions, actuator forces; largest strains,
invalid states, and the place of the fastest mass.

Systems without chains, branches and obstacles have all rows of a step in one compiled call; others one call a
row.
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

ROUNDED = 1e-9  # share of the flat sheet's energy by a natural state below which energies are rounding


class Observed(NamedTuple):
    """Arrays of `observe`. forces: of the lattice; mass: M; dead: (n, 3) [N] loads with a potential; probes:
    (3 p, 3 n) map of a displacement to the probes; supports: (3 s, 3 n) map of forces on masses to each
    support's force."""

    forces: MovingForces
    mass: Rows
    dead: np.ndarray
    probes: Rows
    supports: Rows


class LatticeObserver:
    """The observer (`sheetbench.runs.run`) of a system.

    Parameters
    ----------
    system : System
        Equations of motion.
    drawn : ndarray, optional
        Rows of the displacement in a frame; by default all.
    """

    def __init__(self, system: System, drawn: np.ndarray | None = None):
        flat = np.zeros((system.assembly.pattern.size, 3))
        self.least_energy = ROUNDED * system.assembly.force(flat)[0]
        self._system, self._drawn = system, slice(None) if drawn is None else drawn
        scene, lattice = system.scene, system.assembly.lattice
        self._probes = MidSurface(lattice, scene.probe_points())
        self._supports = list(system.problem.constraints.holders)
        zero = np.zeros((system.assembly.pattern.size, 3))
        actuators = system.coupling.wrenches(zero, zero) if system.coupling is not None else {}
        holders = system.coupling.reactions(zero) if system.coupling is not None else {}
        exerting = [*self._supports, *(item.name for item in system.contacts), *holders]
        self.columns = columns_of(scene, exerting, actuators)
        self._width = width(self.columns)
        self._observed: Observed | None = None
        if system.packed and system.coupling is None and not system.contacts:
            masses = system.assembly.pattern.size
            probes, summed = csr_arrays(self._probes.matrix(masses)), system.problem.constraints.summed
            equations = system.forces, system.mass_rows, system.problem.loads.dead
            self._observed = typed(Observed(*equations, probes, summed))

    def inspect(self, samples: LatticeSamples, count: int) -> tuple[np.ndarray, Fault | None]:
        """Return the largest strain of a link in each of the first `count` samples before an invalid one, and
        its fault (`lumped.statics.faults`)."""
        assembly, strains, fault = self._system.assembly, np.empty(0), None
        if assembly.natural is None:
            return inspect(assembly, samples.u[:count])
        while fault is None and len(strains) < count:
            i = len(strains)
            strain, fault = inspect(assembly.at(time=float(samples.time[i])), samples.u[i : i + 1])
            strains = np.append(strains, strain)
        return strains, fault

    def beyond(self, stretch: float) -> str:
        """Return a clause if a stretch exceeds the range of the law of strain, else ""."""
        system = self._system
        return "" if system.assembly.any_strain else outside_model(system.scene, stretch, STRETCH)

    def fastest(self, samples: LatticeSamples, i: int) -> str:
        """Return the fastest mass's place."""
        return fastest(self._system.assembly.lattice, samples.v[i])

    def frame(self, samples: LatticeSamples, i: int) -> np.ndarray:
        """Return the rows of sample i's displacement that pictures show."""
        return samples.u[i][self._drawn]

    def rows(self, samples: LatticeSamples) -> np.ndarray:
        """Return the numbers of samples, (k, width)."""
        system, rows = self._system, np.empty((len(samples.time), self._width))
        rows[:, 0], rows[:, 4], rows[:, 5] = samples.time, samples.dissipated, samples.work
        motion = system.prescribed
        if motion.by_supports:  # integrators have the accelerations without the prescribed ones
            prescribed = np.array([motion.support_acceleration(time) for time in samples.time.tolist()])
            samples = samples._replace(a=samples.a + prescribed)
        if self._observed is None:
            for i, row in enumerate(rows):
                self._fill(row, samples, i)
            return rows
        loads = system.problem.loads.dead[None]
        if system.nonconservative:
            loads = np.array([system.external(*at) for at in zip(samples.u, samples.time, strict=True)])
        observe(samples.u, samples.v, samples.a, loads, self._observed, rows)
        return rows

    def _fill(self, row: np.ndarray, samples: LatticeSamples, i: int) -> None:
        """Set energies, probes and forces in the row of sample i."""
        system, u = self._system, samples.u[i]
        energies, exerted = system.balance(samples.state(i))
        row[1:4] = list(energies.values())
        reactions, _ = system.problem.constraints.reactions(exerted)
        parts = [self._probes.of(u), *(reactions[edge] for edge in self._supports)]
        state = samples.state(i)
        at = u, system.drive(state.time)
        parts.extend(item.exerted(at, state.v).sum(axis=0) for item in system.contacts)
        if system.coupling is not None:
            parts.extend(system.coupling.reactions(exerted).values())
            parts.extend(system.coupling.wrenches(u, exerted).values())
        row[6:] = np.concatenate([part.ravel() for part in parts])


@njit
def observe(
    u: np.ndarray, v: np.ndarray, a: np.ndarray, loads: np.ndarray, observed: Observed, rows: np.ndarray
) -> None:
    """Set the rows of states (k, n, 3) under loads (k, n, 3) [N], (1, n, 3) if constant: the kinetic, elastic
    and potential energy [J], the probes' displacements [m], the supports' forces [N]."""
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
