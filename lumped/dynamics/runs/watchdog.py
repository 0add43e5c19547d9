"""What ends a run early: numbers that overflow, energy from nowhere, cells inside out, stagnation.

Looked at in every sample. What is wrong is reported with the time, the place on the sheet and what to change.
"""

from __future__ import annotations

import numpy as np

from lumped.dynamics.integrator import Samples
from lumped.dynamics.system import State, System
from lumped.statics.faults import Fault, broken, fastest
from lumped.statics.structure import STRETCH
from sheetbench.runs.watch import GROWN, Watch
from sheetbench.scenes import Status, outside_model

MOST_STEPS = 100_000  # of an adaptive integrator between two samples


def check_samples(
    system: System, samples: Samples, rows: np.ndarray, watch: Watch
) -> tuple[int, Fault | None]:
    """Return how many samples are sound before the first that is not, and what is wrong with that one; rows:
    of the samples, whose sound ones the watch takes."""
    grown = watch.grown(rows)
    sound = int(np.argmin(np.append(grown <= GROWN, False)))
    before, fault = broken(system.assembly, samples.u[:sound])
    watch.take(rows[:before])
    if not system.assembly.any_strain:
        for time, u in zip(samples.time[:before].tolist(), samples.u[:before], strict=True):
            links = system.assembly.links
            system.assembly.grow(time=time)
            stretch = links.largest_strain(links.elongations(u))
            watch.strained(time, stretch, bool(outside_model(system.scene, stretch)))
    if fault is not None:
        return before, Fault(fault.status, f"at {samples.time[before]:.6g} s {fault.message}")
    if sound == len(rows):
        return sound, None
    state, lattice = samples.state(sound), system.assembly.lattice
    if np.isfinite(grown[sound]):
        text = (
            f"at {state.time:.6g} s the energy has grown from nothing, by {100.0 * grown[sound]:.3g} % of "
            f"the largest, fastest at {fastest(lattice, state.v)}: use smaller steps"
        )
        return sound, Fault(Status.DIVERGED, text)
    text = (
        f"at {state.time:.6g} s a number overflowed, first at {fastest(lattice, state.v)}: use smaller steps"
    )
    return sound, Fault(Status.NON_FINITE, text)


def ending(system: System, watch: Watch) -> tuple[Status, str]:
    """The status of a run that came to its end, and what there is to say."""
    strained = not system.assembly.any_strain
    return watch.ending(outside_model(system.scene, watch.stretch, STRETCH) if strained else "")


def stagnates(state: State, taken: int) -> Fault | None:
    """Whether an adaptive integrator has taken too many steps since the last sample."""
    if taken < MOST_STEPS:
        return None
    note = (
        f"at {state.time:.6g} s: {taken} steps without reaching the next sample: add damping or fix the step"
    )
    return Fault(Status.STEP_LIMIT, note)
