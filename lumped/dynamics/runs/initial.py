"""The initial state of a run."""

import numpy as np
import scipy.linalg
import scipy.sparse as sp

from lumped.calibration import Calibration
from lumped.dynamics.explicit.step_limit import soften_contacts
from lumped.dynamics.system import State, System
from lumped.lattice import Weights
from lumped.statics.solver import build_problem, stable_equilibrium
from sheetbench.errors import NoEquilibrium
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.motion import NO_START, at_start, starts_flat, without_held_loads


def in_motion(scene: Scene, calibration: Calibration, weights: Weights = "tributary") -> tuple[System, State]:
    """Return the equations of motion of a scene and the initial state.

    Parameters
    ----------
    scene : Scene
        Sheet, supports, loads and commands; loads marked `hold` act before the motion only.
    calibration : Calibration
        Springs of the lattice.
    weights : {"tributary", "full"}, default "tributary"
        Shares of boundary links and masses: by tributary area, or full ones (Habibi et al.).

    Returns
    -------
    system : System
        Forces, mass and constraints of the motion.
    state : State
        State at t = 0: displacement [m], velocity [m/s] and acceleration [m/s²], (size, 3) each.

    Raises
    ------
    NoEquilibrium
        If the motion starts from an equilibrium and there is no stable one.
    """
    moving = without_held_loads(scene)
    system = System(moving, build_problem(moving, calibration, weights))
    soften_contacts(system)
    return system, initial_state(system, calibration, weights, scene)


def initial_state(
    system: System, calibration: Calibration, weights: Weights, scene: Scene | None = None
) -> State:
    """Return the state at rest, flat or in the equilibrium that the scene starts from
    (`scenes.meaning.motion`), with its acceleration by loads and commands. scene: the system's scene with the
    loads that are released.

    Raises NoEquilibrium without a stable equilibrium.
    """
    u, scene = system.prescribed.place(0.0), system.scene if scene is None else scene
    if not starts_flat(scene):
        still = at_start(scene)
        try:
            u = stable_equilibrium(build_problem(still, calibration, weights)).u
        except NoEquilibrium as error:
            raise NoEquilibrium(f"{NO_START}: {error}") from None
    memory = None if system.maxwell is None else system.maxwell.at_rest(u)
    v = system.prescribed.rate(0.0)
    v = v if system.prescribed.moving else np.zeros_like(u)
    a = system.accelerate(system.for_step(State(0.0, u, v, v, memory)).unbalanced(u, v, 0.0))
    if system.constrained:
        u, a = _with_multipliers(system, u, a)
    return State(0.0, u, v, a, memory)


def _with_multipliers(system: System, u: np.ndarray, a: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return u with the multipliers μ of the chains' constraints, and a less M⁻¹ Jᵀ μ, with which J a = 0.

    Only the chains' rows appear in J, and the mass couples them with nothing else: a small dense matrix
    J M⁻¹ Jᵀ. Source: Andersen (1983), RATTLE.
    """
    coupling = system.coupling
    assert coupling is not None
    masses, order = coupling.masses, np.flatnonzero(coupling.algebraic[coupling.masses :].ravel())
    rows_of = sp.csc_array(system.moving_part[3 * masses :])
    unknown = np.flatnonzero(np.diff(rows_of.indptr))
    gradient = coupling.constraint_gradient(u)
    jacobian = gradient.reshape(len(gradient), -1) @ rows_of[:, unknown].toarray()
    weighted = np.linalg.solve(system.reduced_mass[unknown][:, unknown].toarray(), jacobian.T)
    acceleration = system.solve_mass(system.reduce(system.momentum(a)))[unknown]
    multipliers = scipy.linalg.solve(jacobian @ weighted, jacobian @ acceleration, assume_a="pos")
    rows, change = np.zeros(u.size), np.zeros(system.reduced_mass.shape[0])
    rows[3 * masses + order] = multipliers
    change[unknown] = weighted @ multipliers
    return u + rows.reshape(u.shape), a - system.expand(change)
