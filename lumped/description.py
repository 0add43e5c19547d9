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
from lumped.lattice import Lattice
from lumped.loads import Loads
from lumped.masses import masses
from lumped.springs.all_families import table_dampers
from lumped.springs.cell_laws import AREA_AND_STRAINS, ENERGIES
from lumped.springs.families import Links, SpringCells
from lumped.statics.problem import Problem
from lumped.statics.solver import build_problem, solve
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, Status, free_rigid_motions, require_no_branches
from sheetbench.scenes.obstacles import require_no_obstacles
from sheetbench.scenes.patches import require_flat_at_rest
from sheetbench.scenes.supports import named

STRETCH, WARP, TURN = 0.02, 0.05, 2.0  # of the imposed states: strain, height over length, rad in all


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
    """Springs of one kind of `lumped.springs.cell_laws.ENERGIES`: corners (c, 4, p), the masses whose mean
    each corner is; rest_area (c,) [m²]; stiffness (c, n) [N/m], of rubber its limit [-] too; damping (c, n)
    [N·s/m]; energy: the formula of it."""

    kind: str
    corners: np.ndarray
    rest_area: np.ndarray
    stiffness: np.ndarray
    damping: np.ndarray
    energy: str


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
    """A state to check by: displacement (n, 3) [m], gradient of the elastic energy (n, 3) [N], energy [J]."""

    name: str
    meaning: str
    displacement: np.ndarray
    force: np.ndarray
    energy: float


@dataclass(frozen=True)
class Description:
    """index: (n, 3) of each mass along x, along y and through the thickness; positions: (n, 3) [m]; mass:
    (n,) [kg]; damping_rate: [1/s], of the masses; dead: (n, 3) [N]; pressure: (c,) [Pa], on the cells
    `pressed` (c, 4, p) of the mid-surface; notes: what of the scene is not in here. Masses of no cell, which
    an outline or cutouts leave, are left out."""

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
    states: tuple[CheckState, ...]
    notes: tuple[str, ...] = ()


def describe(scene: Scene, calibration: Calibration) -> Description:
    """The lattice of a scene in plain arrays.

    Raises BadInput for actuators, whose chains are no springs between masses, and for Habibi et al.'s
    per-direction springs, which have no energy.
    """
    if scene.actuators:
        raise BadInput("export: actuators are not springs between masses; export a scene without them")
    require_no_branches(scene.material, "an exported lattice")
    require_flat_at_rest(scene, "an exported lattice")
    if any(payload.inertia is not None for payload in scene.masses):
        raise BadInput("mass.inertia: an exported lattice has masses alone, which neighbours do not share")
    if scene.air is not None:
        raise BadInput("air: an exported lattice has no drag; leave [air] out")
    require_no_obstacles(scene, "an exported lattice")
    problem = build_problem(scene, calibration)
    assembly, lattice = problem.assembly, problem.assembly.lattice
    if not assembly.conservative:
        raise BadInput("export: per-direction springs have no energy, and no stiffness along their links")
    nx, ny, layers = lattice.grid
    j, i, k = (at.ravel() for at in np.meshgrid(*map(np.arange, (ny, nx, layers)), indexing="ij"))
    moments, pressures = problem.loads.at_time(None)
    pressed = pressures != 0.0
    couples = tuple(c for edge, moment, turn in moments for c in _couples(edge, turn * moment))
    states, why = _states(scene, calibration, assembly)
    found = Description(
        index=np.stack([i, j, k], axis=1),
        positions=lattice.positions,
        mass=masses(scene, lattice, calibration.masses, calibration.cells),
        damping_rate=scene.material.damping_rate,
        links=_links(scene, assembly),
        cells=tuple(_cells(scene, assembly)),
        holds=_holds(problem),
        dead=_constant(problem.loads),
        pressure=pressures[pressed],
        pressed=lattice.mid_cells[pressed],
        couples=couples,
        states=states,
        notes=(*_left_out(scene), *why),
    )
    return _without(found, lattice.absent_masses) if len(lattice.absent_masses) else found


def _without(found: Description, absent: np.ndarray) -> Description:
    """The description without some masses, the others numbered on from 0."""
    there = np.ones(len(found.mass), dtype=bool)
    there[absent] = False
    new = np.cumsum(there) - 1

    def several(masses: tuple[int, ...]) -> tuple[int, ...]:
        return tuple(new[list(masses)].tolist())

    return replace(
        found,
        **{name: getattr(found, name)[there] for name in ("index", "positions", "mass", "dead")},
        links=replace(found.links, masses=new[found.links.masses]),
        cells=tuple(replace(table, corners=new[table.corners]) for table in found.cells),
        holds=tuple(replace(h, masses=several(h.masses)) for h in found.holds if there[h.masses[0]]),
        pressed=new[found.pressed],
        couples=tuple(
            replace(
                c,
                top=int(new[c.top]),
                bottom=int(new[c.bottom]),
                before=several(c.before),
                after=several(c.after),
            )
            for c in found.couples
        ),
        states=tuple(
            replace(state, displacement=state.displacement[there], force=state.force[there])
            for state in found.states
        ),
    )


def _links(scene: Scene, assembly: Assembly) -> LinkTable:
    """The links, also those that have only a damper of the scene's own table."""
    springs = assembly.links
    table = _table(springs, springs.stiffness, scene.material.dashpot_time * springs.stiffness)
    if scene.dampers is None:
        return table
    own = table_dampers(assembly.lattice, assembly.pattern, scene.dampers)
    beside = _table(own, np.zeros(len(own)), own.stiffness)
    places = {tuple(pair): row for row, pair in enumerate(table.masses.tolist())}
    at = np.array([places.get(tuple(pair), -1) for pair in beside.masses.tolist()], dtype=int)
    damping = np.zeros(len(springs))
    damping[at[at >= 0]] = beside.damping[at >= 0]
    joined = zip(vars(replace(table, damping=damping)).values(), vars(beside).values(), strict=True)
    return LinkTable(*(np.concatenate([first, second[at < 0]]) for first, second in joined))


def _table(links: Links, stiffness: np.ndarray, damping: np.ndarray) -> LinkTable:
    names = np.array(links.names)[links.kind]
    return LinkTable(links.nodes, names, links.rest_length, stiffness, damping)


def _cells(scene: Scene, assembly: Assembly) -> Iterator[CellTable]:
    """Yield the springs of each kind, and dampers where there are no springs."""
    time = 0.0 if scene.dampers is not None else scene.material.dashpot_time
    families = [family for family in assembly.springs if isinstance(family, SpringCells)]
    for kind, energy in ENERGIES.items():
        for family in families:
            stiffness = family.law.parts(family.stiffness, family.others, family.area).get(kind)
            damping = AREA_AND_STRAINS.parts(time * family.stiffness, None, family.area).get(kind)
            pair = [np.zeros_like(damping) if stiffness is None else stiffness]
            pair.append(np.zeros_like(pair[0]) if damping is None else damping)
            if (on := np.any(pair[0], axis=-1) | np.any(pair[1], axis=-1)).any():
                springs, dampers = (each[on] for each in pair)
                yield CellTable(kind, family.nodes[on], family.area[on], springs, dampers, energy)


def _holds(problem: Problem) -> tuple[Hold, ...]:
    """What is held, once each; a corner's under the support that comes first."""
    constraints, place = problem.constraints, problem.prescribed(1.0)
    found: dict[tuple[tuple[int, ...], int], Hold] = {}
    for edge, (columns, axes) in constraints.holders.items():
        for column in columns.tolist():
            for axis in axes:
                fixed = constraints.fixed[column[0], axis]
                for held_masses in [(mass,) for mass in column] if fixed else [tuple(column)]:
                    mean = float(place[list(held_masses), axis].mean())
                    found.setdefault((held_masses, axis), Hold(edge, held_masses, axis, mean))
    return tuple(found.values())


def _couples(edge: np.ndarray, moment: np.ndarray) -> list[Couple]:
    last = len(edge) - 1
    return [
        Couple(
            int(column[-1]),
            int(column[0]),
            tuple(edge[max(at - 1, 0)].tolist()),
            tuple(edge[min(at + 1, last)].tolist()),
            float(moment[at]),
        )
        for at, column in enumerate(edge)
    ]


def _constant(loads: Loads) -> np.ndarray:
    """The dead loads with the last factors of their histories."""
    rest = np.zeros_like(loads.dead)
    return loads.force(rest) - loads.followers(rest)


def _states(
    scene: Scene, calibration: Calibration, assembly: Assembly
) -> tuple[tuple[CheckState, ...], tuple[str, ...]]:
    """Two imposed states and the equilibrium, and why there is none."""
    shapes = [
        ("stretched", f"stretched and warped by {STRETCH:g} and {WARP:g}", _stretched(assembly.lattice)),
        ("rolled", f"rolled about y by {TURN:g} rad, the layers along", _rolled(assembly.lattice)),
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
        energy, force = assembly.force(displacement)
        states.append(CheckState(name, meaning, displacement, force, energy))
    return tuple(states), why


def _stretched(lattice: Lattice) -> np.ndarray:
    x, y, z = lattice.positions.T
    lx, ly = (lines.at[-1] for lines in lattice.lines)
    a, b = x / lx, y / ly
    along = STRETCH * np.stack([lx * (a + 0.5 * a * b), ly * (0.3 * a**2 - 0.4 * b)])
    lift = WARP * min(lx, ly) * (a * b + a**2) + STRETCH * z * (1.0 - a)
    return np.stack([*along, lift], axis=1)


def _rolled(lattice: Lattice) -> np.ndarray:
    x, y, z = lattice.positions.T
    radius = lattice.lines[0].at[-1] / TURN
    turn = x / radius
    rolled = np.stack([(radius - z) * np.sin(turn), y, radius - (radius - z) * np.cos(turn)], axis=1)
    return rolled - lattice.positions


def _left_out(scene: Scene) -> tuple[str, ...]:
    """What of the scene these arrays do not say."""
    moving = [
        name if support.edge is None else f"the support on edge {name}"
        for name, support in named(scene.supports).items()
        if support.motion is not None
    ]
    courses = [*scene.loads, *([scene.gravity] if scene.gravity is not None else [])]
    changes = [f"{name} moves over time; here it is where it ends" for name in moving]
    if any(load.history is not None for load in courses):
        changes.append("loads change over time in this scene; here they have their last values")
    return tuple(changes)
