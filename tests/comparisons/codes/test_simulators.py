"""Files for other codes, read back: mesh, masses, holds, loads; MuJoCo's forces are ours, SOFA's springs."""

import json
import runpy
from xml.etree import ElementTree

import meshio
import numpy as np
import pytest
from commands import run
from contact_cases import laid_strip
from exported import HINGED
from exported import READERS as SCRIPTS

import lumped
from comparisons.codes.cell import HINGES, _hinge, _triangle
from comparisons.codes.cell_moduli import undamped
from comparisons.codes.coefficients import moduli_of
from comparisons.codes.files import OWN_MASSES, WRITERS, _geom, to_sofa
from comparisons.codes.lattice import READERS
from comparisons.codes.setup import setup
from comparisons.codes.sheet_mesh import sheet_mesh
from comparisons.scoring.reference import references
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import Box, EdgeLoad, Plane, PointLoad, Pressure, Sphere, Symmetric

SCENE = scenes.load("two-edges-clamped").replace(
    loads=(PointLoad(at=(0.188, 0.188), force=(0.01, 0.0, 0.05)),)
)


def written(code, folder):
    made = setup(SCENE, code, 4, best=False)
    for name, write in made.files().items():
        write(folder / name)
    return made


def stiffness(mesh, law):
    """Of all triangles and hinges, by the elements of `comparisons.codes.cell`; energies of bending are
    quadratic in places, and so see displacements in the plane as they see those out of it."""
    total, parts = np.zeros(2 * [mesh.vertices.size]), []
    for corners in mesh.triangles:
        unit = _triangle(mesh.vertices[corners])
        parts.append((corners, law["lambda_h"] * unit["lambda_h"] + law["mu_h"] * unit["mu_h"]))
    for corners in mesh.hinges:
        bent = _hinge(mesh.vertices[corners], HINGES["height"])[2::3, 2::3]
        parts.append((corners, law["hinge"] * np.kron(bent, np.eye(3))))
    for corners, part in parts:
        rows = (3 * corners[:, None] + np.arange(3)).ravel()
        total[np.ix_(rows, rows)] += part
    return total


def mujocos(folder):
    """MJCF read back: masses, which are held, gravity, forces."""
    root = ElementTree.parse(folder / "mujoco.xml").getroot()
    bodies = root.findall("worldbody/body")
    inertias = [body.find("inertial") for body in bodies]
    held = [one is None for one in inertias]
    masses = [0.0 if one is None else float(one.attrib["mass"]) for one in inertias]
    force = np.zeros((len(bodies), 3))
    values = root.find("keyframe/key").attrib["ctrl"].split()
    for motor, value in zip(root.findall("actuator/motor"), values, strict=True):
        joint = motor.attrib["joint"]
        force[int(joint[4:-1]), "xyz".index(joint[-1])] = float(value)
    gravity = [float(g) for g in root.find("option").attrib["gravity"].split()]
    places = [[float(x) for x in body.attrib["pos"].split()] for body in bodies]
    return places, masses, held, gravity, force


def of_json(folder):
    """sheet.json, which the scripts read."""
    read = json.loads((folder / "sheet.json").read_text())
    return [read[name] for name in ("vertices", "masses", "held", "gravity", "forces")]


@pytest.mark.usefixtures("coarse_limits")
@pytest.mark.parametrize(
    ("code", "read"),
    [("mujoco", mujocos), *((code, of_json) for code in WRITERS)],
    ids=lambda one: getattr(one, "__name__", one),
)
def test_files_read_back_hold_masses_gravity_held_vertices_and_loads(code, read, tmp_path):
    made = written(code, tmp_path)
    mesh = made.problem.mesh
    places, masses, held, gravity, forces = read(tmp_path)
    free = ~mesh.held
    assert np.array(places).tolist() == mesh.vertices.tolist() and list(held) == mesh.held.tolist()
    assert np.array(masses)[free].tolist() == mesh.masses[free].tolist()
    assert list(gravity) == [0.0, 0.0, -9.81]
    assert np.array(forces)[free].tolist() == mesh.forces[free].tolist()
    assert np.sum(np.array(masses)[free]) == pytest.approx(1678.0 * 0.003 * 0.188**2 * (7 / 8) ** 2, rel=1e-9)
    assert np.sum(np.array(forces)[free], axis=0) == pytest.approx([0.01, 0.0, 0.05])
    assert all(sum(shares) == pytest.approx(1.0) for _, shares in mesh.probes.values())
    if code == "genesis":
        sheet = meshio.read(tmp_path / "sheet.obj")
        assert sheet.points.tolist() == mesh.vertices.tolist()
        assert sheet.cells_dict["triangle"].tolist() == mesh.triangles.tolist()
    if code in WRITERS:  # with the membrane's C11, which bounds the script's steps, and hinges on a clamp
        kept = json.loads((tmp_path / "sheet.json").read_text())
        assert kept["parameters"] == {key.name: key.value for key in made.keys}
        assert kept["stretching"] == pytest.approx(54.5e6 * 0.003 / (1.0 - 0.48**2))
        assert kept["hinges"] == mesh.hinges.tolist() and kept["clamp"] == 1.0
        (script,) = tmp_path.glob("run_*.py")
        assert script.name == f"run_{code}.py" and "sheet.json" in script.read_text()


def test_mujocos_forces_are_our_energys_on_the_same_mesh(tmp_path):
    """In its plane and out of it, at displacements so small that its laws are linear."""
    mujoco = pytest.importorskip("mujoco")
    made = written("mujoco", tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "mujoco.xml"))
    data, mesh = mujoco.MjData(model), made.problem.mesh
    total = stiffness(mesh, made.coefficients)
    free = np.flatnonzero(~mesh.held)
    for axes in ([0, 1], [2]):
        u = np.zeros_like(mesh.vertices)
        u[np.ix_(free, axes)] = 1e-8 * np.random.default_rng(1).standard_normal((len(free), len(axes)))
        data.qpos[:] = u[free].ravel()
        mujoco.mj_forward(model, data)
        force = -(total @ u.ravel()).reshape(-1, 3)[free]
        assert data.qfrc_spring.reshape(-1, 3)[:, axes] == pytest.approx(
            force[:, axes], rel=1e-4, abs=1e-4 * np.abs(force).max()
        )


@pytest.mark.usefixtures("coarse_limits")
def test_mujocos_script_steps_until_forces_balance(tmp_path, monkeypatch, capsys):
    mujoco = pytest.importorskip("mujoco")
    mesh, states, step = written("mujoco", tmp_path).problem.mesh, [], mujoco.mj_step
    monkeypatch.setattr(mujoco, "mj_step", lambda model, data: states.append(data) or step(model, data))
    runpy.run_path(str(tmp_path / "run_mujoco.py"))["main"]()
    said = json.loads(capsys.readouterr().out)
    assert said["status"] == "converged" and said["iterations"] == len(states)
    assert np.abs(states[-1].qacc).max() < 1e-7 * 0.188 / 2e-3**2  # what one more step would move
    moved = states[-1].flexvert_xpos - mesh.vertices
    for name, (vertices, shares) in mesh.probes.items():
        assert said["probes"][name] == pytest.approx(np.array(shares) @ moved[vertices])


@pytest.mark.usefixtures("coarse_limits")
def test_two_layers_of_equal_springs_bend_as_a_sheet_of_a_third(tmp_path):
    """Springs along sides and both diagonals of squares, in turn: Cauchy's D12 = D66 = D11/3."""
    made = setup(SCENE, "pybullet", 4, best=False)
    found = moduli_of(made.cell, {"k": made.coefficients["k"]})
    expected = found.bending[0, 0] * np.array([[1, 1 / 3, 0], [1 / 3, 1, 0], [0, 0, 1 / 3]])
    assert found.bending == pytest.approx(expected, rel=1e-9, abs=1e-12)
    written("pybullet", tmp_path)
    read = meshio.read(tmp_path / "sheet.vtk")
    assert read.points.tolist() == made.problem.mesh.vertices.tolist()
    assert read.cells_dict["tetra"].tolist() == made.problem.tetrahedra.tolist()


@pytest.mark.sweep(2)
@pytest.mark.usefixtures("coarse_limits")
@pytest.mark.parametrize("code", WRITERS)
def test_a_payload_is_in_the_masses_of_codes_that_have_them(code):
    scene = SCENE.replace(masses=({"at": (0.11, 0.1), "mass": 0.02},))
    bare, laden = (setup(one, code, 4, best=False) for one in (SCENE, scene))
    if code not in OWN_MASSES:
        assert not laden.files() and ", the numbers alone: mass: " in " ".join(laden.notes())
        return
    more = laden.problem.mesh.masses - bare.problem.mesh.masses
    assert more.sum() == pytest.approx(0.02)
    assert more @ laden.problem.mesh.vertices[:, :2] / 0.02 == pytest.approx([0.11, 0.1])
    assert laden.files()


def test_a_force_along_an_edge_is_shared_by_its_vertices():
    """Trapezoidal: ends have half. Rows beyond a clamp have none."""
    load = EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, 2.0))
    mesh = sheet_mesh(scenes.load("one-edge-clamped").replace(loads=(load,)), 4)
    assert mesh.forces[mesh.vertices[:, 0] < 0.187].sum() == 0.0
    share = 2.0 * 0.188 / 4
    assert mesh.forces[:, 2][mesh.vertices[:, 0] > 0.187].tolist() == pytest.approx(
        [share / 2, share, share, share, share / 2]
    )
    turning = EdgeLoad(edge="x1", moment_per_length=1.0)
    with pytest.raises(BadInput, match="along edges only"):
        sheet_mesh(scenes.load("one-edge-clamped").replace(loads=(turning,)), 4)


def test_the_verb_writes_a_scene_and_says_where_its_numbers_are_from(kept):
    found = kept("calibrate code")
    said = found.answer.report().to_markdown()
    assert "particle_vbd_kernels.py" in said and "least error in this scene" in said
    assert (found.folder / "run_newton.py").exists()
    assert json.loads((found.folder / "sheet.json").read_text())["clamp"] == 2.0
    assert found.document["parameters"][1]["unit"] == "N/m" and found.document["limit_error"] < 0.05


def test_what_a_code_does_not_have_is_said():
    curved = setup(scenes.load("curved-edge"), "newton", 4, best=False)
    assert not curved.files() and curved.notes()[0].startswith("No files")
    box = Box(position=(0.0, 0.0, -1.0), size=(1.0, 1.0, 1.0), radius=0.1)
    assert (
        "obstacle: files have no box"
        in setup(SCENE.replace(obstacles=(box,)), "newton", 4, best=False).notes()[0]
    )


@pytest.mark.usefixtures("coarse_limits")
@pytest.mark.parametrize(("squares", "grid"), [(8, 28), (40, None)])
def test_layers_too_shallow_for_the_load_are_told_with_the_mesh_that_bears_it(squares, grid):
    """Two layers of springs in a thin sheet: with 8 squares shear turns over 39 % of those between them."""
    notes = setup(references("statics")["thin"].scene, "pybullet", squares, best=False).notes()
    assert [f"--grid {grid}." in note for note in notes if "too coarse" in note] == [True] * bool(grid)


@pytest.mark.usefixtures("coarse_limits")
@pytest.mark.parametrize("code", WRITERS)
def test_dampers_stand_in_the_files_or_are_said_to_be_left_out(code):
    made = setup(SCENE.replace(material=SCENE.material.replace(damping_time=0.01)), code, 4, best=False)
    keys = {key.name: key.value for key in made.keys}
    times = {"damping": 0.01}
    if code == "pybullet":
        times = {"springDampingStiffness": 0.01 * keys["springElasticStiffness"]}
    known = keys.keys() & times.keys()
    assert known or any("The scene's damping is left out" in note for note in made.notes())
    assert not undamped(made.code, SCENE.material)
    texts = "".join(write.keywords["text"] for write in made.files().values())
    for name in known:
        assert keys[name] == pytest.approx(times[name])
        assert name in texts and f"{times[name]:.6g}"[:5] in texts


@pytest.mark.usefixtures("coarse_limits")
@pytest.mark.parametrize("code", ["mujoco", "newton"])
def test_obstacles_are_written(code, tmp_path):
    scene = laid_strip(
        0.1,
        obstacles=(Plane(position=(0, 0, -0.2), normal=(1, 0, 3)), Sphere(position=(1, 0, -0.3), radius=0.1)),
    )
    for name, write in setup(scene, code, 2, best=False).files().items():
        write(tmp_path / name)
    sheet = json.loads((tmp_path / "sheet.json").read_text())
    assert [one["kind"] for one in sheet["obstacles"]] == ["plane", "sphere"]
    assert sheet["offset"] == 0.0025
    if code == "mujoco":
        mujoco = pytest.importorskip("mujoco")
        model = mujoco.MjModel.from_xml_path(str(tmp_path / "mujoco.xml"))
        assert model.ngeom == 2
        assert not model.opt.disableflags & mujoco.mjtDisableBit.mjDSBL_CONTACT


def test_mujocos_cylinder_is_long_and_friction_has_tangents():
    """Its size is radius and half length; condim 3 is a normal and two tangents, 1 a normal alone."""
    rod = {"kind": "cylinder", "position": [0.0] * 3, "axis": [0.0, 1.0, 0.0], "radius": 0.01}
    assert 'size="0.01 0.5"' in _geom({**rod, "friction": 0.3})
    assert ['condim="3"' in _geom({**rod, "friction": mu}) for mu in (0.3, 0.0)] == [True, False]


# ---- lattices
CORNER = scenes.load("two-edges-clamped").replace(
    loads=(PointLoad(at=(0.188, 0.188), force=(0.05, 0.0, 0.1)),), gravity=None
)


def described(scene, grid=4, method="central"):
    return lumped.describe(scene, lumped.calibrate(scene.sheet, scene.material, grid=grid, method=method))


def test_sofas_scene_holds_the_lattice():
    """Of a bent edge, a mirror plane, weight, dampers and a force: read back it is what our answer is of."""
    scene = scenes.load("curved-edge").replace(loads=CORNER.loads)
    scene = scene.replace(supports=(*scene.supports, Symmetric(edge="y0")))
    scene = scene.replace(material=scene.material.replace(damping_time=2e-3, damping_rate=3.0))
    lattice = described(scene, 3)
    root = ElementTree.fromstring(to_sofa(lattice, scene))
    data = {child.tag: child.attrib for child in root.find("Node")}
    order = [*data]
    assert {child.tag for child in root} == {"RequiredPlugin", "DefaultAnimationLoop", "Node"}
    assert len(data) == len(root.find("Node"))
    assert order.index("MechanicalObject") < order.index("SpringForceField")

    def numbers(tag, name, width, kind=float):
        return np.array(data[tag][name].split(), dtype=kind).reshape(-1, width)

    rest, start = (numbers("MechanicalObject", name, 3) for name in ("rest_position", "position"))
    assert rest.tolist() == lattice.positions.tolist()
    links, springs = lattice.links, numbers("SpringForceField", "spring", 5)
    columns = (*links.masses.T, links.stiffness, links.damping, links.rest_length)
    assert springs.tolist() == np.column_stack(columns).tolist() and links.damping.all()
    partly = data["PartialFixedProjectiveConstraint"]["fixedDirections"].split()
    held = [
        (mass, axis)
        for kind, axes in (("", "111"), ("Partial", partly))
        for mass in numbers(f"{kind}FixedProjectiveConstraint", "indices", 1, int).ravel()
        for axis in range(3)
        if axes[axis] == "1"
    ]
    moved = {(hold.masses[0], hold.axis): hold.displacement for hold in lattice.holds}
    assert sorted(held) == sorted(moved) and any(moved.values())
    assert [(start - rest)[key] for key in moved] == pytest.approx(list(moved.values()))
    mass = numbers("DiagonalMass", "vertexMass", 1)
    load = mass * np.array(root.attrib["gravity"].split(), dtype=float)
    forced = numbers("ConstantForceField", "indices", 1, int).ravel()
    load[forced] += numbers("ConstantForceField", "forces", 3)
    assert mass.ravel().tolist() == lattice.mass.tolist()
    assert load == pytest.approx(lattice.dead, abs=1e-12 * np.abs(lattice.dead).max())
    assert float(data["EulerImplicitSolver"]["rayleighMass"]) == 3.0


def test_sofa_refuses_features_that_it_lacks():
    with pytest.raises(BadInput, match="area and strain springs of cells; take --calibration central"):
        to_sofa(described(CORNER, method="consistent"), CORNER)
    with pytest.raises(BadInput, match="hold the mean of their layers"):
        to_sofa(described(HINGED, 3), HINGED)
    blown = CORNER.replace(loads=(Pressure(value=4.0),))
    with pytest.raises(BadInput, match="follow the sheet; dead loads only"):
        to_sofa(described(blown, 3), blown)


@pytest.mark.parametrize("code", ["sofa", *READERS])
def test_the_verb_writes_the_lattice_for_a_code(code, tmp_path):
    """Beside the tables; SOFA has central springs."""
    arguments = ("two-edges-clamped", "--grid", "3", "--for", code, "--out", str(tmp_path))
    assert run("calibrate", *arguments, "--quiet") == 0
    own = {"sofa": "sofa.scn", **READERS}[code]
    assert {own, "links.csv", "lattice.npz", "calibration.json"} <= {path.name for path in tmp_path.iterdir()}
    assert f"`{own}`" in (tmp_path / "README.md").read_text(encoding="utf-8")
    if code in READERS:
        assert (tmp_path / own).read_text(encoding="utf-8") == (SCRIPTS / own).read_text(encoding="utf-8")
