"""The files of a sheet that a code reads, by code: mesh, parameters and a scene that runs.

A code with an interface in Python gets sheet.json and a script that needs the code and NumPy alone; the
others their own formats. `Problem` is what every writer starts from.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from importlib.resources import files as resources
from typing import Any
from xml.etree import ElementTree

import numpy as np

from comparisons.codes.mesh import SheetMesh

Keys = Mapping[str, float]
OBJ, JSON = "sheet.obj", "sheet.json"
RAYLEIGH = {"rayleighMass": 2.0, "rayleighStiffness": 0.0}  # that bring an undamped sheet to rest


@dataclass(frozen=True)
class Problem:
    """A mesh, the code's parameters by name, and the membrane's C11 [N/m], which bounds the steps.
    clamp: factor of hinges that lie on a clamp."""

    mesh: SheetMesh
    keys: Keys
    stretching: float
    tetrahedra: np.ndarray | None = None
    clamp: float = 1.0


def _script(code: str) -> str:
    return (resources("comparisons.codes") / "scripts" / f"run_{code}.py").read_text(encoding="utf-8")


def _json(value: Any) -> str:
    return json.dumps(value, indent=1) + "\n"


def _numbers(values: Any) -> str:
    return " ".join(map(repr, np.asarray(values).ravel().tolist()))


def python_files(code: str, of: Problem) -> dict[str, str]:
    """sheet.json and the code's script."""
    document = {
        **of.mesh.document(),
        "parameters": dict(of.keys),
        "stretching": of.stretching,
        "clamp": of.clamp,
    }
    return {JSON: _json(document), f"run_{code}.py": _script(code)}


def obj(mesh: SheetMesh, material: bool = False) -> str:
    """Wavefront OBJ; material: with coordinates in the plane, as ArcSim has them."""
    lines = [f"v {_numbers(place)}" for place in mesh.vertices]
    lines += [f"vt {_numbers(place[:2])}" for place in mesh.vertices] if material else []
    corner = "{0}/{0}" if material else "{0}"
    lines += ["f " + " ".join(corner.format(1 + v) for v in t) for t in mesh.triangles.tolist()]
    return "\n".join(lines) + "\n"


def mujoco(of: Problem) -> dict[str, str]:
    """MJCF: a body with three slides a vertex, none where it is held; a flex of the triangles."""
    mesh, keys = of.mesh, of.keys
    damping = f' damping="{keys["damping"]!r}"' if "damping" in keys else ""
    parts = [
        f'<mujoco model="sheet">\n<option timestep="0.002" gravity="{_numbers(mesh.gravity)}" '
        'integrator="discrete"><flag contact="disable"/></option>\n<worldbody>'
    ]
    for n, (place, held, mass) in enumerate(
        zip(mesh.vertices, mesh.held.tolist(), mesh.masses.tolist(), strict=True)
    ):
        slides = "".join(
            f'<joint name="v{n}{axis}" type="slide" axis="{way}"/>'
            for axis, way in (("x", "1 0 0"), ("y", "0 1 0"), ("z", "0 0 1"))
        )
        body = "" if held else f'{slides}<inertial pos="0 0 0" mass="{mass!r}" diaginertia="1e-9 1e-9 1e-9"/>'
        parts.append(f'<body name="v{n}" pos="{_numbers(place)}">{body}</body>')
    parts.append(
        f'</worldbody>\n<deformable><flex name="sheet" dim="2" radius="0.0001" body="'
        f'{" ".join(f"v{n}" for n in range(len(mesh.vertices)))}" element="{_numbers(mesh.triangles)}">'
        f'<elasticity young="{keys["young"]!r}" poisson="{keys["poisson"]!r}" '
        f'thickness="{keys["thickness"]!r}" elastic2d="both"{damping}/>'
        '<contact selfcollide="none"/></flex></deformable>'
    )
    loaded = [(n, axis) for n, axis in np.argwhere(mesh.forces).tolist() if not mesh.held[n]]
    if loaded:
        motors = "".join(f'<motor joint="v{n}{"xyz"[axis]}"/>' for n, axis in loaded)
        values = _numbers([mesh.forces[n, axis] for n, axis in loaded])
        parts.append(
            f'<actuator>{motors}</actuator>\n<keyframe><key name="loaded" ctrl="{values}"/></keyframe>'
        )
    return {"mujoco.xml": "\n".join([*parts, "</mujoco>\n"]), **python_files("mujoco", of)}


def pybullet(of: Problem) -> dict[str, str]:
    """VTK of tetrahedra, whose sides are the springs, beside sheet.json and the script."""
    assert of.tetrahedra is not None
    lines = ["# vtk DataFile Version 2.0", "sheet", "ASCII", "DATASET UNSTRUCTURED_GRID"]
    lines += [f"POINTS {len(of.mesh.vertices)} double", *map(_numbers, of.mesh.vertices)]
    lines += [f"CELLS {len(of.tetrahedra)} {of.tetrahedra.size + len(of.tetrahedra)}"]
    lines += [f"4 {_numbers(cell)}" for cell in of.tetrahedra]
    lines += [f"CELL_TYPES {len(of.tetrahedra)}", *["10"] * len(of.tetrahedra)]
    return {"sheet.vtk": "\n".join(lines) + "\n", **python_files("pybullet", of)}


def genesis(of: Problem) -> dict[str, str]:
    """OBJ, sheet.json and the script."""
    return {OBJ: obj(of.mesh), **python_files("genesis", of)}


def sofa(of: Problem) -> dict[str, str]:
    """A scene in plain XML, components named as from v24.06 on."""
    mesh, keys = of.mesh, of.keys
    root = ElementTree.Element("Node", name="root", dt="0.01", gravity=_numbers(mesh.gravity))
    names: tuple[str, ...] = (
        "Constraint.Projective",
        "LinearSolver.Direct",
        "Mass",
        "MechanicalLoad",
        "ODESolver.Backward",
    )
    names += ("SolidMechanics.FEM.Elastic", "SolidMechanics.Spring", "StateContainer")
    for name in (*names, "Topology.Container.Dynamic"):
        ElementTree.SubElement(root, "RequiredPlugin", name=f"Sofa.Component.{name}")
    ElementTree.SubElement(root, "DefaultAnimationLoop")
    node = ElementTree.SubElement(root, "Node", name="sheet")
    components: list[tuple[str, dict[str, str]]] = [
        ("EulerImplicitSolver", {name: f"{keys.get(name, usual):.12g}" for name, usual in RAYLEIGH.items()}),
        ("SparseLDLSolver", {"template": "CompressedRowSparseMatrixMat3x3"}),
        (
            "TriangleSetTopologyContainer",
            {"position": _numbers(mesh.vertices), "triangles": _numbers(mesh.triangles)},
        ),
        ("TriangleSetGeometryAlgorithms", {"template": "Vec3d"}),
        ("MechanicalObject", {"template": "Vec3d"}),
        ("DiagonalMass", {"template": "Vec3d,Vec3d", "vertexMass": _numbers(mesh.masses)}),
        (
            "TriangularFEMForceField",
            {
                "template": "Vec3d",
                "method": "large",
                **{name: repr(keys[name]) for name in ("youngModulus", "poissonRatio")},
            },
        ),
        (
            "FastTriangularBendingSprings",
            {"template": "Vec3d", "bendingStiffness": repr(keys["bendingStiffness"])},
        ),
        ("FixedProjectiveConstraint", {"indices": _numbers(np.flatnonzero(mesh.held))}),
    ]
    loaded = np.flatnonzero(mesh.forces.any(axis=1))
    if len(loaded):
        components.append(
            ("ConstantForceField", {"indices": _numbers(loaded), "forces": _numbers(mesh.forces[loaded])})
        )
    for name, data in components:
        ElementTree.SubElement(node, name, data)
    ElementTree.indent(root)
    return {"sofa.scn": '<?xml version="1.0"?>\n' + ElementTree.tostring(root, encoding="unicode") + "\n"}


def arcsim(of: Problem) -> dict[str, str]:
    """Material, mesh and configuration."""
    keys = of.keys
    stretching = [keys[f"stretching {n}"] for n in (1, 2, 3, 4)]
    material = {"density": keys["density"], "stretching": [stretching] * 6}
    material |= {"bending": [[keys["bending"]] * 5] * 3}
    configuration = {
        "frame_time": 0.04,
        "frame_steps": 8,
        "end_time": 5,
        "cloths": [
            {"mesh": OBJ, "materials": [{"data": "material.json", "damping": keys.get("damping", 1e-3)}]}
        ],
        "handles": [{"nodes": np.flatnonzero(of.mesh.held).tolist()}],
        "gravity": of.mesh.gravity.tolist(),
        "disable": ["strainlimiting", "remeshing", "plasticity", "proximity", "collision"],
    }
    return {
        "material.json": _json(material),
        "arcsim.json": _json(configuration),
        OBJ: obj(of.mesh, material=True),
    }


def c_ipc(of: Problem) -> dict[str, str]:
    """OBJ and a script for Projects/FEMShell. What is held is named by boxes, in shares of the mesh."""
    mesh, keys = of.mesh, of.keys
    low, size = mesh.vertices.min(axis=0)[:2], np.ptp(mesh.vertices, axis=0)[:2]
    held, boxes = (mesh.vertices[:, :2] - low) / size, []
    for axis in (0, 1):
        for line in np.unique(held[:, axis]):
            if mesh.held[held[:, axis] == line].all():
                lower, upper = [-0.1, -0.1, -0.1], [1.1, 1.1, 1.1]
                lower[axis], upper[axis] = float(line) - 1e-5, float(line) + 1e-5
                boxes.append((lower, upper))
    rows = "\n".join(
        f"sim.set_DBC(Vector3d{tuple(a)}, Vector3d{tuple(b)}, "
        "Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(1, 0, 0), 0)"
        for a, b in boxes
    )
    text = f"""\
# Put this and {OBJ} into Projects/FEMShell of Codim-IPC. Fixed rows by boxes, in shares of the mesh.
import sys
sys.path.insert(0, "../../Python")
import Drivers
from JGSL import *

sim = Drivers.FEMDiscreteShellBase("double", 3)
sim.add_shell_3D("{OBJ}", Vector3d(0, 0, 0), Vector3d(0, 0, 0), Vector3d(0, 0, 0), 0)
{rows}
sim.gravity = Vector3d({", ".join(map(repr, mesh.gravity.tolist()))})
sim.dt = sim.frame_dt = 0.01
sim.frame_num = 500
sim.withCollision = False
# density, E, nu, thickness, case
sim.initialize({keys["density"]!r}, {keys["E"]!r}, {keys["nu"]!r}, {keys["thickness"]!r}, 0)
sim.bendingStiffMult = {keys["bendingStiffMult"]!r}
sim.kappa_s = Vector2d(0, 0)  # no strain limit
sim.run()
"""
    return {"c_ipc_sheet.py": text, OBJ: obj(mesh)}


def ppf(of: Problem) -> dict[str, str]:
    """sheet.json and a script for its frontend."""
    chosen = "".join(f'obj.param.set("{name}", {value!r})\n' for name, value in of.keys.items())
    text = f"""\
# Runs in ppf-contact-solver's folder.
import json

import numpy as np
from frontend import App

sheet = json.load(open("{JSON}"))
app = App.create("sheet")
app.asset.add.tri("sheet", np.array(sheet["vertices"]), np.array(sheet["triangles"]))
scene = app.scene.create()
obj = scene.add("sheet")
obj.pin(np.flatnonzero(sheet["held"]).tolist())
obj.param.set("model", "arap")
{chosen}session = app.session.create(scene.build())
session.param.set("dt", 0.01).set("frames", 300).set("gravity", sheet["gravity"])
session.build().start(blocking=True)
"""
    return {"ppf_sheet.py": text, JSON: _json({**of.mesh.document(), "parameters": dict(of.keys)})}


def openusd(of: Problem) -> dict[str, str]:
    """A stage in text: the mesh as a surface deformable, and its material."""
    mesh = of.mesh
    points = ", ".join(f"({x!r}, {y!r}, {z!r})" for x, y, z in mesh.vertices.tolist())
    numbers = ", ".join(map(str, mesh.triangles.ravel().tolist()))
    length = float(np.linalg.norm(mesh.gravity))
    way = (mesh.gravity / length if length else mesh.gravity).tolist()
    thickness = of.keys["thickness"]
    material = "\n".join(
        f"    float {name if ':' in name else f'physics:{name}'} = {value!r}"
        for name, value in of.keys.items()
        if name != "thickness"
    )
    text = f"""\
#usda 1.0
(
    metersPerUnit = 1
    kilogramsPerUnit = 1
    upAxis = "Z"
)
def PhysicsScene "scene"
{{
    vector3f physics:gravityDirection = ({way[0]!r}, {way[1]!r}, {way[2]!r})
    float physics:gravityMagnitude = {length!r}
}}
def Material "rubber" (
    prepend apiSchemas = ["PhysicsSurfaceDeformableMaterialAPI"]
)
{{
{material}
}}
def Mesh "sheet" (
    prepend apiSchemas = ["PhysicsDeformableBodyAPI", "PhysicsSurfaceDeformableSimAPI", "MaterialBindingAPI"]
    customData = {{
        int[] held = {np.flatnonzero(mesh.held).tolist()}
    }}
)
{{
    point3f[] points = [{points}]
    int[] faceVertexCounts = [{", ".join(["3"] * len(mesh.triangles))}]
    int[] faceVertexIndices = [{numbers}]
    float[] physics:thicknesses = [{thickness!r}]
    uniform token physics:thicknesses:elementType = "constant"
    rel material:binding:physics = </rubber>
}}
"""
    return {"sheet.usda": text}


OWN_MASSES = ("newton", "mujoco", "genesis", "sofa")  # those whose files give each vertex a mass of its own
WRITERS: Mapping[str, Callable[[Problem], dict[str, str]]] = {
    "newton": lambda of: python_files("newton", of),
    "mujoco": mujoco,
    "pybullet": pybullet,
    "genesis": genesis,
    "sofa": sofa,
    "arcsim": arcsim,
    "c-ipc": c_ipc,
    "ppf": ppf,
    "openusd": openusd,
}
