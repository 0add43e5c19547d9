"""States that a program which reads an exported lattice can check itself by (`lumped.description`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lumped.calibration import Calibration
from lumped.lattice import Lattice
from lumped.statics.problem import Problem
from lumped.statics.solver import solve
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene, free_rigid_motions

STRETCH, WARP, TURN = 0.02, -0.05, 2.0  # of the imposed states: strain, height over length, rad in all


@dataclass(frozen=True)
class CheckState:
    """A state to check by: displacement (n, 3) [m], the energy [J] of springs and contact and its gradient
    (n, 3) [N]."""

    name: str
    meaning: str
    displacement: np.ndarray
    force: np.ndarray
    energy: float


def check_states(
    scene: Scene, calibration: Calibration, problem: Problem
) -> tuple[tuple[CheckState, ...], tuple[str, ...]]:
    """Return two imposed states and the equilibrium, and why there is none."""
    lattice = problem.assembly.lattice
    shapes = [
        ("stretched", f"stretched and warped by {STRETCH:g} and {-WARP:g}", _stretched(lattice)),
        ("rolled", f"rolled about y by {TURN:g} rad, the layers along", _rolled(lattice)),
    ]
    why: tuple[str, ...] = ()
    if free := free_rigid_motions(scene):
        why = (f"no equilibrium to check by: nothing stops {', '.join(free)}",)
    else:
        solution = solve(scene, calibration)
        if solution.status is Status.CONVERGED:
            found = solution.mesh.point_data["displacement"]
            shapes.append(("equilibrium", "under supports and loads", found))
        else:
            why = (f"no equilibrium to check by: {solution.status}: {solution.message}",)
    states = []
    for name, meaning, displacement in shapes:
        energy, force = problem.internal(displacement, 1.0)
        states.append(CheckState(name, meaning, displacement, force, energy))
    return tuple(states), why


def _stretched(lattice: Lattice) -> np.ndarray:
    x, y, z = lattice.positions.T
    lx, ly = (lines.at[-1] for lines in lattice.lines)
    a, b = x / lx, y / ly
    along = STRETCH * np.stack([lx * (a + 0.5 * a * b), ly * (0.3 * a**2 - 0.4 * b)])
    lift = WARP * min(lx, ly) * (0.1 + a * b + a**2) + STRETCH * z * (1.0 - a)
    return np.stack([*along, lift], axis=1)


def _rolled(lattice: Lattice) -> np.ndarray:
    x, y, z = lattice.positions.T
    radius = lattice.lines[0].at[-1] / TURN
    turn = x / radius
    rolled = np.stack([(radius - z) * np.sin(turn), y, radius - (radius - z) * np.cos(turn)], axis=1)
    return rolled - lattice.positions
