"""A lattice in plain arrays: all data that another program needs to build it, and states to check it by.

Masses are numbered from 0 throughout. A spring's damper has the coefficient [N·s/m] in place of its stiffness
and resists the rate of the spring's measure. Loads and supports have their values of statics, at the full
load.
"""

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
STRETCH, WARP, TURN = 0.02, -0.05, 2.0  # of the imposed states: strain, height over length, total angle [rad]


@dataclass(frozen=True)
class LinkTable:
    """Links. masses: (m, 2); family: (m,) names; rest_length: (m,) [m]; stiffness: (m,) [N/m]; damping: (m,)
    [N·s/m]."""

    masses: np.ndarray
    family: np.ndarray
    rest_length: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


@dataclass(frozen=True)
class CellTable:
    """Springs of one kind of `lumped.springs.law_table.ENERGIES`. corners: (c, 4, p) masses whose mean each
    corner is; rest_area: (c,) [m²]; natural: (c, 3) [m²] A·A, B·B and A·B of the mean sides without stress;
    stiffness: (c, n) [N/m], of rubber also its limit [-]; damping: (c, n) [N·s/m]."""

    kind: str
    corners: np.ndarray
    rest_area: np.ndarray
    natural: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray


@dataclass(frozen=True)
class Hold:
    """A support of masses: the mean of their displacements along an axis, 0 to 2, is `displacement` [m]."""

    edge: str
    masses: tuple[int, ...]
    axis: int
    displacement: float


@dataclass(frozen=True)
class Couple:
    """An edge moment [N·m]: F = moment (t × D)/|D|² on the mass `top` and −F on `bottom`, D from bottom to
    top, t the direction from the mean of the column `before` to the mean of `after`."""

    top: int
    bottom: int
    before: tuple[int, ...]
    after: tuple[int, ...]
    moment: float


@dataclass(frozen=True)
class CheckState:
    """A state to check another program by: displacement (n, 3) [m], the energy [J] of springs and contact,
    and its gradient `force` (n, 3) [N]."""

    name: str
    meaning: str
    displacement: np.ndarray
    force: np.ndarray
    energy: float


@dataclass(frozen=True)
class Description:
    """A lattice in plain arrays, without masses that belong to no cell.

    Parameters
    ----------
    index : ndarray of shape (n, 3)
        Number of each mass along x, along y and through the thickness.
    positions : ndarray of shape (n, 3)
        Positions at rest [m].
    mass : ndarray of shape (n,)
        Masses [kg].
    damping_rate : float
        Damping proportional to the masses [1/s].
    links : LinkTable
        Springs and dampers between two masses.
    cells : tuple of CellTable
        Springs and dampers of cells.
    holds : tuple of Hold
        Supports of masses.
    dead : ndarray of shape (n, 3)
        Dead loads [N].
    pressure : ndarray of shape (c,)
        Pressure [Pa] on cells of the mid-surface.
    pressed : ndarray of shape (c, 4, p)
        Masses at the corners of the cells under pressure.
    couples : tuple of Couple
        Edge moments.
    contact : tuple of ndarray
        Contact points (`lumped.contact.Contact.table`).
    states : tuple of CheckState
        States to check another program by.
    steps : StableSteps
        Stable time steps and damping.
    notes : tuple of str, optional
        Parts of the scene that the arrays leave out.
    """

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
    """Return the lattice of a scene in plain arrays.

    Parameters
    ----------
    scene : Scene
        Scene without actuators, rotary inertia and air.
    calibration : Calibration
        Springs of the lattice.

    Returns
    -------
    Description
        Masses, springs, dampers, supports and loads (SI units), three states to check by, and stable steps.

    Raises
    ------
    BadInput
        If the scene has actuators, whose chains are no springs between masses, payloads with rotary inertia,
        or air, or springs have Habibi et al.'s per-direction law, which has no energy.
    """
    if scene.actuators:
        raise BadInput("export: actuators are not springs between masses; export a scene without them")
    require_no_branches(scene.material, "an exported lattice")
    if any(payload.inertia is not None for payload in scene.masses):
        raise BadInput("mass.inertia: an exported lattice has point masses only")
    if scene.air is not None:
        raise BadInput("air: an exported lattice has no drag; leave [air] out")
    problem = build_problem(scene, calibration)
    for contact in problem.contacts:
        contact.divide(at_corners=True)
    assembly, lattice, loads = problem.assembly, problem.assembly.lattice, problem.loads
    if not assembly.conservative:
        raise BadInput("export: per-direction springs have no energy, and no stiffness along their links")
    nx, ny, layers = lattice.grid
    present = np.setdiff1d(np.arange(lattice.mass_count), lattice.absent_masses)
    number = np.full(lattice.mass_count, -1)  # of every mass of the lattice among the present ones
    number[present] = np.arange(len(present))
    flat = np.zeros_like(loads.dead)
    columns, moments, pressures = loads.at_time(None)
    pressed = pressures != 0.0
    states, notes = _check_states(scene, calibration, problem)
    weight = masses(scene, lattice, calibration.masses, calibration.cells)
    shapes = [flat, *(state.displacement for state in states if state.name == EQUILIBRIUM)]
    lowest = modes(scene, calibration, 1, calibration.masses).frequencies[0]
    steps = stable_steps(System(scene, problem, weight), shapes, float(lowest))
    no_points = np.empty((0, 4 * layers), int), np.empty((0, 4 * layers)), np.empty((0, 10))
    points = zip(no_points, *(contact.table() for contact in problem.contacts), strict=True)
    contact_masses, *contact_data = map(np.concatenate, points)
    return Description(
        index=np.indices((ny, nx, layers)).reshape(3, -1)[[1, 0, 2]].T[present],
        positions=lattice.positions[present],
        mass=weight[present],
        damping_rate=scene.material.damping_rate,
        links=_links(scene, assembly, number),
        cells=tuple(_cells(scene, assembly, number)),
        holds=_holds(problem, number),
        dead=(loads.force(flat) - loads.followers(flat))[present],  # with the last factors of histories
        pressure=pressures[pressed],
        pressed=number[lattice.mid_cells[pressed]],
        couples=tuple(
            Couple(column[-1], column[0], tuple(before), tuple(after), moment)
            for (column, before, after), moment in zip(
                number[columns].tolist(), moments.tolist(), strict=True
            )
        ),
        contact=(number[contact_masses], *contact_data),
        states=tuple(
            replace(state, displacement=state.displacement[present], force=state.force[present])
            for state in states
        ),
        steps=steps,
        notes=(*_differences(scene), *notes),
    )


def _links(scene: Scene, assembly: Assembly, number: np.ndarray) -> LinkTable:
    """Return the links, also links with a damper alone, from the scene's table of dampers."""
    springs, time = assembly.links, scene.material.dashpot_time
    dampers, times = springs, time * springs.stiffness
    if scene.dampers is not None:
        dampers = table_dampers(assembly.lattice, assembly.pattern, scene.dampers)
        times = dampers.stiffness
    by_masses = dict(zip(map(tuple, dampers.nodes.tolist()), times.tolist(), strict=True))
    damping = np.array([by_masses.pop((a, b), 0.0) for a, b in springs.nodes.tolist()])
    without_spring = np.array([(a, b) in by_masses for a, b in dampers.nodes.tolist()], dtype=bool)

    def rows(links: Links, *values: np.ndarray) -> tuple[np.ndarray, ...]:
        return number[links.nodes], np.array(links.names)[links.kind], links.rest_length, *values

    others = rows(dampers, np.zeros(len(dampers)), times)
    both = zip(rows(springs, springs.stiffness, damping), others, strict=True)
    return LinkTable(*(np.concatenate([first, second[without_spring]]) for first, second in both))


def _cells(scene: Scene, assembly: Assembly, number: np.ndarray) -> Iterator[CellTable]:
    """Yield the springs of each kind, and dampers where there are no springs."""
    time = 0.0 if scene.dampers is not None else scene.material.dashpot_time
    families = [family for family in assembly.springs if isinstance(family, SpringCells)]
    for kind in ENERGIES:
        for family in families:
            constants, natural, area = _without_stress(family)
            stiffness = family.law.parts(constants, family.others, area).get(kind)
            damping = AREA_AND_STRAINS.parts(time * constants, None, area).get(kind)
            pair = [np.zeros_like(damping) if stiffness is None else stiffness]
            pair.append(np.zeros_like(pair[0]) if damping is None else damping)
            if (on := np.any(pair[0], axis=-1) | np.any(pair[1], axis=-1)).any():
                springs, dampers = (values[on] for values in pair)
                nodes = number[family.nodes[on]]
                yield CellTable(kind, nodes, area[on], natural[on], springs, dampers)


def _without_stress(cells: SpringCells) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return stiffness (c, 4 or 7) [N/m] and A·A, B·B, A·B (c, 3) [m²] and area (c,) [m²] without stress.

    For a sheet that is not flat at rest the stiffness follows from the constants q
    (`lumped.springs.laws.of_stiffness`) of sides with the natural strain alone; sides and area include the
    natural curvature.
    """
    a, b = cells.sides.swapaxes(0, 1)
    flat = np.stack([(x * y).sum(axis=1) for x, y in ((a, a), (b, b), (a, b))], axis=1)
    if cells.natural is None:
        return cells.stiffness, flat, cells.area
    natural, area = flat + cells.natural[1:].T, cells.natural[0].copy()
    first, second = 2.0 * natural[:, 0], 2.0 * natural[:, 1]
    units = area**2, first**2, second**2, area**2, first * second, first * area, second * area
    return cells.constants * np.stack(units, axis=1) / area[:, None], natural, area


def _holds(problem: Problem, number: np.ndarray) -> tuple[Hold, ...]:
    """Return the supports of masses, once each; a corner's under the support that comes first."""
    constraints, g = problem.constraints, problem.prescribed(1.0)
    holds: dict[tuple[int, ...], Hold] = {}
    for edge, (columns, axes) in constraints.holders.items():
        for column in columns[number[columns[:, 0]] >= 0]:
            for axis in axes:
                fixed = constraints.fixed[column[0], axis]
                for held in column[:, None] if fixed else column[None]:
                    hold = Hold(edge, tuple(number[held].tolist()), axis, float(g[held, axis].mean()))
                    holds.setdefault((*hold.masses, axis), hold)
    return tuple(holds.values())


def _differences(scene: Scene) -> tuple[str, ...]:
    """Return sentences about parts of the scene that the arrays leave out."""
    supports = [(name, one.edge) for name, one in named(scene.supports).items() if one.motion is not None]
    moving = [name if edge is None else f"the support on edge {name}" for name, edge in supports]
    moving += [name for name, body in scene.named_obstacles().items() if body.motion is not None]
    loads = [*scene.loads, *([scene.gravity] if scene.gravity is not None else [])]
    changes = [f"{name} moves over time; the files have its last place" for name in moving]
    if any(load.history is not None for load in loads):
        changes.append("loads change over time; the files have their last values")
    if any(state.history is not None for state in scene.natural_states.values()):
        changes.append("the natural state changes over time; the files have its last value")
    return tuple(changes)


def _check_states(
    scene: Scene, calibration: Calibration, problem: Problem
) -> tuple[tuple[CheckState, ...], tuple[str, ...]]:
    """Return two imposed states and the equilibrium, or without one a note of the reason."""
    lattice = problem.assembly.lattice
    shapes = [
        ("stretched", f"stretched and warped by {STRETCH:g} and {-WARP:g}", _stretched(lattice)),
        ("rolled", f"rolled about y by {TURN:g} rad, the layers along", _rolled(lattice)),
    ]
    notes: tuple[str, ...] = ()
    if free := free_rigid_motions(scene):
        notes = (f"no equilibrium to check by: nothing stops {', '.join(free)}",)
    else:
        require_static(scene)
        path = solve_from_best_start(problem, calibration)
        if path.status is Status.CONVERGED:
            shapes.append((EQUILIBRIUM, "under supports and loads", path.state.u))
        else:
            notes = (f"no equilibrium to check by: {path.status}: {'; '.join(path.notes)}",)
    states = []
    for name, meaning, displacement in shapes:
        energy, force = problem.internal(displacement, 1.0)
        states.append(CheckState(name, meaning, displacement, force, energy))
    return tuple(states), notes


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
