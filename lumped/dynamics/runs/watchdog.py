"""What ends a run early: numbers that overflow, energy from nowhere, cells inside out, stagnation.

Looked at once a sample. The balance of energies, kinetic + elastic + potential + dissipated − work, is
constant in an exact run; a growth of it by as much as the energy that goes round is a divergence. Less than
that is an error of the steps, which the energies of the answer tell, and no fault. What is wrong is said with
the time, the place on the sheet and what to change.
"""

from __future__ import annotations

import numpy as np

from lumped.dynamics.system import State, System
from lumped.statics.faults import Fault, broken, fastest
from sheetbench.scenes import Status

GROWN = 1.0  # energy from nowhere, relative to the energy that went round, that counts as divergence
MOST_STEPS = 100_000  # of an adaptive integrator between two samples


def check_sample(
    system: System, state: State, row: np.ndarray, origin: float, round_about: float
) -> Fault | None:
    """Return what is wrong with a sampled state, or None.

    row: its sample; origin: the balance at the start [J]; round_about: the largest energy so far [J].
    """
    lattice, when = system.assembly.lattice, f"at {state.time:.6g} s"
    if not np.isfinite(row).all():
        where = fastest(lattice, state.v)
        return Fault(Status.NON_FINITE, f"{when} a number overflowed, first at {where}: use smaller steps")
    kinetic, elastic, potential, dissipated, work = row[1:6].tolist()
    gained = kinetic + elastic + potential + dissipated - work - origin
    if grows := energy_grows(system, state, gained, round_about):
        return grows
    fault = broken(system.assembly, state.u)
    return None if fault is None else Fault(fault.status, f"{when} {fault.message}")


def energy_grows(system: System, state: State, gained: float, round_about: float) -> Fault | None:
    """Whether a run has gained energy [J] from nowhere, beside the energy that went round in it [J]."""
    if gained <= GROWN * round_about:
        return None
    where = fastest(system.assembly.lattice, state.v)
    said = f"at {state.time:.6g} s the energy grows from nothing, fastest at {where}: use smaller steps"
    return Fault(Status.DIVERGED, said)


def stagnates(state: State, taken: int) -> Fault | None:
    """Whether an adaptive integrator has taken too many steps since the last sample."""
    if taken < MOST_STEPS:
        return None
    said = (
        f"at {state.time:.6g} s: {taken} steps without reaching the next sample: add damping or fix the step"
    )
    return Fault(Status.STEP_LIMIT, said)
