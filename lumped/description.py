"""A lattice in plain arrays: all that another program needs to build it, and states to check itself by.

Masses are numbered from 0 throughout. A spring's damper has the coefficient [N·s/m] in place of its stiffness
and resists the rate of what the spring resists. Loads and supports are those of statics, at the full load.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from lumped.assembly import Assembly
from lumped.calibration import Calibration
from lumped.dynamics.explicit.stable_steps import StableSteps, stable_steps
from lumped.dynamics.system import System
from lumped.lattice import Lattice
from lumped.masses import masses
from lumped.springs.all_families import table_dampers
from lumped.springs.families import Links, SpringCells
from lumped.springs.law_table import AREA_AND_STRAINS, ENERGIES
from lumped.statics.problem import Problem
from lumped.statics.solver import build_problem, solve_from_best_start
from lumped.vibration import modes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, free_rigid_motions, require_no_branches, require_static
from sheetbench.scenes.objects.supports import named

EQUILIBRIUM = "equilibrium"  # a state to check by
STRETCH, WARP, TURN = 0.02, -0.05, 2.0  # of the imposed states: strain, height over length, rad in all


@dataclass(frozen=True)
class LinkTable:
    """masses: (m, 2); family: (m,) names; rest_length: (m,) [m]; stiffness: (m,) [N/m]; damping: (m,)
    [N·s/m]."""

    masses: np.ndarray
    family: np.ndarray
    rest_length: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


@dataclass(frozen=True)
class CellTable:
    """Springs of one kind of `lumped.springs.law_table.ENERGIES`: corners (c, 4, p), the masses whose mean
    each corner is; rest_area (c,) [m²]; natural (c, 3) [m²], A·A, B·B and A·B of the mean sides without
    stress; stiffness (c, n) [N/m], of rubber its limit [-] too; damping (c, n) [N·s/m]."""

    kind: str
    corners: np.ndarray
    rest_area: np.ndarray
    natural: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


@dataclass(frozen=True)
class Hold:
    """The mean of the masses' displacements along an axis, 0 to 2, is held at `displacement` [m]."""

    edge: str
    masses: tuple[int, ...]
    axis: int
    displacement: float


@dataclass(frozen=True)
class Couple:
    """An edge moment [N·m]: F = moment (t × D)/|D|² on the mass `top` and −F on `bottom`, D from bottom to
    top, t the direction from the mean of the column `before` to that of `after`."""

    top: int
    bottom: int
    before: tuple[int, ...]
    after: tuple[int, ...]
    moment: float


@dataclass(frozen=True)
class CheckState:
    """A state to check by: displacement (n, 3) [m], the energy [J] of springs and contact and its gradient
    (n, 3) [N]."""

    name: str
    meaning: str
    displacement: np.ndarray
    force: np.ndarray
    energy: float


@dataclass(frozen=True)
class Description:
    """index: (n, 3) of each mass along x, along y and through the thickness; positions: (n, 3) [m]; mass:
    (n,) [kg]; damping_rate: [1/s], of the masses; dead: (n, 3) [N]; pressure: (c,) [Pa], on the cells
    `pressed` (c, 4, p) of the mid-surface; contact: points (`lumped.contact.Contact.table`); steps: how to
    move it; notes: what of the scene is not in here. Masses of no cell, which an outline or cutouts leave,
    are left out."""

    index: np.ndarray
    positions: np.ndarray
    mass: np.ndarray
    damping_rate: float
    links: LinkTable
    cells: tuple[CellTable, ...]
    holds: tuple[Hold, ...]
    dead: np.ndarray
    pressure: np.ndarray
    pressed: np.ndarray
    couples: tuple[Couple, ...]
    contact: tuple[np.ndarray, ...]
    states: tuple[CheckState, ...]
    steps: StableSteps
    notes: tuple[str, ...] = ()


def describe(scene: Scene, calibration: Calibration) -> Description:
    """The lattice of a scene in plain arrays.

    Raises BadInput for actuators, whose chains are no springs between masses, and for Habibi et al.'s
    per-direction springs, which have no energy.
    """
    if scene.actuators:
        raise BadInput("export: actuators are not springs between masses; export a scene without them")
    require_no_branches(scene.material, "an exported lattice")
    if any(payload.inertia is not None for payload in scene.masses):
        raise BadInput("mass.inertia: an exported lattice has masses alone, which neighbours do not share")
    if scene.air is not None:
        raise BadInput("air: an exported lattice has no drag; leave [air] out")
    problem = build_problem(scene, calibration)
    for contact in problem.contacts:
        contact.divide(at_corners=True)
    assembly, lattice, loads = problem.assembly, problem.assembly.lattice, problem.loads
    if not assembly.conservative:
        raise BadInput("export: per-direction springs have no energy, and no stiffness along their links")
    nx, ny, layers = lattice.grid
    there = np.setdiff1d(np.arange(lattice.mass_count), lattice.absent_masses)
    number = np.full(lattice.mass_count, -1)  # of every mass of the lattice among those that are there
    number[there] = np.arange(len(there))
    flat = np.zeros_like(loads.dead)
    columns, moments, pressures = loads.at_time(None)
    pressed = pressures != 0.0
    states, why = _check_states(scene, calibration, problem)
    weight = masses(scene, lattice, calibration.masses, calibration.cells)
    shapes = [flat, *(one.displacement for one in states if one.name == EQUILIBRIUM)]
    lowest = modes(scene, calibration, 1, calibration.masses).frequencies[0]
    steps = stable_steps(System(scene, problem, weight), shapes, float(lowest))
    none = np.empty((0, 4 * layers), int), np.empty((0, 4 * layers)), np.empty((0, 10))
    points = zip(none, *(one.table() for one in problem.contacts), strict=True)
    touching, *touched = map(np.concatenate, points)
    return Description(
        index=np.indices((ny, nx, layers)).reshape(3, -1)[[1, 0, 2]].T[there],
        positions=lattice.positions[there],
        mass=weight[there],
        damping_rate=scene.material.damping_rate,
        links=_links(scene, assembly, number),
        cells=tuple(_cells(scene, assembly, number)),
        holds=_holds(problem, number),
        dead=(loads.force(flat) - loads.followers(flat))[there],  # with the last factors of their histories
        pressure=pressures[pressed],
        pressed=number[lattice.mid_cells[pressed]],
        couples=tuple(
            Couple(own[-1], own[0], tuple(before), tuple(after), moment)
            for (own, before, after), moment in zip(number[columns].tolist(), moments.tolist(), strict=True)
        ),
        contact=(number[touching], *touched),
        states=tuple(
            replace(one, displacement=one.displacement[there], force=one.force[there]) for one in states
        ),
        steps=steps,
        notes=(*_left_out(scene), *why),
    )


def _links(scene: Scene, assembly: Assembly, number: np.ndarray) -> LinkTable:
    """The links, also those that have only a damper of the scene's own table."""
    springs, time = assembly.links, scene.material.dashpot_time
    dampers, times = springs, time * springs.stiffness
    if scene.dampers is not None:
        dampers = table_dampers(assembly.lattice, assembly.pattern, scene.dampers)
        times = dampers.stiffness
    left = dict(zip(map(tuple, dampers.nodes.tolist()), times.tolist(), strict=True))
    damping = np.array([left.pop((a, b), 0.0) for a, b in springs.nodes.tolist()])
    alone = np.array([(a, b) in left for a, b in dampers.nodes.tolist()], dtype=bool)

    def rows(links: Links, *values: np.ndarray) -> tuple[np.ndarray, ...]:
        return number[links.nodes], np.array(links.names)[links.kind], links.rest_length, *values

    others = rows(dampers, np.zeros(len(dampers)), times)
    both = zip(rows(springs, springs.stiffness, damping), others, strict=True)
    return LinkTable(*(np.concatenate([first, second[alone]]) for first, second in both))


def _cells(scene: Scene, assembly: Assembly, number: np.ndarray) -> Iterator[CellTable]:
    """Yield the springs of each kind, and dampers where there are no springs."""
    time = 0.0 if scene.dampers is not None else scene.material.dashpot_time
    families = [family for family in assembly.springs if isinstance(family, SpringCells)]
    for kind in ENERGIES:
        for family in families:
            own, natural, area = _without_stress(family)
            stiffness = family.law.parts(own, family.others, area).get(kind)
            damping = AREA_AND_STRAINS.parts(time * own, None, area).get(kind)
            pair = [np.zeros_like(damping) if stiffness is None else stiffness]
            pair.append(np.zeros_like(pair[0]) if damping is None else damping)
            if (on := np.any(pair[0], axis=-1) | np.any(pair[1], axis=-1)).any():
                springs, dampers = (each[on] for each in pair)
                nodes = number[family.nodes[on]]
                yield CellTable(kind, nodes, area[on], natural[on], springs, dampers)


def _without_stress(cells: SpringCells) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness (c, 4 or 7) [N/m] and A·A, B·B, A·B (c, 3) [m²] and area (c,) [m²] without stress.

    Where it is not flat at rest, of constants q (`lumped.springs.laws.of_stiffness`) of sides that grew by
    the strain alone, with the sides and the area that go with the curvature too.
    """
    a, b = cells.sides.swapaxes(0, 1)
    flat = np.stack([(x * y).sum(axis=1) for x, y in ((a, a), (b, b), (a, b))], axis=1)
    if cells.natural is None:
        return cells.stiffness, flat, cells.area
    natural, area = flat + cells.natural[1:].T, cells.natural[0].copy()
    one, other, turn = 2.0 * natural[:, 0], 2.0 * natural[:, 1], area
    units = area**2, one**2, other**2, turn**2, one * other, one * turn, other * turn
    return cells.constants * np.stack(units, axis=1) / area[:, None], natural, area


def _holds(problem: Problem, number: np.ndarray) -> tuple[Hold, ...]:
    """What is held, once each; a corner's under the support that comes first."""
    constraints, place = problem.constraints, problem.prescribed(1.0)
    found: dict[tuple[int, ...], Hold] = {}
    for edge, (columns, axes) in constraints.holders.items():
        for column in columns[number[columns[:, 0]] >= 0]:
            for axis in axes:
                fixed = constraints.fixed[column[0], axis]
                for held in column[:, None] if fixed else column[None]:
                    hold = Hold(edge, tuple(number[held].tolist()), axis, float(place[held, axis].mean()))
                    found.setdefault((*hold.masses, axis), hold)
    return tuple(found.values())


def _left_out(scene: Scene) -> tuple[str, ...]:
    """What of the scene these arrays do not say."""
    moving = [
        name if support.edge is None else f"the support on edge {name}"
        for name, support in named(scene.supports).items()
        if support.motion is not None
    ]
    moving += [name for name, each in scene.named_obstacles().items() if each.motion is not None]
    courses = [*scene.loads, *([scene.gravity] if scene.gravity is not None else [])]
    changes = [f"{name} moves over time; here it is where it ends" for name in moving]
    if any(load.history is not None for load in courses):
        changes.append("loads change over time in this scene; here they have their last values")
    if any(state.history is not None for state in scene.natural_states.values()):
        changes.append("the natural state changes over time; here it has its last value")
    return tuple(changes)


def _check_states(
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
        require_static(scene)
        path = solve_from_best_start(problem, calibration)
        if path.status is Status.CONVERGED:
            shapes.append((EQUILIBRIUM, "under supports and loads", path.state.u))
        else:
            why = (f"no equilibrium to check by: {path.status}: {'; '.join(path.notes)}",)
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
