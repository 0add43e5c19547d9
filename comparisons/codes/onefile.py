"""A lattice in motion as C99 without a library: sheet.h, sheet.c, and main.c that tests them by check.csv.

The program is `scripts/sheet.c`, velocity Verlet as `lumped` has it, after tables that are written here:
springs that are alike share a row of constants; of rubber and of balls and bars it has `scripts/rubber.c` and
`scripts/patch.c`. Chains and branches are refused.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, replace
from functools import partial
from string import Template
from typing import TYPE_CHECKING, Any

import numpy as np

import lumped
from comparisons.codes.c_tables import Tables, identifiers, smallest
from comparisons.codes.files import script
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Scene, require_no_branches, tilt_axes
from sheetbench.scenes.meaning.natural_state import sources_of
from sheetbench.scenes.objects.obstacles import SLIP_SPEED, Plane
from sheetbench.scenes.objects.sheet import Gravity
from sheetbench.scenes.objects.supports import named
from sheetbench.sources import version

if TYPE_CHECKING:
    from lumped import Calibration, State, System

PRECISIONS: dict[str, tuple[str, Any]] = {"double": ("double", np.float64), "single": ("float", np.float32)}
CHECKED, FEW, MOMENTS = 2000, 200, 20  # steps, those of natural states that change, and samples of them
TRIES, SHORTER = 5, 0.75  # steps to check by, and how much shorter than the last
LARGEST = 1.0  # strain of a spring in a run that is one, but of rubber
NONE = 255  # no second source


@dataclass(frozen=True)
class Program:
    """texts: the files by name; points, bodies, sources: names of its inputs and outputs; step: [s]."""

    texts: dict[str, str]
    points: list[str]
    bodies: list[str]
    sources: list[str]
    step: float


def program(
    scene: Scene, calibration: Calibration, precision: str = "double", steps: int = CHECKED
) -> Program:
    """Return a scene's lattice in motion as a program in C, with the longest of some steps whose run of so
    many of them succeeds. Raises BadInput for features that the program lacks, and if no run succeeds."""
    require_choice("--precision", precision, tuple(PRECISIONS))
    system, start = lumped.in_motion(scene, calibration)
    scene = system.problem.scene
    if scene.actuators:
        own = ", ".join(scene.named_actuators())
        raise BadInput(f"--for c: actuators: {own} bring equations of their own; not in the C program")
    system.assembly.require_energy()
    require_no_branches(scene.material, "the C program")
    limit = lumped.step_limit(system, start.u)
    step, message, steps = limit.advised, "", FEW if system.growing is not None else steps
    for _ in range(TRIES):
        step = float(PRECISIONS[precision][1](step))
        try:
            check = checked(system, start, step, steps)
            break
        except lumped.StepFailed as error:
            step, message = SHORTER * step, str(error)
    else:
        raise BadInput(f"--for c: the check of its steps ends early: {message}")
    tables = Tables(PRECISIONS[precision][0])
    lattice, points, supports = system.assembly.lattice, scene.probe_points(), named(scene.supports)
    obstacles = list(scene.named_obstacles())
    bodies, sources = [*supports, *obstacles], [source.name for source in sources_of(scene)]
    n = lattice.mass_count
    tables.text.append(f"typedef {smallest(n, 'unsigned short')} entry;")
    tables.add("SHEET_REST", lattice.positions, storage="")
    add_springs(tables, system)
    add_masses(tables, system)
    for name, order in (("PROBE", 3), ("NEAR", 1)):
        tables.sparse(name, lumped.MidSurface(lattice, points, order=order).shared(np.eye(len(points)), n).T)
    add_loads(tables, system, calibration)
    touching, patches = add_contact(tables, system)
    movable = (*scene.supports, *scene.obstacles)
    tables.add("MOTION", [tables.course(one.motion, "displacement") for one in movable], "int")
    grown = add_growth(tables, system)
    tables.add("KNOT", np.reshape(tables.knots, (-1, 4)))
    tables.add("FIRST", [*tables.firsts, 0], "int")
    tables.add("START", start.u if start.u.any() else start.u[:1])
    tables.define(STARTS=n if start.u.any() else 1)
    still = scene.gravity is not None and scene.gravity.history is None
    gravity = scene.gravity.acceleration if scene.gravity is not None and still else (0.0, 0.0, 0.0)
    every = {"POINT": list(scene.probes), "SUPPORT": list(supports), "OBSTACLE": obstacles, "SOURCE": sources}
    numbers = {"POINTS": every["POINT"], "SUPPORTS": supports, "BODIES": bodies, "SOURCES": sources}
    names = [f"#define SHEET_{name} {len(of)}" for name, of in numbers.items()]
    for group, of in every.items():
        first = len(supports) if group == "OBSTACLE" else 0
        plain = (re.sub("^(support|obstacle) ", "", each) for each in of)
        listed = [f"{name} = {first + k}" for k, name in enumerate(identifiers(f"SHEET_{group}", plain))]
        names += ["enum { " + ", ".join(listed) + " };"] if listed else []
    nx, ny, layers = lattice.grid
    rubber = system.assembly.any_strain
    given: dict[str, Any] = dict(
        title=re.sub(r"[^ -~]|\*/", "?", f"{scene.name}, {nx} x {ny} x {layers}, {calibration.method}"),
        version=version(), real=tables.real, names="\n".join(names), step=tables.number(step), steps=steps,
        largest=f"{limit.step:.4g}", safety=f"{step / limit.step:.3g}", masses=n, layers=layers, nx=nx, ny=ny,
        gravity=tables.values(gravity, False), slip=SLIP_SPEED**2, libm="`sqrt`" + rubber * ", `exp`, `log`",
        dragged=n if scene.air else 1, touching=max(1, touching), grown=max(1, grown),
        rubber=f"#define RUBBER {int(rubber)}\n" + rubber * script("rubber.c"),
        patch=(patches > 0) * script("patch.c"), tables="\n".join(tables.text),
        points=", ".join(scene.probes) or "none", bodies=", ".join(bodies) or "none",
        sources=", ".join(sources) or "none",
    )  # fmt: skip
    texts = {name: Template(script(name)).substitute(given) for name in ("sheet.h", "sheet.c")}
    given["size"] = f"{len(texts['sheet.c']) / 1e3:.0f}"
    texts["README.md"] = Template(script("sheet.md")).substitute(given)
    texts |= {"main.c": script("main.c"), "check.csv": check}
    return Program(texts, every["POINT"], bodies, sources, step)


def add_springs(tables: Tables, system: System) -> None:
    """Add links and cells with their dampers."""
    parts: tuple[Any, ...] = system.assembly.springs[:4]
    links, layers, middle, faces = parts
    tau = 0.0 if system.scene.dampers is not None else system.scene.material.dashpot_time
    rows = [np.column_stack([links.offset, links.rest_length, links.stiffness, tau * links.stiffness])]
    nodes = [links.nodes]
    if system.assembly.natural is not None:
        rows[0][:, 3] = np.linalg.norm(links.offset, axis=1)
    if system.scene.dampers is not None:
        extra: Any = system.damping.dampers[0]
        none = 0.0 * extra.stiffness
        rows.append(np.column_stack([extra.offset, extra.rest_length, none, extra.stiffness]))
        nodes.append(extra.nodes)
    cells = [np.empty((0, 23))]
    for family in (layers, middle, faces):
        k, is_rubber = family.constants, family.constants.shape[1] == 13
        q = k[:, 3:4] * np.eye(7)[3] if family is faces else k[:, :7] * ((np.arange(7) < 4) | (not is_rubber))
        others = k[:, 4:13] if is_rubber else np.zeros((len(k), 9))
        cells.append(np.column_stack([family.sides.reshape(-1, 6), q, np.full(len(k), tau), others]))
    single, joined = len(layers), len(layers) + len(middle)
    tables.define(LINKS=sum(map(len, nodes)), CELLS=joined + len(faces), SINGLE=single, JOINED=joined)
    tables.define(DAMPED=tau > 0.0 or len(nodes) > 1)
    tables.add("LINK", np.concatenate(nodes), "entry")
    tables.alike("LINK", np.concatenate(rows))
    tables.add("CELL", np.concatenate([each.nodes.ravel() for each in (layers, middle, faces)]), "entry")
    tables.alike("CELL", np.concatenate(cells)[:, : 23 if system.assembly.any_strain else 14])


def add_masses(tables: Tables, system: System) -> None:
    """Add matrices of columns of masses along each axis, from forces to free accelerations and from
    velocities to momenta; masses' damping, the supports that move them, and sums of the supports' forces."""
    import scipy.sparse as sp

    constraints, (p, n) = (
        system.problem.constraints,
        (system.assembly.lattice.grid[2], len(system.lattice_mass)),
    )
    both = []
    for act in (system.accelerate, system.momentum):
        along = [act(np.repeat(np.arange(n) % p == q, 3).reshape(-1, 3) + 0.0) for q in range(p)]
        both.append(np.stack(along, axis=-1).reshape(-1, p, 3, p).swapaxes(1, 2).reshape(-1, p * p))
    tables.alike("COLUMN", np.concatenate(both, axis=1))
    tables.define(RATED=bool(system.damping.rate.any()))
    tables.add("RATE", system.damping.rate)
    owner, supports = np.zeros((n, 3), int), named(system.scene.supports)
    for moving in (False, True):  # a corner goes with the support that moves
        for number, (name, support) in enumerate(supports.items(), start=1):
            masses, axes = constraints.holders[name]
            for axis in axes if (support.motion is not None) is moving else ():
                rows = masses.ravel()
                firm = ~constraints.fixed[rows, axis] | (axis in tilt_axes(support))
                own = firm if moving else owner[rows, axis] == 0
                owner[rows[own], axis] = number
    tables.add("OWNER", owner, "")
    rows, columns, values = constraints.summed
    rows = np.append(rows, np.full(3 * len(system.items), rows[-1]))  # none of obstacles
    tables.sparse("SUMMED", sp.csr_array((values, columns, rows), shape=(len(rows) - 1, owner.size)))


def add_loads(tables: Tables, system: System, calibration: Calibration) -> None:
    """Add weight, dead loads, pressures and couples of edges, and the air's drag."""
    scene, lattice, drag = system.scene, system.assembly.lattice, system.damping.drag
    down = scene.replace(gravity=Gravity(acceleration=(0.0, 0.0, -1.0)), loads=())
    tables.add("WEIGHT", -lumped.build_problem(down, calibration).loads.parts[0].dead[:, 2])
    if scene.gravity is not None and scene.gravity.history is None:
        scene = scene.replace(gravity=None)
    parts = lumped.build_problem(scene, calibration).loads.parts
    tables_of = [one.history for one in (scene.gravity, *scene.loads) if one is not None and one.history]
    courses = [tables.course(one, "factor") for one in (None, *dict.fromkeys(tables_of))]
    tables.define(HISTORIES=len(courses))
    tables.add("HISTORY", courses, "int")
    dead = [np.argwhere(part.dead) for part in parts]
    pressed = [np.flatnonzero(part.pressure) for part in parts]
    corners = lattice.mid_cells[:, :, 0]
    every = {
        "LOAD": (dead, [part.dead[tuple(at.T)] for part, at in zip(parts, dead, strict=True)]),
        "PRESS": (
            [corners[c] for c in pressed],
            [p.pressure[c] for p, c in zip(parts, pressed, strict=True)],
        ),
        "COUPLE": ([part.columns[:, :, 0] for part in parts], [part.moments for part in parts]),
    }
    for name, (places, values) in every.items():
        owners = np.repeat(np.arange(len(parts)), [len(each) for each in values])
        tables.define(**{{"LOAD": "LOADS", "PRESS": "PRESSES", "COUPLE": "COUPLES"}[name]: len(owners)})
        tables.add(f"{name}_AT", np.concatenate(places), "entry")
        tables.add(name, np.concatenate(values))
        tables.add(f"{name}_PART", owners, "unsigned char")
    tables.define(STILL=int(sum(len(each) for each in dead[:1])))
    cells = corners if scene.air else corners[:0]
    tables.define(DRAG_CELLS=len(cells), DRAGGED=lattice.mass_count if scene.air else 0)
    tables.add("DRAG_AT", cells, "entry")
    tables.add("DRAG_SHARE", drag.shares[: len(cells)])
    tables.add("DRAG_WEIGHT", drag.weights if scene.air else [])
    tables.text.append(f"static const real DRAG = {tables.number(drag.coefficient)};")


def add_contact(tables: Tables, system: System) -> tuple[int, int]:
    """Add obstacles and the points of the mid-surface that may touch them, on planes columns of masses, else
    nine of each part of a cell. Return the numbers of points and parts."""
    bodies, groups = [np.empty(0, int)], [np.empty((0, 9), int)]
    columns, rows = [np.empty((0, 4), int)], [np.empty((0, 7))]
    for number, contact in enumerate(system.problem.contacts):
        cells, at_points, p = len(contact.nodes), len(contact.basis), system.assembly.lattice.grid[2]
        area = (
            contact.area
            if contact.at_corners
            else contact.area.sum(axis=1)[:, None] / (4 * len(contact.groups))
        )
        k, over = contact.share * contact.full * area, contact.rounded * contact.thickness
        offset, body = contact.offset, contact.obstacle
        if isinstance(body, Plane):  # from where the points rest
            rest = contact.weights @ system.assembly.lattice.positions[contact.nodes]
            offset = offset - (rest - body.position) @ body.direction
        shares = np.tile(contact.weights.reshape(-1, 4, p).sum(axis=2), (cells, 1))
        if not contact.at_corners:
            first = sum(len(each) for each in bodies) + at_points * np.arange(cells)
            groups.append((first[:, None, None] + contact.groups).reshape(-1, 9))
        bodies.append(np.full(len(shares), number))
        columns.append(np.repeat(contact.nodes[:, ::p], at_points, axis=0))
        rows.append(np.column_stack([shares, *(np.ravel(each) for each in (offset, k, over))]))
    points, parts = (sum(len(each) for each in of) for of in (bodies, groups))
    tables.define(POINTS=points, PATCHES=parts)
    tables.add("POINT_BODY", np.concatenate(bodies), "")
    tables.add("POINT_AT", np.concatenate(columns), "entry")
    tables.alike("POINT", np.concatenate(rows))
    of = [
        [*o.position, *o.direction, 0.0 if isinstance(o, Plane) else o.radius, o.contact_damping, o.friction]
        for o in system.scene.obstacles
    ]
    tables.add("OBSTACLE", np.reshape(of, (-1, 9)))
    if parts:
        tables.add("PATCH", np.concatenate(groups), "unsigned")
        (x, of_x), (y, of_y) = (np.polynomial.legendre.leggauss(count) for count in (4, 16))
        tables.add("ALONG", np.stack([x, of_x], axis=1))
        tables.add("ACROSS", np.stack([0.5 * (3.0 * y - y**3), 1.5 * (1.0 - y**2) * of_y], axis=1))
    return points, parts


def add_growth(tables: Tables, system: System) -> int:
    """Add the springs' measures without stress as a quadratic form of the factors of natural states, found
    from its values. Return the number of measures, 0 of a sheet that is flat at rest."""
    state: Any = system.assembly.natural
    entries, size = [], 0
    extra = 0 if system.scene.dampers is None else len(system.damping.dampers[0])

    def measured(*sources: tuple[int, float]) -> np.ndarray:
        factors = np.zeros(len(state.factors()))
        for source, factor in sources:
            factors[source] += factor
        links, *cells = state.of(factors).springs[:4]
        own = [np.zeros((3, len(one))) if one.natural is None else one.natural[1:] for one in cells]
        return np.concatenate([links.natural, np.zeros(extra), *(each.T.ravel() for each in own)])

    if state is not None:
        count, found = len(state.factors()), []
        one, less = ([measured((s, sign)) for s in range(count)] for sign in (1.0, -1.0))
        for s in range(count):
            found += [(s, NONE, 0.5 * (one[s] - less[s])), (s, s, 0.5 * (one[s] + less[s]))]
            found += [(s, t, measured((s, 1.0), (t, 1.0)) - one[s] - one[t]) for t in range(s)]
        size, most = len(one[0]), 1e-15 * max(float(np.abs(values).max()) for *_, values in found)
        entries = [(n, s, t, by[n]) for s, t, by in found for n in np.flatnonzero(np.abs(by) > most)]
    tables.define(GROWN=size, GROWTHS=len(entries))
    tables.add("GROWTH_AT", [at for at, *_ in entries], "unsigned")
    tables.add("GROWTH_OF", np.reshape([(s, t) for _, s, t, _ in entries], (-1, 2)), "unsigned char")
    tables.add("GROWTH", [value for *_, value in entries])
    courses = [tables.course(source.of.history, "factor") for source in sources_of(system.scene)]
    tables.add("SOURCE_COURSE", courses, "int")
    return size


def checked(system: System, start: State, step: float, steps: int) -> str:
    """Return the text of check.csv, probes [m], forces of supports and obstacles [N] and energies [J] in so
    many of `lumped`'s own steps. Raises StepFailed."""
    scene, every = system.scene, max(1, steps // MOMENTS)
    probes = lumped.MidSurface(system.assembly.lattice, scene.probe_points())
    largest = np.inf if system.assembly.any_strain else LARGEST
    rows, state, integrator = [], start, lumped.INTEGRATORS["verlet"](system, step)
    for left in (0, *[every] * (steps // every)):
        while left:
            advance = integrator.march(state, step, left)
            state, left = advance.state, left - advance.steps
        if not system.assembly.links.largest_strain(state.u) < largest:
            raise lumped.StepFailed(
                f"at {state.time:.4g} s a spring is {1 + LARGEST:g} times as long as at rest"
            )
        placed = system.prescribed.support_acceleration(state.time)
        energies, exerted = system.balance(replace(state, a=state.a + placed))
        forces = [*system.problem.constraints.reactions(exerted)[0].values()]
        at = state.u, system.drive(state.time)
        forces += [item.exerted(at, state.v).sum(axis=0) for item in system.items]
        row: list[Any] = [[state.time], probes.of(state.u).ravel(), *forces, [*energies.values()]]
        rows.append(np.concatenate(row).tolist())
    bodies = [*named(scene.supports), *scene.named_obstacles()]
    names = [f"{name}_{axis}" for name in (*scene.probes, *bodies) for axis in "xyz"]
    header = [re.sub("[ ,\n]", "_", name) for name in ("time", *names, *energies)]
    return "\n".join([",".join(header), *(",".join(map(repr, row)) for row in rows)]) + "\n"


def c_files(scene: Scene, calibration: Calibration, precision: str) -> dict[str, Write]:
    """Return the files of `--for c`."""
    found = program(scene, calibration, precision)
    return {name: partial(write_text, text=text) for name, text in found.texts.items()}
