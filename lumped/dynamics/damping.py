"""The dampers of a scene on a lattice: link dampers, area dampers, mass-proportional damping.

Every link's damper acts along the link (`lumped.springs.link_dampers`). Its coefficient is that of the
scene's [dampers] table by family, or else damping_time × k; area and strain springs have dampers with
damping_time only (`lumped.springs.area_dampers`, `lumped.springs.strain_dampers`), since the table has no
entry for them. damping_rate × m v acts on every mass. What has a zero coefficient is not assembled.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from lumped.assembly import Assembly, Cells
from lumped.lattice import Lattice
from lumped.moduli import family_stiffness
from lumped.springs import area_dampers, strain_dampers
from lumped.springs import link_dampers as dampers
from sheetbench.scenes import Scene
from sheetbench.scenes.errors import BadInput


class Damping:
    """Damping forces, (size, 3) [N], on masses and actuators' rows. mass: (n,) [kg].

    present: whether there are any; proportional: to the stiffness and the masses, in the flat sheet.
    """

    def __init__(self, scene: Scene, assembly: Assembly, mass: np.ndarray):
        self._coupling = assembly.coupling
        self._coupling_slots = assembly.coupling_slots if assembly.coupling is not None else np.empty(0, int)
        self._rate = scene.material.damping_rate * mass
        time = scene.material.damping_time
        if scene.dampers is not None:
            parts = _table(scene.dampers, assembly.lattice)
        else:
            k = [assembly.links.stiffness, assembly.directional.stiffness.mean(axis=-1)]
            parts = [
                (links.nodes, links.offset, links.rest_length, time * stiffness)
                for links, stiffness in zip((assembly.links, assembly.directional), k, strict=True)
                if len(links)
            ]
        nodes, offset, rest, damping = (np.concatenate(part) for part in zip(*parts, strict=True))
        some = damping > 0.0
        self._links = (nodes[some], offset[some], rest[some], damping[some])
        a, b = self._links[0].T
        self._link_slots = np.stack([assembly.pattern.slots(*p) for p in ((a, a), (a, b), (b, a), (b, b))], 1)
        self._cells: list[tuple[Any, Cells, np.ndarray]] = []  # kernels, cells, coefficients
        if scene.dampers is None and time > 0.0:
            self._cells += [(area_dampers, c, time * c.stiffness) for c in assembly.cells]
            self._cells += [(strain_dampers, c, time * c.stiffness) for c in assembly.strains]
        self._diagonal = assembly.pattern.slots(np.arange(len(mass)), np.arange(len(mass)))
        in_chains = any(getattr(a, "damping_time", 0.0) > 0.0 for a in scene.actuators)
        self.proportional = scene.dampers is None and not scene.actuators and not len(assembly.directional)
        self.present = bool(some.any() or self._cells or self._rate.any() or in_chains)

    def add_force(self, u: np.ndarray, v: np.ndarray, force: np.ndarray) -> float:
        """Add the damping force, signed as an internal one; the power taken [W]."""
        if not self.present:
            return 0.0
        power = dampers.add_forces(u, v, *self._links, force)
        for kernels, c, damping in self._cells:
            power += kernels.add_forces(u, v, c.nodes, c.diagonals, damping, force)
        masses = len(self._rate)
        resisting = self._rate[:, None] * v[:masses]
        force[:masses] += resisting
        power += float(np.sum(resisting * v[:masses]))
        if self._coupling is not None:
            power += self._coupling.add_damping_force(u, v, force)
        return power

    def add_velocity_tangent(self, u: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        """Add scale × the derivative of the force by the velocity to the 3×3 blocks."""
        if not self.present:
            return
        dampers.add_velocity_tangent(u, *self._links, self._link_slots, scale, blocks)
        for kernels, c, damping in self._cells:
            kernels.add_velocity_tangent(u, c.nodes, c.diagonals, damping, c.slots, scale, blocks)
        blocks[self._diagonal] += scale * self._rate[:, None, None] * np.eye(3)
        if self._coupling is not None:
            self._coupling.add_damping_tangent(u, scale, self._coupling_slots, blocks)

    def add_displacement_tangent(self, u: np.ndarray, v: np.ndarray, blocks: np.ndarray) -> None:
        """Add the derivative of the lattice's damping force by the displacement, which is unsymmetric."""
        if not self.present:
            return
        dampers.add_displacement_tangent(u, v, *self._links, self._link_slots, blocks)
        for kernels, c, damping in self._cells:
            kernels.add_displacement_tangent(u, v, c.nodes, c.diagonals, damping, c.slots, blocks)

    def link_weights(self, h: float) -> tuple[np.ndarray, np.ndarray]:
        """Slots (m, 4) and c/h (m,) [N/m] of the link dampers: what they add to a step's stiffness."""
        return self._link_slots, self._links[3] / h

    def cell_weights(self, h: float) -> list[tuple[Cells, np.ndarray]]:
        """The damped cells with c/h [N/m]."""
        return [(c, damping / h) for _, c, damping in self._cells]


def _table(table: Any, lattice: Lattice) -> list[tuple[np.ndarray, ...]]:
    parts: list[tuple[np.ndarray, ...]] = []
    for family in lattice.links:
        c = family_stiffness(table, family.name, family.direction)
        if np.ndim(c):
            raise BadInput(
                f"dampers.{family.name}: a damper acts along its link; give one number, or x and y"
            )
        parts.append((family.nodes, family.offset, family.rest_length, family.weight * float(np.max(c))))
    return parts
