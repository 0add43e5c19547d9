"""CalculiX as a model: the sheet as 20-node bricks, two layers through the thickness.

The program `ccx` on the PATH (Debian: calculix-ccx) reads a deck and writes its results in a temporary
folder. All parts of a scene but chains and edge moments are supported.

The input deck has bricks with reduced integration (C3D20R), and one static step under the whole load. NLGEOM
makes the step geometrically nonlinear: total Lagrangian, with the linear-elastic law between Green strain and
second Piola–Kirchhoff stress (St Venant–Kirchhoff's), or *HYPERELASTIC for a rubber. The default tolerances
(residual 5e-3 of the mean force, correction 1e-2 of the displacement) are too coarse for comparisons, so the
deck tightens them. One half of a pressure acts on the lower and one on the upper face, and both follow the
deformation. Parts of different materials are element sets.

Source: CalculiX CrunchiX user's manual 2.20, sections on *HYPERELASTIC, *STATIC, *CONTROLS, *DLOAD,
*TRANSFORM, *NODE PRINT, *ELASTIC, *ORIENTATION.
"""

import re
import shutil
from collections.abc import Iterable, Mapping
from contextlib import suppress
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from comparisons.external.answer import BRICK_MOMENTS, Code, CodeAnswer, refusal
from comparisons.external.bricks import Bricks, forces, held, materials
from comparisons.external.output import Failed, output_of
from sheetbench.scenes import Material, Pressure, Scene
from sheetbench.scenes.objects.fields import SHAPED
from sheetbench.scenes.objects.orthotropy import FIBRES, impossible_in_space

RESIDUAL, CORRECTION = 1e-7, 1e-7  # of the mean force, of the displacement: tolerances of an increment
FIRST, LEAST, LARGEST = 1.0, 1e-6, 1.0
# Rubber laws: CalculiX' names and constants. Its energies depend on the isochoric stretches and on (J − 1)²,
# as ours for ν → ½. Strips pulled by 58 % differ by 1.4 % at ν = 0.49, by 0.14 % at 0.499.
LAWS = {
    "neo-hookean": ("NEO HOOKE", ("c10",)),
    "mooney-rivlin": ("MOONEY-RIVLIN", ("c10", "c01")),
    "yeoh": ("YEOH", ("c10", "c20", "c30")),
}
INCOMPRESSIBLE = 0.495  # Poisson's ratio above which its laws are nearly ours
NONE = 1e30  # coefficient that disables higher powers of J − 1
BELOW, ABOVE = "P1", "P2"  # faces of a brick


def deck(scene: Scene, bricks: Bricks) -> str:
    """Return the text of the input deck."""
    supports = held(scene, bricks)
    pull = np.einsum("nrc,nc->nr", supports.axes, forces(scene, bricks))
    lines = ["*NODE, NSET=NALL", *_rows(bricks.positions, 1)]
    lines += ["*ELEMENT, TYPE=C3D20R, ELSET=EALL", *_elements(bricks.elements)]
    layers = bricks.plan.nelements * np.arange(bricks.layers)
    for part, (material, on) in enumerate(materials(scene, bricks), 1):
        lines += [f"*ELSET, ELSET=PART{part}", *(f"{e + 1}" for e in (layers[:, None] + on).ravel())]
        lines += [f"*MATERIAL, NAME=SHEET{part}", *_elasticity(material, f"FIBRES{part}")]
        oriented = f", ORIENTATION=FIBRES{part}" if material.kind == "orthotropic" else ""
        lines += ["*DENSITY", f"{material.density!r}"]
        lines += [f"*SOLID SECTION, ELSET=PART{part}, MATERIAL=SHEET{part}{oriented}"]
    for node in np.flatnonzero(supports.turned):
        along, across = supports.axes[node, :2]
        lines += [f"*NSET, NSET=AT{node + 1}", f"{node + 1}", f"*TRANSFORM, NSET=AT{node + 1}, TYPE=R"]
        lines += [", ".join(f"{c:.12e}" for c in (*along, *across))]
    for tie in supports.tied:
        terms = zip(tie.nodes + 1, tie.weights, strict=True)
        lines += ["*EQUATION", f"{len(tie.nodes)}"]
        lines += [f"{node}, {tie.axis + 1}, {weight:.12e}" for node, weight in terms]
    lines += ["*STEP, NLGEOM, INC=1000", "*STATIC", f"{FIRST}, 1.0, {LEAST}, {LARGEST}"]
    lines += ["*CONTROLS, PARAMETERS=FIELD", f"{RESIDUAL}, {CORRECTION}, , , {RESIDUAL}, 1e-9, 1e-9"]
    lines += ["*CONTROLS, PARAMETERS=TIME INCREMENTATION", "8, 12, 9, 40, 20, 8"]
    lines += ["*BOUNDARY"]
    for node, axis in zip(*np.nonzero(supports.fixed), strict=True):
        lines.append(f"{node + 1}, {axis + 1}, {axis + 1}, {supports.value[node, axis]:.12e}")
    lines += _loads(scene, pull, bricks)
    lines += ["*NODE PRINT, NSET=NALL, GLOBAL=YES, FREQUENCY=1000", "U", "*END STEP", ""]
    return "\n".join(lines)


def _elasticity(material: Material, axes_name: str) -> list[str]:
    if material.kind == "orthotropic":
        ply = material.ply
        moduli, ratios = (
            (ply.young_1, ply.young_2, ply.young_3),
            (ply.poisson_12, ply.poisson_13, ply.poisson_23),
        )
        first = ", ".join(f"{c:.12e}" for c in (*moduli, *ratios, ply.shear_12, ply.shear_13))
        c, s = np.cos(ply.angle), np.sin(ply.angle)
        axes = f"{c:.12e}, {s:.12e}, 0., {-s:.12e}, {c:.12e}, 0."
        constants = ["*ELASTIC, TYPE=ENGINEERING CONSTANTS", first, f"{ply.shear_23:.12e}"]
        return [*constants, f"*ORIENTATION, NAME={axes_name}", axes]
    if material.law is None:
        return ["*ELASTIC", f"{material.young!r}, {material.poisson!r}"]
    (name, keys), energy = LAWS[material.law], material.energy
    volume = 6.0 * (1.0 - 2.0 * material.poisson) / material.young  # 2/K
    constants = [getattr(energy, key) for key in keys]
    more = [NONE, NONE] if name == "YEOH" else []
    return [f"*HYPERELASTIC, {name}", ", ".join(f"{c:.12e}" for c in (*constants, volume, *more))]


def _loads(scene: Scene, pull: np.ndarray, bricks: Bricks) -> list[str]:
    lines = []
    if pull.any():
        lines.append("*CLOAD")
        for node, axis in zip(*np.nonzero(pull), strict=True):
            lines.append(f"{node + 1}, {axis + 1}, {pull[node, axis]:.12e}")
    if scene.gravity is not None:
        acceleration = np.array(scene.gravity.last_acceleration)
        if size := float(np.linalg.norm(acceleration)):
            along = ", ".join(f"{c:.12e}" for c in acceleration / size)
            lines += ["*DLOAD", f"EALL, GRAV, {size!r}, {along}"]
    pressure = np.zeros(bricks.plan.nelements)
    for load in scene.loads:
        if isinstance(load, Pressure):
            pressure[bricks.inside(load.where)] += load.last_factor * load.value
    if pressure.any():
        top, pressed = len(bricks.elements) - len(pressure), np.flatnonzero(pressure)
        lines.append("*DLOAD")
        lines += [f"{e + 1}, {BELOW}, {float(0.5 * pressure[e])!r}" for e in pressed]
        lines += [f"{top + e + 1}, {ABOVE}, {float(-0.5 * pressure[e])!r}" for e in pressed]
    return lines


def _rows(values: np.ndarray, first: int) -> Iterable[str]:
    return (f"{i}, " + ", ".join(f"{c:.12e}" for c in row) for i, row in enumerate(values, first))


def _elements(elements: np.ndarray) -> Iterable[str]:
    """Yield the elements over two lines each, because a line has at most sixteen entries."""
    for i, nodes in enumerate((elements + 1).tolist(), 1):
        yield ", ".join(map(str, [i, *nodes[:15]])) + ","
        yield ", ".join(map(str, nodes[15:]))


_HEADING = re.compile(r"^ *displacements .* and time +(\S+) *$", re.MULTILINE)
PROGRAM, JOB = "ccx", "sheet"
VERSION_STATUS = 201  # exit status of `ccx -v`

# Features of drawn sheets that it is given (`Scene.drawn_by`).
DRAWN = (*SHAPED, FIBRES, "sheet.taper_x", "sheet.taper_y", "patch")
CHAINS = "actuators are not supported: it has no joint with a rest angle between rigid bodies"


class CalculiX(Code):
    """The plug-in. settings: elements along the shorter side, near-square; layers of bricks, an even number;
    grading "edges" or "uniform"; time_limit [s]."""

    name, called = "calculix", "CalculiX"
    needs = "the program ccx on the PATH (Debian: calculix-ccx)"
    meshes, layered = (6, 8, 12), True
    settings: ClassVar[dict[str, Any]] = {
        "elements": 8,
        "layers": 2,
        "grading": "edges",
        "time_limit": 600.0,
    }

    def version(self) -> str | None:
        """Return the program's version, None if it is not installed."""
        return _version(shutil.which(PROGRAM))

    def at_rest(self, scene: Scene, settings: Mapping[str, Any], mesh: Bricks) -> CodeAnswer:
        text, reached = deck(scene, mesh), CodeAnswer(np.zeros_like(mesh.positions))
        start = perf_counter()
        with TemporaryDirectory(prefix="sheetbench-ccx-") as name:
            folder = Path(name)
            (folder / f"{JOB}.inp").write_text(text, encoding="ascii")
            try:
                output_of([shutil.which(PROGRAM) or PROGRAM, JOB], folder, settings["time_limit"])
                factor, u = displacements(_read(folder, "dat"), len(mesh.positions))
                reached = CodeAnswer(u, factor)
            except Failed as error:
                reached = reached._replace(note=f"CalculiX: {error}")
            count = iterations(_read(folder, "sta"))
        return reached._replace(iterations=count, seconds=perf_counter() - start)

    def refusal(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        if note := refusal(scene, CHAINS, BRICK_MOMENTS, LAWS, DRAWN):
            return note
        material = scene.material
        for number, patch in enumerate(scene.patches, start=1):
            if patch.thickness not in (None, scene.sheet.thickness):
                thickness = f"patch {number}.thickness = {patch.thickness:g} m"
                return f"{thickness}: its bricks have no steps in thickness"
        if material.law is not None and scene.varied_by:
            return f"{scene.varied_by}: it supports uniform rubbers only"
        if material.kind == "orthotropic":
            return impossible_in_space(material.ply)
        if material.law is None or material.poisson >= INCOMPRESSIBLE:
            return ""
        return (
            f"poisson = {material.poisson:g}: its rubber laws agree with a scene's near ν = ½ only; ν of "
            f"{INCOMPRESSIBLE:g} or more is passed to it"
        )


def _read(folder: Path, ending: str) -> str:
    with suppress(OSError):
        return (folder / f"{JOB}.{ending}").read_text(encoding="utf-8", errors="replace")
    return ""


@cache
def _version(program: str | None) -> str | None:
    if program is None:
        return None
    printed = ""
    with suppress(Failed), TemporaryDirectory() as folder:
        printed = output_of([program, "-v"], Path(folder), 10.0, fine=(0, VERSION_STATUS))
    match = re.search(r"Version +(\S+)", printed, re.IGNORECASE)
    return match.group(1) if match else "of unknown version"


def displacements(dat: str, nodes: int) -> tuple[float, np.ndarray]:
    """Return the load factor of the last increment, and its displacements (nodes, 3) [m], NaN for missing
    nodes. Raises Failed for a file without displacements."""
    headings = list(_HEADING.finditer(dat))
    if not headings:
        raise Failed("its .dat file has no displacements")
    out, last = np.full((nodes, 3), np.nan), headings[-1]
    try:
        for line in dat[last.end() :].split("\n\n", 2)[1].splitlines():
            number, *components = line.split()
            out[int(number) - 1] = [float(c) for c in components]
        return float(last.group(1)), out
    except (ValueError, IndexError):
        raise Failed("its .dat file cannot be read") from None


def iterations(sta: str) -> int:
    """Return the number of equilibrium iterations, each with one factorisation."""
    rows = [line.split() for line in sta.splitlines()]
    counts = [int(row[3]) for row in rows if len(row) >= 7 and all(part.isdigit() for part in row[:4])]
    return max(sum(counts), 1)


MODEL = CalculiX()
