"""A lattice in motion as C99 without a library: sheet.h, sheet.c, and main.c that tests them by check.csv.

The program is `scripts/sheet.c`, velocity Verlet as in `lumped`, with tables written here; `scripts/rubber.c`
and `scripts/patch.c` are added for rubber, balls and bars. Chains and branches are refused.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from string import Template
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import lumped
from comparisons.codes.c_tables import PRECISIONS, WHOLE, Tables, identifiers
from comparisons.codes.files import script
from sheetbench.answers.history import ENERGIES
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput, require_choice
from sheetbench.numerics.time.method import Advance
from sheetbench.runs.record import width
from sheetbench.runs.run import Run
from sheetbench.runs.schedule import Schedule
from sheetbench.runs.store import MemoryStore
from sheetbench.scenes import Scene, require_no_branches, tilt_axes
from sheetbench.scenes.meaning.natural_state import sources_of
from sheetbench.scenes.objects.obstacles import SLIP_SPEED, Plane
from sheetbench.scenes.objects.sheet import Gravity
from sheetbench.scenes.objects.supports import named
from sheetbench.sources import version

if TYPE_CHECKING:
    from lumped import Calibration, State, System

CHECKED, FEW, MOMENTS = 2000, 200, 20  # steps, those of natural states that change, and samples of them
TRIES, SHORTER = 5, 0.75  # steps to check by, and how much shorter than the last


class Program(NamedTuple):
    """texts: the files by name; inputs: unit and start of each, None of one that a history sets, by their
    numbers in C; outputs: units; step: [s]."""

    texts: dict[str, str]
    inputs: dict[str, tuple[str, float | None]]
    outputs: dict[str, str]
    step: float


def program(
    scene: Scene, calibration: Calibration, precision: str = "double", steps: int = CHECKED
) -> Program:
    """Return a scene's lattice in motion as a program in C, with the longest of some steps whose run of so
    many of them succeeds. Raises BadInput for features that the program lacks, and if no run succeeds."""
    require_choice("--precision", precision, tuple(PRECISIONS))
    if scene.actuators:
        own = ", ".join(scene.named_actuators())
        raise BadInput(f"--for c: actuators: {own}: not in the C program")
    require_no_branches(scene.material, "the C program")
    system, start = lumped.in_motion(scene, calibration)
    system.assembly.require_energy()
    limit, tables = lumped.step_limit(system, start.u), Tables(precision)
    steps = FEW if system.growing is not None else steps
    for share in SHORTER ** np.arange(TRIES):
        step = float(tables.rounded(share * limit.advised))
        rows, fault = samples(system, start, step, steps)
        if not fault:
            break
    else:
        raise BadInput(f"--for c: the check of its steps ends early: {fault}")
    scene, lattice = system.scene, system.assembly.lattice
    bodies = named(scene.supports) | scene.named_obstacles()
    sources = {source.name: source.of for source in sources_of(scene)}
    names = {"POINT": identifiers(scene.probes), "BODY": identifiers(bodies), "SOURCE": identifiers(sources)}
    steady = scene.gravity.acceleration if scene.gravity and not scene.gravity.history else (0.0, 0.0, 0.0)
    inputs: dict[str, tuple[str, float | None]]
    inputs = {f"{point}.F{axis}": ("N", 0.0) for point in names["POINT"] for axis in "xyz"}
    inputs |= {f"gravity.{axis}": ("m/s2", g) for axis, g in zip("xyz", steady, strict=True)}
    given = zip(names["SOURCE"], sources.values(), strict=True)
    inputs |= {f"{source}.factor": ("", None if natural.history else 1.0) for source, natural in given}
    outputs = {f"{point}.u{axis}": "m" for point in names["POINT"] for axis in "xyz"}
    outputs |= {f"{body}.R{axis}": "N" for body in names["BODY"] for axis in "xyz"}
    outputs |= {f"energy.{name}": "J" for name in ENERGIES[:3]}
    (nx, ny, layers), n = lattice.grid, lattice.mass_count
    size, middles = n + nx * ny, lattice.positions.reshape(-1, layers, 3).mean(axis=1)
    tables.lines.append(f"typedef {WHOLE[np.min_scalar_type(size).itemsize]} entry;")
    tables.add("SHEET_REST", np.concatenate([lattice.positions, middles]), storage="")
    add_springs(tables, system)
    add_masses(tables, system)
    add_loads(tables, system, calibration, steady)
    add_contact(tables, system)
    add_growth(tables, system)
    loads = dict.fromkeys(one.history for one in (scene.gravity, *scene.loads) if one and one.history)
    histories = [*(natural.history for natural in sources.values()), *loads]
    motions = [tables.curves(body.motion, "displacement", 3) for body in bodies.values()]
    tables.add("MOTION", np.reshape(motions, (-1, 3)).astype(int), "int")
    tables.add("HISTORY", [first for one in histories for first in tables.curves(one, "factor", 1)], "int")
    tables.add("KNOT", np.reshape(tables.knots, (-1, 6)), "double")
    tables.add("INPUT", [start or 0.0 for _, start in inputs.values()])
    tables.add("START", start.u if start.u.any() else start.u[:1])
    sizes = {"POINTS": len(scene.probes), "SUPPORTS": len(scene.supports), "BODIES": len(bodies)}
    sizes |= {"SOURCES": len(sources), "LOADS": len(loads), "MASSES": n, "ROWS": size, "LAYERS": layers}
    sizes |= {"COLUMNS_X": nx, "COLUMNS_Y": ny, "AIR": size if scene.air else 0}
    sizes |= {name: tables.sizes.pop(name) for name in ("CONTACTS", "GROWN")}
    numbers = [f"SHEET_{name} = {size}" for name, size in sizes.items()]
    numbers += [f"SHEET_{kind}_{name} = {k}" for kind, of in names.items() for k, name in enumerate(of)]
    rubber = system.assembly.any_strain
    texts = dict(
        title=re.sub(r"[^ -~]|\*/|/\*", "?", f"{scene.name}, {nx} x {ny} x {layers}, {calibration.method}"),
        version=version(), real=tables.real, numbers=",\n  ".join(numbers), step=step, steps=steps,
        largest=f"{limit.step:.4g}", safety=f"{step / limit.step:.3g}", slip=SLIP_SPEED**2,
        libm="sqrt" + rubber * ", exp, log", tables="\n".join(tables.lines),
        sizes=", ".join(f"{name} = {int(size)}" for name, size in tables.sizes.items()),
        rubber=script("rubber.c") if rubber else "#define rubber(d, g, k, on) 0",
        patch=script("patch.c") if tables.sizes["BLOCKS"] else "#define patch(s, of) ((void)(of), (real)0)",
    )  # fmt: skip
    lines = [",".join(["time", *outputs]), *(",".join(map(repr, row)) for row in rows.tolist())]
    files = {name: Template(script(name)).substitute(texts) for name in ("sheet.h", "sheet.c", "main.c")}
    files["check.csv"] = "\n".join(lines) + "\n"
    return Program(files, inputs, outputs, step)


def samples(system: System, start: State, step: float, steps: int) -> tuple[np.ndarray, str]:
    """Return time [s], probes [m], forces of supports and obstacles [N] and energies [J] at samples of so
    many of `lumped`'s own steps [s], and why `lumped.simulate` would end before, "" where it would not."""
    observer, method = lumped.LatticeObserver(system), lumped.INTEGRATORS["verlet"](system, step)
    method.kinks = np.empty(0)  # the program's steps pass over them
    store = MemoryStore({"samples": (width(observer.columns),)})
    run = Run(method, observer, Schedule(MOMENTS, steps // MOMENTS * step), store, (), None)
    status, message = run.finish(lambda: Advance(start, 0.0, 0.0))
    rows, sound = store.rows("samples"), status in (Status.CONVERGED, Status.STRAIN_OUTSIDE_MODEL)
    return np.hstack([rows[:, :1], rows[:, 6:], rows[:, 1:4]]), message * (not sound)


def add_springs(tables: Tables, system: System) -> None:
    """Add links and cells with their dampers."""
    springs: tuple[Any, ...] = system.assembly.springs[:4]
    (links, *families), dampers = springs, system.scene.dampers
    tau = system.scene.material.dashpot_time if dampers is None else 0.0
    pairs: Any = [(links, (1.0, tau))]  # shares of springs and dampers
    pairs += [(of, (0.0, 1.0)) for of in system.damping.dampers if dampers]
    tables.sizes |= {"DAMPED": tau > 0.0 or len(pairs) > 1, "RUBBER": system.assembly.any_strain}
    tables.add("LINK", np.concatenate([of.nodes for of, _ in pairs]))
    rows = [[of.offset, np.linalg.norm(of.offset, axis=1), np.outer(of.stiffness, by)] for of, by in pairs]
    tables.add_distinct("LINK", np.concatenate([*map(np.column_stack, rows)]))
    corners, cells = [], []
    for family in families:  # layers, mid-surface, upright faces
        row, k, masses = np.zeros((len(family), 23)), family.constants, family.nodes[:, :, 0]
        row[:, :6], row[:, 13] = family.sides.reshape(-1, 6), tau
        if k.shape[1] == 13:  # rubber
            k, row[:, 14:] = k[:, :4], k[:, 4:]
        row[:, 6 : 6 + k.shape[1]] = k
        cells.append(row)
        corners.append(middle_of(system, masses) if family.nodes.shape[2] > 1 else masses)
    tables.sizes["UPRIGHT"] = sum(map(len, cells[:-1]))
    tables.add("CELL", np.concatenate(corners), "entry")
    tables.add_distinct("CELL", np.concatenate(cells)[:, : 23 if system.assembly.any_strain else 14])


def middle_of(system: System, masses: np.ndarray) -> np.ndarray:
    """Return the averaging matrix from the masses to the mid-surface points of their columns."""
    lattice = system.assembly.lattice
    return np.asarray(lattice.mass_count + masses // lattice.grid[2])


def add_masses(tables: Tables, system: System) -> None:
    """Add matrices of columns of masses along each axis, from forces to free accelerations and from
    velocities to momenta; masses' damping, the supports that move them, and sums of the supports' forces."""
    constraints, p, n = system.problem.constraints, system.assembly.lattice.grid[2], len(system.lattice_mass)
    of_layers = np.tile(np.eye(p)[:, :, None], (1, n // p, 3))
    both = [[apply(one) for one in of_layers] for apply in (system.accelerate, system.momentum)]
    matrices = np.reshape(both, (2, p, -1, p, 3)).transpose(2, 4, 0, 3, 1)
    tables.add_distinct("COLUMN", matrices.reshape(-1, 2 * p * p))
    tables.sizes["RATED"] = bool(system.damping.rate.any())
    tables.add("RATE", system.damping.rate)
    owner, supports = np.zeros((n, 3), int), enumerate(named(system.scene.supports).items(), start=1)
    for number, (name, support) in sorted(supports, key=lambda one: one[1][1].motion is None):
        masses, axes = constraints.holders[name]
        for axis in axes:  # a corner goes with the support that moves
            rows = masses.ravel()[owner[masses.ravel(), axis] == 0]
            firm = ~constraints.fixed[rows, axis] | (axis in tilt_axes(support)) | (support.motion is None)
            owner[rows[firm], axis] = number
    tables.add("OWNER", owner)
    tables.add_sparse("SUMMED", constraints.summed)


def add_loads(tables: Tables, system: System, calibration: Calibration, gravity: Sequence[float]) -> None:
    """Add points, after them the weight per gravity [m/s²], dead loads without the weight by a gravity,
    pressures and moments, by their histories, and the air's drag."""
    import scipy.sparse as sp

    scene, lattice, drag = system.scene, system.assembly.lattice, system.damping.drag
    layers, n, parts = lattice.grid[2], lattice.mass_count, system.problem.loads.parts
    unit = scene.replace(gravity=Gravity(acceleration=(0.0, 0.0, -1.0)), loads=())
    weight = -lumped.build_problem(unit, calibration).loads.parts[0].dead[:, 2]
    surfaces = [lumped.MidSurface(lattice, scene.probe_points(), order=order) for order in (3, 1)]
    shares = [of.shared(np.eye(len(scene.probes)), n).T[:, ::layers] * layers for of in surfaces]
    probe, near = (np.pad(of, ((0, 0), (n, 0))) for of in shares)
    tables.add_sparse("PROBE", probe)
    tables.add_sparse("NEAR", [*near, np.pad(weight, (0, n // layers))])
    dead = [part.dead - (part is parts[0]) * np.outer(weight, gravity) for part in parts]
    tables.add_sparse("DEAD", np.reshape(dead, (len(parts), -1)))
    tables.add_sparse("PRESSURE", [part.pressure for part in parts])
    tables.add_sparse("MOMENT", sp.block_diag([part.moments[None] for part in parts]))
    edges = np.concatenate([part.columns[:, :, 0] for part in parts])
    tables.add("EDGE", np.column_stack([edges[:, 0], middle_of(system, edges[:, 1:])]), "entry")
    tables.add("MIDDLE", middle_of(system, lattice.mid_cells[:, :, 0]), "entry")
    tables.add("COVER", drag.shares if scene.air else [0.0])
    tables.add("DRAG", drag.coefficient * drag.weights / lattice.grid[2] if scene.air else [0.0])


def add_contact(tables: Tables, system: System) -> None:
    """Add obstacles and the points of the mid-surface that may touch them, on planes columns of masses, else
    nine of each block of a cell."""
    lattice, obstacles = system.assembly.lattice, system.scene.obstacles
    points, blocks = [np.empty((0, 12))], [np.empty((0, 9), int)]
    for number, contact in enumerate(system.problem.contacts):
        body, size, offset = contact.obstacle, contact.sizes[..., 0], contact.offset
        if not contact.at_corners:
            of_cells = sum(map(len, points)) + len(contact.basis) * np.arange(len(size))
            blocks.append((of_cells[:, None, None] + contact.groups).reshape(-1, 9))
        if isinstance(body, Plane):  # from where the points rest
            rest = contact.weights @ lattice.positions[contact.nodes]
            offset = offset - (rest - body.position) @ body.direction
        values = offset, contact.share * contact.full * size, contact.rounded * contact.thickness
        columns = middle_of(system, contact.nodes[:, None, :: lattice.grid[2]])
        shares = contact.weights.reshape(-1, 4, lattice.grid[2]).sum(axis=2)
        parts = np.full((1, 1, 1), number), columns, shares, np.stack(values, axis=2)
        whole = [np.broadcast_to(part, (*offset.shape, part.shape[-1])) for part in parts]
        points.append(np.concatenate(whole, axis=2).reshape(-1, 12))
    tables.add("CONTACT", np.concatenate(points)[:, 0].astype(int))
    tables.add("POINT_AT", np.concatenate(points)[:, 1:5].astype(int))
    tables.add_distinct("POINT", np.concatenate(points)[:, 5:])
    shapes = [[*o.position, *o.direction, o.radius, o.contact_damping, o.friction] for o in obstacles]
    tables.add("OBSTACLE", np.nan_to_num(np.reshape(shapes, (-1, 9)), posinf=0.0))
    tables.add("BLOCK", np.concatenate(blocks), "int")
    if tables.sizes["BLOCKS"]:
        (x, wx), (y, wy) = (np.polynomial.legendre.leggauss(order) for order in (4, 16))
        tables.add("ALONG", np.stack([x, wx], axis=1))
        tables.add("ACROSS", np.stack([0.5 * (3.0 * y - y**3), 1.5 * (1.0 - y**2) * wy], axis=1))


def add_growth(tables: Tables, system: System) -> None:
    """Add the springs' stress-free measures as a quadratic form in the factors of natural states; nothing for
    a sheet flat at rest."""
    state: Any = system.assembly.natural
    dampers = 0 if system.scene.dampers is None else len(system.damping.dampers[0])

    def measured(*factors: float) -> np.ndarray:
        links, *cells = state.of(np.array(factors)).springs[:4]
        parts = [np.zeros((3, len(of))) if of.natural is None else of.natural[1:] for of in cells]
        return np.concatenate([links.natural, np.zeros(dampers), *(part.T.ravel() for part in parts)])

    terms: list[np.ndarray] = []
    units = np.eye(0 if state is None else len(state.factors()))
    for number, unit in enumerate(units):
        plus, minus = measured(*unit), measured(*-unit)
        products = [measured(*(unit + other)) - plus - measured(*other) for other in units[:number]]
        terms += [0.5 * (plus - minus), *products, 0.5 * (plus + minus)]
    tables.add("GROWTH", terms or np.empty((0, 1)))
    tables.sizes["GROWN"] = len(terms[0]) if terms else 0
