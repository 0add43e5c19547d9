"""Work and power put into a lattice by moving supports, commands, loads without a potential, obstacles and
natural states that change."""

from __future__ import annotations

import numpy as np

from lumped.dynamics.system import State, System

NATURAL_STEP = 1e-3  # of a natural state, for the difference of energies


def work(system: System, before: State, after: State) -> float:
    """Return the work [J] of moving supports, commands, obstacles, natural states and loads without a
    potential in a step, by the trapezoidal rule."""
    done, motion = imposed_work(system, before, after), system.prescribed
    if motion.moving:
        moved = motion.place(after.time) - motion.place(before.time)
        done += 0.5 * float(np.sum((system.exerted(before) + system.exerted(after)) * moved))
    if system.working:
        mean = 0.5 * (system.external(before.u, before.time) + system.external(after.u, after.time))
        done += float(np.sum((mean - system.problem.loads.dead) * (after.u - before.u)))
    then, now = system.drive(before.time), system.drive(after.time)
    for item in system.items if system.pushed else ():
        exerted = item.exerted((before.u, then), before.v) + item.exerted((after.u, now), after.v)
        done += 0.5 * exerted.sum(axis=0) @ (item.place(*now) - item.place(*then))
    return done


def imposed_work(system: System, before: State, after: State) -> float:
    """Return the work [J] of commands and natural states in a step, at its start until its middle and at its
    end from there on, and what the masses gain that move as prescribed."""
    middle, done = 0.5 * (before.time + after.time), 0.0
    for u, then, now in ((before.u, before.time, middle), (after.u, middle, after.time)):
        done += natural_work(system, u, then, now)
        if system.coupling is not None:
            done += system.coupling.command_work(u, system.drive(then), system.drive(now))
    if system.prescribed.moving:
        done += kinetic_of_placed(system, after) - kinetic_of_placed(system, before)
    return done


def kinetic_of(system: System, rate: np.ndarray) -> float:
    """Return the kinetic energy [J] of what is prescribed, at its velocities (size, 3) [m/s]."""
    return 0.5 * float(np.vdot(rate, system.momentum(rate)))


def kinetic_of_placed(system: System, state: State) -> float:
    """Return the kinetic energy [J] of what is prescribed, whose gain is work done on the masses: all but
    that of the free unknowns, which is separate since Tᵀ M ġ = 0."""
    momentum = system.momentum(state.v)
    free = system.reduce(momentum)
    return 0.5 * float(np.vdot(state.v, momentum) - free @ system.solve_mass(free))


def obstacle_work(system: System, start: State, end: np.ndarray, middle: float) -> float:
    """Return the work [J] of what items are fixed to in a step of the conserving midpoint rule."""
    done, (since, drive) = 0.0, system.ends(start, middle)
    rate = (end - start.u) / (2.0 * (middle - start.time))
    for item in system.items:
        force = np.zeros_like(end)
        item.add_force((end, drive), force, since)
        item.add_resistance((0.5 * (start.u + end), system.drive(middle)), rate, force)
        done -= force.sum(axis=0) @ (item.place(*drive) - item.place(*since[1]))
    return float(done)


def obstacle_power(system: System, state: State) -> float:
    """Return the power [W] of what items are fixed to, as it moves."""
    at = state.u, system.drive(state.time)
    return float(sum(one.exerted(at, state.v).sum(0) @ one.velocity(state.time) for one in system.items))


def natural_work(system: System, u: np.ndarray, then: float, now: float) -> float:
    """Return the work [J] of a natural state that changes while the sheet stays at u (n, 3) [m]."""
    if (state := system.growing) is None:
        return 0.0
    before, after = (state.at(time=time).force(u)[0] for time in (then, now))
    return float(after - before)


def natural_power(system: System, u: np.ndarray, time: float, before: bool = False) -> float:
    """Return its power [W] from a moment on, or until then: of a difference that is exact but for third
    powers of the change."""
    if (state := system.growing) is None or not (rate := state.rates(time, before)).any():
        return 0.0
    at, step = state.factors(time), NATURAL_STEP / np.abs(rate).max()
    before, after = (state.of(at + way * step * rate).force(u)[0] for way in (-1.0, 1.0))
    return float(after - before) / (2.0 * step)
