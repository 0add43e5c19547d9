"""The files of a sheet of triangles, by code: sheet.json, a script that needs the code and NumPy alone, and
what else the code reads. `Problem` is what every writer starts from.

MuJoCo's sheet is a flex. Vertices slide along x, y and z; held vertices have no joints there. Loads other
than weight are motors, with their forces in the keyframe `loaded`. Source: MuJoCo's XML reference,
`deformable/flex`, `keyframe`.

SOFA has a lattice as a scene of plain XML: points, masses and springs between two of them. Components as
named from v24.06 on; before, `SpringForceField` was `StiffSpringForceField`, and constraints
`FixedConstraint` and `PartialFixedConstraint`. A spring is "first second stiffness damping length". Held
points start where they are held, and springs have their own lengths, so that a bent edge bends the sheet from
the first step on. Implicit Euler steps of 10 ms bring it to rest; for motion make them shorter.

Source: SOFA's component reference, `Sofa.Component.SolidMechanics.Spring`, and its list of renamed ones.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.resources import files as resources
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.codes.sheet_mesh import SheetMesh
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from lumped import Description

Keys = Mapping[str, float]
JSON = "sheet.json"
HALF_LENGTH = 50.0  # radii: half the length of a cylinder that touches the sheet
MJCF = """\
<mujoco model="sheet">
<option timestep="0.002" integrator="discrete" gravity="{gravity}"/>
<worldbody>
{bodies}
</worldbody>
<deformable><flex name="sheet" dim="2" radius="{radius!r}" body="{names}" element="{element}">\
<elasticity young="{young!r}" poisson="{poisson!r}" thickness="{thickness!r}" elastic2d="both"{damping}/>\
<contact selfcollide="none" condim="1"/></flex></deformable>
{loads}</mujoco>
"""
JOINT = '<joint name="{name}{axis}" type="slide" axis="{along}" damping="0.0"/>'
POINT_INERTIA = '<inertial pos="0 0 0" mass="{mass!r}" diaginertia="1e-09 1e-09 1e-09"/>'  # it does not turn


@dataclass(frozen=True)
class Problem:
    """A mesh, the code's parameters by name, and the membrane's C11 [N/m], which bounds the steps.
    clamp: factor of hinges that lie on a clamp."""

    mesh: SheetMesh
    keys: Keys
    stretching: float
    tetrahedra: np.ndarray | None = None
    clamp: float = 1.0


def join_numbers(values: Any) -> str:
    """Return numbers with all their digits, separated by spaces."""
    return " ".join(map(repr, np.asarray(values).ravel().tolist()))


def script(name: str) -> str:
    """Return the text of a script in the folder `scripts`."""
    return (resources("comparisons.codes") / "scripts" / name).read_text(encoding="utf-8")


def mujoco(of: Problem) -> str:
    """Return the MJCF."""
    mesh, names = of.mesh, [f"mass{n}" for n in range(len(of.mesh.held))]
    bodies = [_geom(one) for one in mesh.obstacles]
    loads: dict[str, float] = {}
    for name, place, mass, held, force in zip(
        names, mesh.vertices, mesh.masses.tolist(), mesh.held, mesh.forces.tolist(), strict=True
    ):
        joints = ""
        if not held:
            axes = zip("xyz", ("1 0 0", "0 1 0", "0 0 1"), strict=True)
            joints = "".join(JOINT.format(name=name, axis=axis, along=along) for axis, along in axes)
            joints += POINT_INERTIA.format(mass=mass)
            loads |= {f"{name}{axis}": value for axis, value in zip("xyz", force, strict=True) if value}
        bodies.append(f'<body name="{name}" pos="{join_numbers(place)}">{joints}<site name="{name}"/></body>')
    motors = "".join(f'<motor joint="{joint}"/>\n' for joint in loads)
    keyframe = f'<keyframe><key name="loaded" ctrl="{join_numbers([*loads.values()])}"/></keyframe>\n'
    return MJCF.format(
        gravity=join_numbers(mesh.gravity),
        bodies="\n".join(bodies),
        radius=mesh.offset,
        names=" ".join(names),
        element=join_numbers(mesh.triangles),
        damping=f' damping="{of.keys["damping"]!r}"' if "damping" in of.keys else "",
        loads=f"<actuator>\n{motors}</actuator>\n{keyframe}" if loads else "",
        **{name: of.keys[name] for name in ("young", "poisson", "thickness")},
    )


def _geom(obstacle: Mapping[str, Any]) -> str:
    """Return an obstacle as a MuJoCo geom; half the length of a cylinder is HALF_LENGTH times its radius."""
    along, radius = obstacle.get("normal", obstacle.get("axis")), obstacle.get("radius", 0.0)
    size = {"plane": "0 0 1", "sphere": f"{radius!r}", "cylinder": f"{radius!r} {HALF_LENGTH * radius!r}"}
    turned = "" if along is None else f' zaxis="{join_numbers(along)}"'
    kind, at, friction = obstacle["kind"], join_numbers(obstacle["position"]), obstacle["friction"]
    return (
        f'<geom type="{kind}" size="{size[kind]}" pos="{at}"{turned} condim="{3 if friction else 1}" '
        f'friction="{friction!r} 0 0"/>'
    )


def vtk(of: Problem) -> str:
    """Return VTK of tetrahedra, whose sides are PyBullet's springs."""
    assert of.tetrahedra is not None
    count = len(of.tetrahedra)
    lines = ["# vtk DataFile Version 2.0", "sheet", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(of.mesh.vertices)} double", *map(join_numbers, of.mesh.vertices)]
    lines += [f"CELLS {count} {5 * count}", *(f"4 {join_numbers(cell)}" for cell in of.tetrahedra)]
    return "\n".join([*lines, f"CELL_TYPES {count}", *["10"] * count]) + "\n"


def obj(of: Problem) -> str:
    """Return Wavefront OBJ."""
    corners = [f"f {join_numbers(triangle + 1)}" for triangle in of.mesh.triangles]
    return "\n".join([*(f"v {join_numbers(place)}" for place in of.mesh.vertices), *corners]) + "\n"


OWN_MASSES = ("newton", "mujoco", "genesis")  # those whose files give each vertex a mass of its own
OBSTACLES = ("newton", "mujoco")  # those whose files have them
WRITERS: Mapping[str, Mapping[str, Callable[[Problem], str]]] = {  # what each reads beside JSON and script
    "newton": {},
    "mujoco": {"mujoco.xml": mujoco},
    "pybullet": {"sheet.vtk": vtk},
    "genesis": {"sheet.obj": obj},
}


def files(code: str, of: Problem) -> dict[str, str]:
    """Return the texts of a code's files by name."""
    own = {"parameters": dict(of.keys), "stretching": of.stretching, "clamp": of.clamp}
    document = json.dumps({**of.mesh.document(), **own}, indent=1) + "\n"  # as the scripts read it
    files = {name: write(of) for name, write in WRITERS[code].items()}
    return {**files, JSON: document, f"run_{code}.py": script(f"run_{code}.py")}


PLUGINS = "Constraint.Projective LinearSolver.Direct Mass MechanicalLoad ODESolver.Backward "
PLUGINS += "SolidMechanics.Spring StateContainer Topology.Container.Constant"
SCENE = """\
<?xml version="1.0"?>
<Node name="root" dt="0.01" gravity="{gravity}">
{plugins}
  <DefaultAnimationLoop />
  <Node name="sheet">
    <EulerImplicitSolver rayleighMass="{drag!r}" rayleighStiffness="0" />
    <SparseLDLSolver template="CompressedRowSparseMatrixMat3x3" />
    <MechanicalObject template="Vec3d" position="{places}" rest_position="{rest}" />
    <MeshTopology edges="{edges}" />
    <DiagonalMass template="Vec3d,Vec3d" vertexMass="{masses}" />
{supports}    <SpringForceField template="Vec3d" spring="{springs}" />
{loads}  </Node>
</Node>
"""


def to_sofa(lattice: Description, scene: Scene) -> str:
    """Return the scene's text. Raises BadInput for springs that are not between two masses, loads that are
    not dead, and supports that do not hold one mass each."""
    if lattice.cells:
        raise BadInput(
            "--for sofa: has springs between two points alone, and these springs have "
            f"{' and '.join(sorted({table.kind for table in lattice.cells}))} springs of cells; "
            "take --calibration central"
        )
    if any(len(hold.masses) > 1 for hold in lattice.holds):
        raise BadInput(
            "--for sofa: hinged and held edges hold the mean of their layers, which SOFA has no "
            "constraint for; clamped and curved edges only"
        )
    if len(lattice.pressure) or lattice.couples:
        raise BadInput("--for sofa: pressure and edge moments follow the sheet; dead loads only")
    places, held = lattice.positions.copy(), np.zeros(lattice.positions.shape, dtype=bool)
    for hold in lattice.holds:
        held[hold.masses[0], hold.axis] = True
        places[hold.masses[0], hold.axis] += hold.displacement
    gravity = np.zeros(3) if scene.gravity is None else np.array(scene.gravity.last_acceleration)
    forces = lattice.dead - lattice.mass[:, None] * gravity
    forces[np.abs(forces) < 1e-12 * np.abs(lattice.dead).max(initial=0.0)] = 0.0
    loaded, links = np.flatnonzero(forces.any(axis=1)), lattice.links
    columns = (links.masses, links.stiffness, links.damping, links.rest_length)
    springs = zip(*(column.tolist() for column in columns), strict=True)
    return SCENE.format(
        plugins="\n".join(f'  <RequiredPlugin name="Sofa.Component.{one}" />' for one in PLUGINS.split()),
        gravity=join_numbers(gravity),
        drag=lattice.damping_rate,
        places=join_numbers(places),
        rest=join_numbers(lattice.positions),
        edges=join_numbers(links.masses),
        masses=join_numbers(lattice.mass),
        supports="".join(_format_fixed(held, axes) for axes in np.unique(held, axis=0)[::-1] if axes.any()),
        springs=" ".join(f"{a} {b} {k!r} {c!r} {length!r}" for (a, b), k, c, length in springs),
        loads=f'    <ConstantForceField template="Vec3d" indices="{join_numbers(loaded)}" '
        f'forces="{join_numbers(forces[loaded])}" />\n'
        if len(loaded)
        else "",
    )


def _format_fixed(held: np.ndarray, axes: np.ndarray) -> str:
    """Return a constraint for all points held along the given axes."""
    indices = join_numbers(np.flatnonzero((held == axes).all(axis=1)))
    if axes.all():
        return f'    <FixedProjectiveConstraint indices="{indices}" />\n'
    along = join_numbers(axes.astype(int))
    return f'    <PartialFixedProjectiveConstraint indices="{indices}" fixedDirections="{along}" />\n'
