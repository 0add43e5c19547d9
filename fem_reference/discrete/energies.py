"""Energies of a discrete sheet in motion, and the dissipation and work of a step."""

from dataclasses import dataclass, field

import numpy as np

from fem_reference.discrete.elements import DiscreteElements
from fem_reference.shell.element import weighed


@dataclass(frozen=True)
class SheetMotion:
    """Coordinates (N,), their rates, accelerations and the integrator's accelerations at a time [s]. exerted:
    M a + g (N,); memory: of the material's branches."""

    time: float
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    algorithm: np.ndarray
    exerted: np.ndarray
    memory: np.ndarray = field(default_factory=lambda: np.zeros(0))


def energies(sheet: DiscreteElements, motion: SheetMotion) -> tuple[float, float, float]:
    """Return the kinetic, elastic and potential energy [J] of a state in motion, items that store energy
    included."""
    q, v, time = motion.q, motion.v, motion.time
    shape = sheet.shape(q, time, v)
    potential = sum(item.stored(shape) for item in sheet.items)
    elastic = sheet.elastic(shape) + sum(body.energy(q, time) for body in sheet.bodies)
    stored = sheet.branches.stored(motion.memory) if sheet.branches.times else 0.0
    return 0.5 * float(v @ (sheet.mass @ v)), elastic + stored, potential


def dissipation_and_work(
    sheet: DiscreteElements, start: SheetMotion, end: SheetMotion, end_weight: float
) -> np.ndarray:
    """Return the energy [J] dissipated in a step and the work [J] of prescribed motions and loads, (2,). Both
    are forces times changes of coordinates; dampers use the forces that the step balances. end_weight: weight
    of the step's end in those."""
    h, step, middle = end.time - start.time, end.q - start.q, 0.5 * (start.q + end.q)
    rate = (1.0 - end_weight) * start.v + end_weight * end.v
    shape = sheet.shape(middle, 0.5 * (start.time + end.time), step / h)
    damped = 0.0
    if sheet.tau:
        change, by_rate = (sheet.element.step(shape.operator, sheet.gather(of)) for of in (step, rate))
        damped = sheet.tau * float(np.sum(change * weighed(shape.moduli, by_rate)))
    damped += sheet.alpha * float(step @ (sheet.sheet_mass @ rate))
    damped += sheet.branches.dissipated(start.memory, end.memory) if sheet.branches.times else 0.0
    work = float(sheet.of_supports(0.5 * (start.exerted + end.exerted)) @ step)
    for body in sheet.bodies:
        damped += body.dissipated(middle, step, rate)
        for q in (start.q, end.q):  # work of commands, which bend the chains' shape at rest
            work += 0.5 * (body.energy(q, end.time) - body.energy(q, start.time))
    for sign, time in ((1.0, end.time), (-1.0, start.time)) if sheet.natural is not None else ():
        work += 0.5 * sign * sum(sheet.elastic(sheet.shape(q, time)) for q in (start.q, end.q))
    for item in sheet.items:
        lost, gained = item.powers(shape)
        damped, work = damped + h * lost, work + h * gained
    return np.array([damped, work])
