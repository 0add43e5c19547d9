"""Damping of a scene's lattice: link dampers, area dampers, mass-proportional damping, the air's drag.

Every link's damper acts along the link (`lumped.springs.links`). Its coefficient is in the scene's [dampers]
table by family, or else damping_time × k; area and strain springs have dampers with damping_time only
(`lumped.springs.cells`), since the table has no entry for them. damping_rate × m v acts on every mass, and
drag (`lumped.dynamics.drag`) in air. Dampers with a zero coefficient are not assembled.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from lumped.assembly import Assembly
from lumped.dynamics import drag
from lumped.springs.all_families import AllFamilies, table_dampers
from lumped.springs.families import Family
from lumped.springs.packed_forces import add_damping_from_shapes
from lumped.springs.packed_forces import add_forces as add_spring_forces
from lumped.springs.packing import Packing, Scratch
from sheetbench.numerics.options import njit
from sheetbench.scenes import Scene


class Damping:
    """Damping forces, (size, 3) [N], on masses and actuators' rows. mass: (n,) [kg].

    dampers: of the lattice's springs; time [s]: coefficient over stiffness if equal for all springs, else 0;
    rate: of the masses (n,) [kg/s]; drag: of the air; present: whether there is any damping; proportional:
    whether it is proportional to the stiffness and the masses, in the flat sheet.
    """

    def __init__(self, scene: Scene, assembly: Assembly, mass: np.ndarray):
        self.drag, self._diagonal = drag.of_scene(scene, assembly), assembly.pattern.diagonal[: len(mass)]
        self.rate = scene.material.damping_rate * mass
        self.time = 0.0
        if scene.dampers is not None:
            self.dampers: list[Family] = [table_dampers(assembly.lattice, assembly.pattern, scene.dampers)]
        else:
            time = scene.material.dashpot_time
            self.dampers = assembly.all_families.damped(time) if time else []
            self.time = time if assembly.conservative else 0.0
        separate = self.dampers and not self.time
        self._unproportional = AllFamilies(self.dampers, assembly.pattern) if separate else None
        in_chains = any(getattr(a, "damping_time", 0.0) > 0.0 for a in scene.actuators)
        others = scene.dampers or scene.actuators or self.drag.coefficient
        self.proportional = not others and assembly.conservative
        self.present = bool(self.dampers or self.rate.any() or in_chains or self.drag.coefficient)

    def add_velocity_tangent(self, u: np.ndarray, v: np.ndarray, scale: float, blocks: np.ndarray) -> None:
        """Add scale × the derivative of the force by the velocity to the 3×3 blocks, without the dampers
        proportional to the springs (`time`) and to the masses (`rate`)."""
        if self._unproportional is not None:
            blocks += self._unproportional.tangent(u, share=0.0, scale=scale)
        if self.drag.coefficient:
            blocks[self._diagonal] += scale * drag.velocity_tangent(self.drag, u, v)


class MovingForces(NamedTuple):
    """Arrays of a lattice in motion for compiled loops. packing: springs and dampers; scratch: work arrays;
    rate: (n,) [kg/s] damping of the masses; drag: of the air."""

    packing: Packing
    scratch: Scratch
    rate: np.ndarray
    drag: drag.LatticeDrag


@njit
def add_forces(
    forces: MovingForces, u: np.ndarray, v: np.ndarray, elastic: bool, damped: bool, out: np.ndarray
) -> tuple[float, float]:
    """Add the springs' force at a displacement (n, 3) [m], if elastic, and the damping force at a velocity
    (n, 3) [m/s], if damped, to `out` (n, 3) [N]; return the energy [J] and the power taken [W]."""
    energy, power, resists = 0.0, 0.0, damped and forces.packing.damped
    if damped:
        power = add_resistance(forces, u, v, out)
    if elastic or resists:
        energy, taken = add_spring_forces(u, v, elastic, resists, forces.packing, forces.scratch, out)
        power += taken
    return energy, power


@njit
def add_resistance(forces: MovingForces, u: np.ndarray, v: np.ndarray, out: np.ndarray) -> float:
    """Add the forces of the masses' damping and of the air; return the power taken [W]."""
    power = drag.add_drag(forces.drag, u, v, out)
    for i in range(len(forces.rate)):
        for q in range(3 if forces.rate[i] else 0):
            resisting = forces.rate[i] * v[i, q]
            out[i, q] += resisting
            power += resisting * v[i, q]
    return power


@njit
def add_damping_again(
    forces: MovingForces, u: np.ndarray, v: np.ndarray, pushed: bool, out: np.ndarray
) -> float:
    """Return the power [W] of all damping at velocity v (n, 3) [m/s], at the displacement of the last
    `add_forces`; add the springs' dampers' force to `out` only if `pushed`."""
    power = add_resistance(forces, u, v, out)
    if forces.packing.damped:
        power += add_damping_from_shapes(v, pushed, forces.packing, forces.scratch, out)
    return power
