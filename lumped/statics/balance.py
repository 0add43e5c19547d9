"""Balance of the forces and moments of supports, motions, held bases and loads on a lattice (`Balance`).

Springs and joints are central or turn with the masses that they join, so that their forces on masses and rows
cancel, and so do their moments: the sums are the residual of the free unknowns and the rounding of the links'
forces. Springs of unequal stiffness along x, y and z are neither, and keep no moments.
"""

import math

import numpy as np

from lumped.actuators import Drive
from lumped.statics.problem import LIMITS, LatticeState, Problem
from sheetbench.answers.balance import Balance, dead_force


def balance(
    problem: Problem,
    state: LatticeState,
    reactions: dict[str, np.ndarray],
    exerted: np.ndarray,
    linear: bool = False,
) -> Balance:
    """Return the balance of an equilibrium. reactions: (3,) [N] by name; exerted: (size, 3) [N] force that
    holds masses and rows, internal less external; linear: on the flat sheet."""
    lattice, coupling = problem.assembly.lattice, problem.assembly.coupling
    n, share = lattice.mass_count, state.load_factor
    at = np.zeros_like(state.u) if linear else state.u
    places = lattice.positions + at[:n]
    external = problem.external(at, share)
    followers = 0.0 if not problem.loads.follow else problem.loads.followers(at)[:n].sum(axis=0)
    cells = problem.assembly.cells
    mass = None if cells is None else float((cells.per_area * lattice.cell_areas).sum())
    force = sum(reactions.values(), share * (dead_force(problem.scene, mass) + followers))
    held = np.where(problem.constraints.held[:n], exerted[:n], 0.0)
    acting = sum((item.exerted((at, Drive(share))) for item in problem.items), external)
    arms = places.T @ (held + acting[:n])  # Σ x f, whose antisymmetric part is Σ x × f
    moment = np.array([arms[1, 2] - arms[2, 1], arms[2, 0] - arms[0, 2], arms[0, 1] - arms[1, 0]])
    if coupling is not None:
        moment += coupling.held_moment(at, exerted, Drive(share))
        moment += coupling.moment(at, external)
    residual = None if linear else state.residual
    size = (residual or problem.residual(at, share)).size
    # a sum of n numbers is at most √n times their norm, in which residuals are measured
    allowed = math.sqrt(len(at)) * max(LIMITS.tolerance * size, problem.imbalance_floor(state))
    arm = math.sqrt(np.einsum("ij,ij->i", places, places).max())
    return Balance(force, moment, size, allowed, arm, objective=problem.assembly.conservative)
