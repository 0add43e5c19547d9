"""What a run writes down at a sample: probes, energies, reactions, actuator forces, as a row of numbers."""

from __future__ import annotations

import numpy as np

from lumped.dynamics.runs.observation import Observed, observe
from lumped.dynamics.system import State, System
from lumped.mid_surface import MidSurface
from sheetbench.numerics.maps import csr_arrays
from sheetbench.runs.columns import Part, width
from sheetbench.scenes.history import ENERGIES


class Sampling:
    """Rows of samples of a system; names and widths of their parts in `columns`, time first."""

    def __init__(self, system: System):
        self._system = system
        scene, lattice = system.scene, system.assembly.lattice
        self._probes = MidSurface(lattice, scene.probe_points())
        self._supports = list(system.problem.constraints.holders)
        nothing = np.zeros((system.assembly.pattern.size, 3))
        actuators = system.coupling.wrenches(nothing, nothing) if system.coupling is not None else {}
        holders = system.coupling.reactions(nothing) if system.coupling is not None else {}
        self.columns: list[Part] = [
            ("time", "", ()),
            *(("energy", name, ()) for name in ENERGIES),
            *(("probe", name, (3,)) for name in scene.probes),
            *(("reaction", edge, (3,)) for edge in [*self._supports, *holders]),
            *(("actuator", name, wrench.shape) for name, wrench in actuators.items()),
        ]
        self._observed: Observed | None = None
        plain = system.coupling is None and system.maxwell is None
        if plain and system.assembly.precision == "double":
            masses = system.assembly.pattern.size
            self._observed = Observed(
                system.packing,
                system.scratch,
                csr_arrays(system.mass),
                system.damping.rate,
                system.damping.drag,
                system.problem.loads.dead,
                csr_arrays(self._probes.matrix(masses)),
                system.problem.constraints.summed,
            )
        self.width = width(self.columns)

    def row(self, state: State, dissipated: float, work: float) -> np.ndarray:
        """The sample of a state, (width,)."""
        system = self._system
        if self._observed is not None:
            row, first = np.empty(self.width), 1 + len(ENERGIES)
            last = len(row) - 3 * len(self._supports)
            external = system.external(state.u, state.time)
            found = observe(state.u, state.v, state.a, external, self._observed, row[first:last], row[last:])
            row[:first] = state.time, *found, dissipated, work
            return row
        energies, exerted = system.balance(state)
        energies |= {"dissipated": dissipated, "work": work}
        reactions, _ = system.problem.constraints.reactions(exerted)
        parts = [
            np.array([state.time, *(energies[name] for name in ENERGIES)]),
            self._probes.of(state.u).ravel(),
            *(reactions[edge] for edge in self._supports),
        ]
        if system.coupling is not None:
            parts.extend(system.coupling.reactions(exerted).values())
            parts.extend(w.ravel() for w in system.coupling.wrenches(state.u, exerted).values())
        return np.concatenate(parts)
