"""A lattice in motion as C99 without a library: sheet.h, sheet.c, and main.c that tests them by check.csv.

The program is `scripts/sheet.c`, velocity Verlet as `lumped` has it, after tables that are written here:
springs that are alike share a row of constants. What it has not is refused by name.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
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
from sheetbench.scenes.objects.obstacles import Plane
from sheetbench.scenes.objects.sheet import Gravity
from sheetbench.scenes.objects.supports import named
from sheetbench.sources import version

if TYPE_CHECKING:
    from lumped import Calibration, State, System

PRECISIONS: dict[str, tuple[str, Any]] = {"double": ("double", np.float64), "single": ("float", np.float32)}
SAFETY, TOUCHING = 0.9, 0.85  # share of the measured limit that is advised, and with obstacles
CHECKED, FEW, MOMENTS = 2000, 200, 20  # steps, those of natural states that change, and samples of them
TRIES, SHORTER = 5, 0.75  # steps to check by, and how much shorter than the last
LARGEST = 1.0  # strain of a spring in a run that is one
NONE = 255  # no second source


def refuse(scene: Scene, system: System) -> None:
    """Raise BadInput for what the program has not."""
    spheres = [n for n, each in scene.named_obstacles().items() if not isinstance(each, Plane)]
    payloads = any(payload.inertia is not None for payload in scene.masses)
    for why in (
        scene.actuators and f"actuators: {', '.join(scene.named_actuators())} bring equations of their own",
        spheres and f"{spheres[0]}: contact over patches of a ball or a bar; a plane can be had",
        payloads and "mass.inertia: neighbours share mass",
        scene.air and "air: no drag",
        system.assembly.any_strain and "rubber: its cells take logarithms",
        not system.assembly.conservative and "springs of unequal stiffness along x, y and z: no energy",
    ):
        if why:
            raise BadInput(f"--for c: {why}; not in the C program")
    require_no_branches(scene.material, "the C program")


@dataclass(frozen=True)
class Program:
    """texts: the files by name; points, bodies, sources: names of what it takes and answers; step: [s]."""

    texts: dict[str, str]
    points: list[str]
    bodies: list[str]
    sources: list[str]
    step: float


def program(
    scene: Scene, calibration: Calibration, precision: str = "double", steps: int = CHECKED
) -> Program:
    """Return a scene's lattice in motion as a program in C, with the longest of some steps whose run of so
    many of them succeeds. Raises BadInput for what it has not, and where none does."""
    require_choice("--precision", precision, tuple(PRECISIONS))
    system, start = lumped.in_motion(scene, calibration)
    scene = system.problem.scene
    refuse(scene, system)
    limit = lumped.measured_limit(system, start.u)
    step, check, message = (TOUCHING if system.items else SAFETY) * limit, "", ""
    kind_of = PRECISIONS[precision]
    steps = FEW if system.growing is not None else steps
    for _ in range(TRIES):
        step = float(kind_of[1](step))
        check, message = checked(system, start, step, steps)
        if check:
            break
        step *= SHORTER
    else:
        raise BadInput(f"--for c: the check of its steps ends early: {message}")
    tables = Tables(kind_of[0])
    lattice, points, supports = system.assembly.lattice, scene.probe_points(), named(scene.supports)
    probes, obstacles = list(scene.probes), list(scene.named_obstacles())
    bodies, sources = [*supports, *obstacles], [source.name for source in sources_of(scene)]
    n, columns = lattice.mass_count, lattice.positions
    tables.text.append(f"typedef {smallest(n, 'unsigned short')} entry;")
    tables.add("SHEET_REST", columns, storage="")
    add_springs(tables, system)
    add_masses(tables, system, supports)
    for name, order in (("PROBE", 3), ("NEAR", 1)):
        tables.sparse(name, lumped.MidSurface(lattice, points, order=order).shared(np.eye(len(points)), n).T)
    keys = add_loads(tables, system, calibration)
    add_contact(tables, system, list(bodies))
    motions = [one.motion for one in (*scene.supports, *scene.obstacles)]
    tables.define(MOVING=any(one is not None for one in motions))
    if any(one is not None for one in motions):
        tables.add("MOTION", [tables.course(one, "displacement") for one in motions], "int")
    grown = add_growth(tables, system)
    tables.define(COURSES=len(tables.knots) > 0)
    if tables.knots:
        tables.add("KNOT", tables.knots)
        tables.add("FIRST", tables.firsts, "int")
    flat = not start.u.any()
    if not flat:
        tables.add("START", start.u)
    gravity = (0.0, 0.0, 0.0)
    if scene.gravity is not None and scene.gravity.history is None:
        gravity = scene.gravity.acceleration
    every = {"POINT": probes, "SUPPORT": supports, "OBSTACLE": obstacles, "SOURCE": sources}
    numbers = {"POINTS": probes, "SUPPORTS": supports, "BODIES": bodies, "SOURCES": sources}
    names = [f"#define SHEET_{name} {len(of)}" for name, of in numbers.items()]
    for group, of in every.items():
        first = len(supports) if group == "OBSTACLE" else 0
        own = identifiers(f"SHEET_{group}", (re.sub("^(support|obstacle) ", "", each) for each in of))
        if own:
            names.append("enum { " + ", ".join(f"{name} = {first + k}" for k, name in enumerate(own)) + " };")
    nx, ny, layers = lattice.grid
    title = re.sub(r"[^ -~]|\*/", "?", f"{scene.name}, {nx} x {ny} x {layers}, {calibration.method}")
    given: dict[str, Any] = keys | dict(
        title=title, version=version(), real=tables.real, names="\n".join(names), step=tables.number(step),
        largest=f"{limit:.4g}", safety=f"{step / limit:.3g}", masses=n, layers=layers, nx=nx, ny=ny,
        gravity=tables.values(gravity, False), start="0" if flat else "START[i][e]",
        room=f"  sheet_real grown[{grown}]; /* of links and cells */\n" if sources else "",
        tables="\n".join(tables.text),
    )  # fmt: skip
    texts = {name: Template(script(name)).substitute(given) for name in ("sheet.h", "sheet.c")}
    texts |= {"main.c": script("main.c"), "check.csv": check}
    texts["README.md"] = Template(script("sheet.md")).substitute(
        given, size=f"{len(texts['sheet.c']) / 1e3:.0f}", points=", ".join(probes), bodies=", ".join(bodies),
        sources=", ".join(sources) or "none, as the scene has no natural state",
    )  # fmt: skip
    return Program(texts, probes, list(bodies), sources, step)


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
        rows.append(
            np.column_stack([extra.offset, extra.rest_length, 0.0 * extra.stiffness, extra.stiffness])
        )
        nodes.append(extra.nodes)
    families = [each for each in (layers, middle, faces) if len(each)]
    beside = ((0, 0), (3, 3))
    constants = [np.pad(one.constants[:, 3:4], beside) if one is faces else one.constants for one in families]
    cells = [
        np.column_stack([family.sides.reshape(-1, 6), q, np.full(len(q), tau)])
        for family, q in zip(families, constants, strict=True)
    ]
    single, joined = len(layers), len(layers) + len(middle)
    tables.define(LINKS=sum(map(len, nodes)), CELLS=joined + len(faces), SINGLE=single, JOINED=joined)
    tables.define(DAMPED=tau > 0.0 or len(nodes) > 1)
    tables.add("LINK", np.concatenate(nodes), "entry")
    tables.alike("LINK", np.concatenate(rows))
    tables.add(
        "CELL", np.concatenate([np.empty(0, int), *(each.nodes.ravel() for each in families)]), "entry"
    )
    tables.alike("CELL", np.concatenate([np.empty((0, 14)), *cells]) if cells else np.zeros((1, 14)))


def add_masses(tables: Tables, system: System, supports: Mapping[str, Any]) -> None:
    """Add masses, what damps them, what of them supports hold, and how the supports' forces add up."""
    import scipy.sparse as sp

    constraints, mass, rate = system.problem.constraints, system.lattice_mass, system.damping.rate
    held, means = np.zeros((len(mass), 3), int), set()
    for moving in (False, True):  # a corner goes with the support that moves
        for number, (name, support) in enumerate(supports.items()):
            masses, axes = constraints.holders[name]
            for axis in axes if (support.motion is not None) is moving else ():
                rows = masses.ravel()
                fixed = constraints.fixed[rows, axis]
                own = ~fixed | (axis in tilt_axes(support)) if moving else held[rows, axis] == 0
                held[rows[own], axis] = 2 * number + 2 - fixed[own]
                first = masses[:, 0]
                means |= {(i, axis) for i in first[~constraints.fixed[first, axis]].tolist()}
    tables.add("MASS", mass)
    tables.add("INVERSE", np.divide(1.0, mass, out=np.zeros_like(mass), where=mass > 0.0))
    tables.define(RATED=bool(rate.any()), MEANS=len(means))
    if rate.any():
        tables.add("RATE", rate)
    tables.add("HELD", held, "unsigned char")
    if means:
        tables.add("MEAN", sorted(means), "")
    rows, columns, values = constraints.summed
    tables.sparse("SUMMED", sp.csr_array((values, columns, rows), shape=(len(rows) - 1, held.size)))


def add_loads(tables: Tables, system: System, calibration: Calibration) -> dict[str, str]:
    """Add weight, dead loads, pressures and couples of edges; return how the program scales each."""
    scene, lattice = system.scene, system.assembly.lattice
    down = scene.replace(gravity=Gravity(acceleration=(0.0, 0.0, -1.0)), loads=())
    tables.add("WEIGHT", -lumped.build_problem(down, calibration).loads.parts[0].dead[:, 2])
    if scene.gravity is not None and scene.gravity.history is None:
        scene = scene.replace(gravity=None)
    parts = lumped.build_problem(scene, calibration).loads.parts
    tables_of = [one.history for one in (scene.gravity, *scene.loads) if one is not None and one.history]
    histories = [None, *dict.fromkeys(tables_of)]
    courses = [tables.course(one, "factor") for one in histories]
    tables.define(HISTORIES=len(histories) if len(histories) > 1 else 0)
    if len(histories) > 1:
        tables.add("HISTORY", courses, "int")
    dead = [np.argwhere(part.dead) for part in parts]
    pressed = [np.flatnonzero(part.pressure) for part in parts]
    every = {
        "LOAD": (dead, [part.dead[tuple(at.T)] for part, at in zip(parts, dead, strict=True)]),
        "PRESS": (
            [lattice.mid_cells[c, :, 0] for c in pressed],
            [p.pressure[c] for p, c in zip(parts, pressed, strict=True)],
        ),
        "COUPLE": ([part.columns[:, :, 0] for part in parts], [part.moments for part in parts]),
    }
    scaled = {}
    for name, (places, values) in every.items():
        owners = np.repeat(np.arange(len(parts)), [len(each) for each in values])
        tables.define(**{{"LOAD": "LOADS", "PRESS": "PRESSES", "COUPLE": "COUPLES"}[name]: len(owners)})
        own = "m" if name != "LOAD" else "n"
        scaled[f"of_{name.lower()}"] = f" * factor[{name}_PART[{own}]]" if len(histories) > 1 else ""
        if len(owners):
            tables.add(f"{name}_AT", np.concatenate(places), "entry")
            tables.add(name, np.concatenate(values))
            if len(histories) > 1:
                tables.add(f"{name}_PART", owners, "unsigned char")
    still = "(LOAD_PART[n] ? 0 : LOAD[n])" if len(histories) > 1 else "LOAD[n]"
    return {**scaled, "still": still}


def add_contact(tables: Tables, system: System, bodies: Sequence[str]) -> None:
    """Add planes and the columns of masses that may touch them."""
    found: dict[tuple[int, int, float, float], float] = {}
    for contact in system.problem.contacts:
        body, own = bodies.index(contact.name), contact.weights > 0.0
        k, over = contact.share * contact.full * contact.area, contact.rounded * contact.thickness
        for c, p in np.argwhere(k > 0.0):
            key = body, contact.nodes[c][own[p]].min(), contact.offset[c, p], over[c, p]
            found[key] = found.get(key, 0.0) + k[c, p]
    tables.define(PRESSABLE=len(found))
    if found:
        planes = system.scene.obstacles
        tables.add("TOUCHED", [key[0] for key in found], "")
        tables.add("TOUCHING", [key[1] for key in found], "entry")
        tables.add("TOUCH", [(k, key[2], key[3]) for key, k in found.items()])
        tables.add("PLANE", [[*o.position, *o.direction, o.contact_damping, o.friction] for o in planes])


def add_growth(tables: Tables, system: System) -> int:
    """Add how what springs measure without stress depends on the factors of natural states: a quadratic form,
    found from its values. Return how many measures there are, 0 of a sheet that is flat at rest."""
    state = system.assembly.natural
    if state is None:
        return 0
    extra = 0 if system.scene.dampers is None else len(system.damping.dampers[0])

    def measured(*sources: tuple[int, float]) -> np.ndarray:
        factors = np.zeros(len(state.factors()))
        for source, factor in sources:
            factors[source] += factor
        links, *cells = state.of(factors).springs[:4]
        own = [np.zeros((3, len(one))) if one.natural is None else one.natural[1:] for one in cells]
        return np.concatenate([links.natural, np.zeros(extra), *(each.T.ravel() for each in own)])

    count, found = len(state.factors()), []
    one = [measured((s, 1.0)) for s in range(count)]
    less = [measured((s, -1.0)) for s in range(count)]
    for s in range(count):
        found.append((s, NONE, 0.5 * (one[s] - less[s])))
        found.append((s, s, 0.5 * (one[s] + less[s])))
        found += [(s, t, measured((s, 1.0), (t, 1.0)) - one[s] - one[t]) for t in range(s)]
    most = 1e-15 * max(float(np.abs(values).max()) for *_, values in found)
    entries = [
        (at, s, t, values[at]) for s, t, values in found for at in np.flatnonzero(np.abs(values) > most)
    ]
    tables.define(GROWTHS=len(entries))
    tables.add("GROWTH_AT", [at for at, *_ in entries], "unsigned")
    tables.add("GROWTH_OF", [(s, t) for _, s, t, _ in entries], "unsigned char")
    tables.add("GROWTH", [value for *_, value in entries])
    histories = [source.of.history for source in sources_of(system.scene)]
    if any(histories):
        tables.add("SOURCE_COURSE", [tables.course(one, "factor") for one in histories], "int")
    elif tables.knots:
        tables.add("SOURCE_COURSE", [-1] * count, "int")
    return len(one[0])


def checked(system: System, start: State, step: float, steps: int) -> tuple[str, str]:
    """Return the text of check.csv, probes [m], forces of supports and obstacles [N] and energies [J] in so
    many of `lumped`'s own steps, "" where they fail, and why."""
    scene, every = system.scene, max(1, steps // MOMENTS)
    probes = lumped.MidSurface(system.assembly.lattice, scene.probe_points())
    rows, state, integrator = [], start, lumped.INTEGRATORS["verlet"](system, step)
    while True:
        placed = system.prescribed.support_acceleration(state.time)
        energies, exerted = system.balance(replace(state, a=state.a + placed))
        forces = [*system.problem.constraints.reactions(exerted)[0].values()]
        at = state.u, system.drive(state.time)
        forces += [item.exerted(at, state.v).sum(axis=0) for item in system.items]
        row: list[Any] = [[state.time], probes.of(state.u).ravel(), *forces, [*energies.values()]]
        rows.append(np.concatenate(row).tolist())
        if len(rows) > steps // every:
            break
        left = every
        try:
            while left:
                advance = integrator.march(state, step, left)
                state, left = advance.state, left - advance.steps
        except lumped.StepFailed as error:
            return "", str(error)
        if not system.assembly.links.largest_strain(state.u) < LARGEST:
            return "", f"at {state.time:.4g} s a spring is {1 + LARGEST:g} times as long as at rest"
    bodies = [*named(scene.supports), *scene.named_obstacles()]
    names = [f"{name}_{axis}" for name in (*scene.probes, *bodies) for axis in "xyz"]
    header = [re.sub("[ ,\n]", "_", name) for name in ("time", *names, *energies)]
    return "\n".join([",".join(header), *(",".join(map(repr, row)) for row in rows)]) + "\n", ""


def c_files(scene: Scene, calibration: Calibration, precision: str) -> dict[str, Write]:
    """Return the files of `--for c`."""
    found = program(scene, calibration, precision)
    return {name: partial(write_text, text=text) for name, text in found.texts.items()}
