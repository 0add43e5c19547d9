"""The `Solution` of a static solve, from the end of its path."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np

from lumped.actuators import Drive
from lumped.calibration import Calibration
from lumped.contact import Contact, middle
from lumped.lattice import Lattice
from lumped.statics.balance import balance
from lumped.statics.fields import LatticeMesh, field_mesh
from lumped.statics.problem import LatticePath, LatticeState, Problem
from sheetbench.answers.solution import Solution


def solution(
    problem: Problem,
    path: LatticePath,
    calibration: Calibration,
    seconds: tuple[float, float],
    requested: dict[str, Any],
    sensitivity: Callable[[], Any] | None,
) -> Solution:
    """Return the solution at the end of a path. requested: the options that are not their defaults;
    sensitivity: the answer's derivatives, None if it has none."""
    state, assembly = path.state, problem.assembly  # they outlive the solve
    u, lattice = state.u, assembly.lattice
    linear = requested.get("linear", False)
    exerted, energies = (
        _of_small_displacements(problem, state) if linear else _equilibrium_forces(problem, state)
    )
    reactions, on_masses = problem.constraints.reactions(exerted)
    coupling = assembly.coupling
    wrenches = coupling.wrenches(u, exerted) if coupling is not None else {}
    if coupling is not None:
        reactions |= coupling.reactions(exerted)
    at = u, Drive(state.load_factor)
    reactions |= {item.name: item.exerted(at).sum(axis=0) for item in problem.items}
    contacts = {item.name: item.report(at) for item in problem.contacts}
    pressures = [pressure for _, pressure in contacts.values()]
    pressed = {"contact_pressure": np.sum(pressures, axis=0)} if contacts else {}
    touching = [item for item in problem.contacts if contacts[item.name][0].points]
    return Solution(
        model="lumped",
        label=f"lumped {calibration.title}" + (", linear" if linear else ""),
        settings=calibration.settings | {"layer_distance": calibration.layer_distance} | requested,
        status=path.status,
        unknowns=problem.system.unknowns,
        iterations=path.factorisations,
        setup_seconds=seconds[0],
        solve_seconds=seconds[1],
        sample=partial(_sample, touching, lattice, u),
        reactions=reactions,
        energies=energies,
        mesh=LatticeMesh(partial(field_mesh, assembly, u, on_masses, state.load_factor, linear, pressed)),
        history=tuple(path.history),
        load_factor=state.load_factor,
        actuators=wrenches,
        balance=balance(problem, state, reactions, exerted, linear),
        contacts={name: contact for name, (contact, _) in contacts.items()},
        snaps=tuple(path.snaps),
        remarks=tuple(path.notes),
        sensitivity=sensitivity,
    )


def _sample(touching: Sequence[Contact], lattice: Lattice, u: np.ndarray, points: np.ndarray) -> np.ndarray:
    return middle(touching, lattice, u, points)[0]


def _equilibrium_forces(problem: Problem, state: LatticeState) -> tuple[np.ndarray, dict[str, float]]:
    """Return the force that holds masses and rows at an equilibrium, internal less external force (size, 3)
    [N], and the energies [J]."""
    energies = state.energies or problem.survey(state.u, state.load_factor).energies
    return -problem.forces(state, state.load_factor).force, energies


def _of_small_displacements(problem: Problem, state: LatticeState) -> tuple[np.ndarray, dict[str, float]]:
    """Return forces K u + f₀ − f (size, 3) [N] and energies E₀ + f₀·u + ½ u·K u [J] of small displacements
    (`flat_step`), E₀ and f₀ energy and force of the flat sheet, not 0 if the sheet is not flat at rest."""
    flat = np.zeros_like(state.u)
    bent = problem.system.apply(problem.tangent(flat, 0.0), state.u)
    external = problem.external(flat, state.load_factor)
    stored, pull = problem.internal(flat, state.load_factor)
    energy = stored + float(np.sum((pull + 0.5 * bent) * state.u))
    return bent + pull - external, {"elastic": energy}
