"""What ends a run early: numbers that overflow, energy from nowhere, cells inside out, stagnation.

Looked at in every sample. The balance of energies, kinetic + elastic + potential + dissipated − work, is
constant in an exact run; a growth of it by as much as the energy that goes round is a divergence. Less than
that is an error of the steps, which the energies of the answer tell, and no fault. What is wrong is reported
with the time, the place on the sheet and what to change.
"""

from __future__ import annotations

import numpy as np

from lumped.dynamics.integrator import Samples
from lumped.dynamics.system import State, System
from lumped.statics.faults import Fault, broken, fastest
from sheetbench.scenes import Status

GROWN = 1.0  # energy from nowhere, relative to the energy that went round, that counts as divergence
MOST_STEPS = 100_000  # of an adaptive integrator between two samples


def check_samples(
    system: System, samples: Samples, rows: np.ndarray, origin: float, largest: np.ndarray
) -> tuple[int, Fault | None]:
    """Return how many samples are sound before the first that is not, and what is wrong with that one.

    rows: of the samples; origin: the balance at the start [J]; largest: the energy so far (k,) [J].
    """
    finite = np.isfinite(rows).all(axis=1)
    with np.errstate(invalid="ignore"):
        gained = rows[:, 1:5].sum(axis=1) - rows[:, 5] - origin
        sound = int(np.argmin(np.append(finite & (gained <= GROWN * largest), False)))
    before, fault = broken(system.assembly, samples.u[:sound])
    if fault is not None:
        return before, Fault(fault.status, f"at {samples.time[before]:.6g} s {fault.message}")
    if sound == len(rows):
        return sound, None
    state = samples.state(sound)
    if finite[sound]:
        return sound, energy_grows(system, state, gained[sound], largest[sound])
    where = fastest(system.assembly.lattice, state.v)
    text = f"at {state.time:.6g} s a number overflowed, first at {where}: use smaller steps"
    return sound, Fault(Status.NON_FINITE, text)


def energy_grows(system: System, state: State, gained: float, round_about: float) -> Fault | None:
    """Whether a run has gained energy [J] from nowhere, beside the energy that went round in it [J]."""
    if gained <= GROWN * round_about:
        return None
    where = fastest(system.assembly.lattice, state.v)
    note = f"at {state.time:.6g} s the energy grows from nothing, fastest at {where}: use smaller steps"
    return Fault(Status.DIVERGED, note)


def stagnates(state: State, taken: int) -> Fault | None:
    """Whether an adaptive integrator has taken too many steps since the last sample."""
    if taken < MOST_STEPS:
        return None
    note = (
        f"at {state.time:.6g} s: {taken} steps without reaching the next sample: add damping or fix the step"
    )
    return Fault(Status.STEP_LIMIT, note)
