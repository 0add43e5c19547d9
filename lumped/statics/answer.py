"""What a static solve answers with: how it ended, and the `Solution` of that."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from lumped.actuators import Drive
from lumped.calibration import Calibration
from lumped.lattice import Lattice
from lumped.mid_surface import MidSurface
from lumped.statics.balance import balance
from lumped.statics.energy_descent import LatticePath
from lumped.statics.fields import LatticeMesh, field_mesh
from lumped.statics.problem import LatticeState, Problem
from sheetbench.answers.solution import Solution, Status
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grading import as_settings


@dataclass(frozen=True)
class Outcome:
    """How a solve ended: status, the path, what there is to say, and the springs' energies [J] at its last
    equilibrium by name where they are known."""

    status: Status
    path: LatticePath
    notes: tuple[str, ...] = ()
    energies: dict[str, float] | None = None

    @property
    def state(self) -> LatticeState:
        """The last equilibrium."""
        return self.path.state


def solution(
    scene: Scene,
    calibration: Calibration,
    problem: Problem,
    outcome: Outcome,
    seconds: tuple[float, float],
    requested: dict[str, Any],
) -> Solution:
    """The answer of an outcome; requested: the options that are not their defaults."""
    path, state, lattice = outcome.path, outcome.state, problem.assembly.lattice
    assembly, u = problem.assembly, state.u  # they outlive the solve
    linear = requested.get("linear", False)
    exerted, energies = _of_small_displacements(problem, state) if linear else _at(problem, outcome)
    reactions, on_masses = problem.constraints.reactions(exerted)
    coupling = problem.assembly.coupling
    wrenches = coupling.wrenches(state.u, exerted) if coupling is not None else {}
    if coupling is not None:
        reactions |= coupling.reactions(exerted)
    at = u, Drive(state.load_factor)
    reactions |= {item.name: item.exerted(at).sum(axis=0) for item in problem.items}
    contacts = {item.name: item.report(at) for item in problem.contacts}
    pressure = np.sum([pressure for _, pressure in contacts.values()], axis=0)
    pressed = {"contact_pressure": pressure} if contacts else {}
    nx, ny, layers = lattice.grid
    settings: dict[str, Any] = {"grid": [nx, ny, layers], "calibration": calibration.method}
    settings |= {"layer_distance": calibration.layer_distance, **as_settings(calibration.grading)}
    return Solution(
        model="lumped",
        label=f"lumped {calibration.title}" + (", linear" if linear else ""),
        settings=settings | requested,
        status=outcome.status,
        unknowns=problem.system.unknowns,
        iterations=path.factorisations,
        setup_seconds=seconds[0],
        solve_seconds=seconds[1],
        sample=partial(_sampled, lattice, u),
        reactions=reactions,
        energies=energies,
        mesh=LatticeMesh(
            partial(field_mesh, assembly, u, on_masses, state.load_factor, linear, pressed),
        ),
        history=tuple(path.history),
        load_factor=state.load_factor,
        actuators=wrenches,
        balance=balance(scene, problem, state, reactions, exerted, linear),
        contacts={name: state for name, (state, _) in contacts.items()},
        snaps=tuple(path.snaps),
        remarks=outcome.notes,
    )


def _sampled(lattice: Lattice, u: np.ndarray, points: np.ndarray) -> np.ndarray:
    return MidSurface(lattice, points).of(u)


def _at(problem: Problem, outcome: Outcome) -> tuple[np.ndarray, dict[str, float]]:
    """What is exerted on masses and rows at an equilibrium, internal less external force (size, 3) [N], and
    the energies [J]."""
    state = outcome.state
    energies = outcome.energies or problem.survey(state.u, state.load_factor).energies
    residual = state.residual or problem.residual(state.u, state.load_factor)
    return -residual.force, energies


def _of_small_displacements(problem: Problem, state: LatticeState) -> tuple[np.ndarray, dict[str, float]]:
    """Return forces K u + f₀ − f (size, 3) [N] and energies E₀ + f₀·u + ½ u·K u [J] of small displacements
    (`flat_step`), E₀ and f₀ those of the flat sheet, which has some where it is not flat at rest."""
    flat = np.zeros_like(state.u)
    bent = problem.system.apply(problem.tangent(flat, 0.0), state.u)
    external = problem.external(flat, state.load_factor)
    stored, pull = problem.internal(flat, state.load_factor)
    energy = stored + float(np.sum((pull + 0.5 * bent) * state.u))
    return bent + pull - external, {"elastic": energy}
