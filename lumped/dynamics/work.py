"""Work and power put into a lattice by moving supports, commands, loads without a potential, obstacles and
natural states that change."""

import numpy as np

from lumped.dynamics.system import State, System

NATURAL_STEP = 1e-3  # change of a natural state for the difference quotient of energies


def work(system: System, before: State, after: State) -> float:
    """Return the work [J] of moving supports, commands, obstacles, natural states and loads without a
    potential in a step, by the trapezoidal rule."""
    done, motion = imposed_work(system, before, after), system.prescribed
    if motion.moving:
        moved = motion.place(after.time) - motion.place(before.time)
        done += 0.5 * float(np.sum((system.exerted(before) + system.exerted(after)) * moved))
    if system.nonconservative:
        mean = 0.5 * (system.external(before.u, before.time) + system.external(after.u, after.time))
        done += float(np.sum((mean - system.problem.loads.dead) * (after.u - before.u)))
    start, end = system.drive(before.time), system.drive(after.time)
    for one in system.contacts if system.pushed else ():
        exerted = one.exerted((before.u, start), before.v) + one.exerted((after.u, end), after.v)
        done += 0.5 * exerted.sum(axis=0) @ (one.obstacle.place(*end) - one.obstacle.place(*start))
    return done


def imposed_work(system: System, before: State, after: State) -> float:
    """Return the work [J] of commands and natural states in a step, plus the gain of kinetic energy of
    prescribed masses. Commands change at the start's displacement in the first half of the step, and at the
    end's in the second."""
    middle, done = 0.5 * (before.time + after.time), 0.0
    for u, start, end in ((before.u, before.time, middle), (after.u, middle, after.time)):
        done += natural_work(system, u, start, end)
        if system.coupling is not None:
            done += system.coupling.command_work(u, system.drive(start), system.drive(end))
    if system.prescribed.moving:
        done += prescribed_kinetic(system, after) - prescribed_kinetic(system, before)
    return done


def kinetic_of(system: System, rate: np.ndarray) -> float:
    """Return the kinetic energy [J] at prescribed velocities (size, 3) [m/s]."""
    return 0.5 * float(np.vdot(rate, system.momentum(rate)))


def prescribed_kinetic(system: System, state: State) -> float:
    """Return the kinetic energy [J] of the prescribed motion, whose gain is work done on the masses: the
    total less the free unknowns' kinetic energy, a separate sum since Tᵀ M ġ = 0."""
    momentum = system.momentum(state.v)
    free = system.reduce(momentum)
    return 0.5 * float(np.vdot(state.v, momentum) - free @ system.solve_mass(free))


def obstacle_work(system: System, start: State, end: np.ndarray, middle: float) -> float:
    """Return the work [J] of the obstacles in a step of the conserving midpoint rule."""
    done, (since, drive) = 0.0, system.ends(start, middle)
    rate = (end - start.u) / (2.0 * (middle - start.time))
    for one in system.contacts:
        force = np.zeros_like(end)
        one.add_force((end, drive), force, since)
        one.add_resistance((0.5 * (start.u + end), system.drive(middle)), rate, force)
        done -= force.sum(axis=0) @ (one.obstacle.place(*drive) - one.obstacle.place(*since[1]))
    return float(done)


def obstacle_power(system: System, state: State) -> float:
    """Return the power [W] of the moving obstacles."""
    at = state.u, system.drive(state.time)
    bodies = ((one.exerted(at, state.v).sum(axis=0), one.obstacle) for one in system.contacts)
    return float(sum(force @ body.velocity(state.time) for force, body in bodies))


def natural_work(system: System, u: np.ndarray, start: float, end: float) -> float:
    """Return the work [J] of a natural state that changes while the sheet stays at u (n, 3) [m]."""
    if (state := system.growing) is None:
        return 0.0
    before, after = (state.at(time=time).force(u)[0] for time in (start, end))
    return float(after - before)


def natural_power(system: System, u: np.ndarray, time: float, before: bool = False) -> float:
    """Return the power [W] of a natural state just after a time, or just before, by a central difference."""
    if (state := system.growing) is None or not (rate := state.rates(time, before)).any():
        return 0.0
    at, step = state.factors(time), NATURAL_STEP / np.abs(rate).max()
    before, after = (state.of(at + way * step * rate).force(u)[0] for way in (-1.0, 1.0))
    return float(after - before) / (2.0 * step)
