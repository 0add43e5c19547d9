"""Files for other codes, read back: each code's own law of its numbers is our energy of the same mesh."""

from __future__ import annotations

import json
import re
from xml.etree import ElementTree

import numpy as np
import pytest
from commands import run

from comparisons.codes.cell import HINGES, _hinge, _triangle
from comparisons.codes.files import OWN_MASSES, WRITERS
from comparisons.codes.homogenise import moduli_of
from comparisons.codes.setup import setup
from comparisons.codes.sheet_mesh import sheet_mesh
from comparisons.scoring.reference import references
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeLoad, PointLoad

SCENE = scenes.load("two-edges-clamped").replace(
    loads=(PointLoad(at=(0.188, 0.188), force=(0.01, 0.0, 0.05)),)
)
Law = tuple[float, float, float]  # λ h, μ h, and k of ½ k 3 L²/(A₁ + A₂) θ², as `homogenise --hinge height`


def written(code, folder):
    made = setup(SCENE, code, 4, best=False)
    for name, write in made.files().items():
        write(folder / name)
    return made


def read_obj(path):
    lines = [line.split() for line in path.read_text().splitlines()]
    places = np.array([line[1:] for line in lines if line[0] == "v"], dtype=float)
    faces = [[int(corner.split("/")[0]) - 1 for corner in line[1:]] for line in lines if line[0] == "f"]
    return places, np.array(faces)


def plane(young, nu):
    return young * nu / (1 - nu**2), young / 2 / (1 + nu)


def solid(young, nu):
    return young * nu / (1 + nu) / (1 - 2 * nu), young / 2 / (1 + nu)


def sofa(folder):
    """E/(1 − ν²) times area; λ = ⅔ (ha + hb)/(ha hb)² L k of a vector that is ha hb/(ha + hb) θ long."""
    root = ElementTree.parse(folder / "sofa.scn").getroot()
    parts = {one.tag: one.attrib for one in root.iter()}
    topology, bending = parts["TriangleSetTopologyContainer"], parts["FastTriangularBendingSprings"]
    places = np.array(topology["position"].split(), dtype=float).reshape(-1, 3)
    triangles = np.array(topology["triangles"].split(), dtype=int).reshape(-1, 3)
    young, nu = (float(parts["TriangularFEMForceField"][key]) for key in ("youngModulus", "poissonRatio"))
    return places, triangles, (*plane(young, nu), float(bending["bendingStiffness"]) / 9)


def arcsim(folder):
    """Its samples are doubled, shear acts as 2 k₃ G₁₂ twice; ke L²/(2 A) θ²/4."""
    material = json.loads((folder / "material.json").read_text())
    k0, k1, _, k3 = 2 * np.array(material["stretching"][0])
    assert k0 == pytest.approx(k1 + k3)  # isotropic: λ + 2μ, with k3 G₁₂² twice ½ 2μ G₁₂²
    return *read_obj(folder / "sheet.obj"), (k1, k3 / 2, material["bending"][0][0] / 12)


def c_ipc(folder):
    text = (folder / "c_ipc_sheet.py").read_text()
    _, young, nu, h, _ = map(float, re.search(r"initialize\((.*)\)", text)[1].split(","))
    bent = float(re.search(r"bendingStiffMult = (.*)", text)[1]) * young * h**3 / 24 / (1 - nu**2)
    lame, mu = plane(young, nu)
    return *read_obj(folder / "sheet.obj"), (h * lame, h * mu, 2 * bent)


def ppf(folder):
    sheet = json.loads((folder / "sheet.json").read_text())
    text = (folder / "ppf_sheet.py").read_text()
    own = dict(re.findall(r'obj\.param\.set\("([\w-]+)", ([\d.e+-]+)\)', text))
    density, young, nu, bend = (float(own[key]) for key in ("density", "young-mod", "poiss-rat", "bend"))
    lame, mu = solid(young, nu)
    law = density * lame, density * mu, 1.28e-5 * bend * density / 3
    return np.array(sheet["vertices"]), np.array(sheet["triangles"]), law


READERS = {"sofa": sofa, "arcsim": arcsim, "c-ipc": c_ipc, "ppf": ppf}


def stiffness(places, triangles, hinges, law, ways=1):
    """Of all triangles and hinges, by the elements of `comparisons.cells`. ways: 3 of bending energies that
    are quadratic in places, and so see displacements in the plane as they see those out of it."""
    total = np.zeros((3 * len(places), 3 * len(places)))
    for corners in triangles.tolist():
        unit = _triangle(places[corners])
        _add(total, corners, law[0] * unit["lambda_h"] + law[1] * unit["mu_h"])
    for corners in hinges.tolist():
        bent = _hinge(places[corners], HINGES["height"])
        _add(total, corners, law[2] * (np.kron(bent[2::3, 2::3], np.eye(3)) if ways == 3 else bent))
    return total


def _add(total, corners, part):
    rows = np.concatenate([3 * corner + np.arange(3) for corner in corners])
    total[np.ix_(rows, rows)] += part


@pytest.mark.parametrize("code", READERS)
def test_files_read_back_hold_our_energy_of_the_same_mesh(code, tmp_path):
    made = written(code, tmp_path)
    places, triangles, law = READERS[code](tmp_path)
    ours = [made.coefficients[name] for name in ("lambda_h", "mu_h", "hinge")]
    expected = stiffness(made.mesh.vertices, made.mesh.triangles, made.mesh.hinges, ours)
    found = stiffness(places, triangles, made.mesh.hinges, law)
    assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("code", ["sofa", "arcsim", "c-ipc", "ppf"])
def test_files_read_back_hold_the_clamped_rows(code, tmp_path):
    made = written(code, tmp_path)
    if code == "sofa":
        root = ElementTree.parse(tmp_path / "sofa.scn").getroot()
        held = next(root.iter("FixedProjectiveConstraint")).attrib["indices"].split()
    elif code == "arcsim":
        held = json.loads((tmp_path / "arcsim.json").read_text())["handles"][0]["nodes"]
    elif code == "ppf":
        held = np.flatnonzero(json.loads((tmp_path / "sheet.json").read_text())["held"])
    else:  # by boxes, in shares of the mesh
        places = made.mesh.vertices
        shares = (places - places.min(axis=0)) / np.maximum(np.ptp(places, axis=0), 1e-9)
        inside = np.zeros(len(places), dtype=bool)
        for line in (tmp_path / "c_ipc_sheet.py").read_text().splitlines():
            if "set_DBC" in line:
                low, high = (json.loads(f"[{one}]") for one in re.findall(r"Vector3d\(([^)]*)\)", line)[:2])
                inside |= ((low <= shares) & (shares <= high)).all(axis=1)
        held = np.flatnonzero(inside)
    assert np.array(held, dtype=int).tolist() == np.flatnonzero(made.mesh.held).tolist()


def test_mujocos_forces_are_our_energys_on_the_same_mesh(tmp_path):
    """In its plane and out of it, at displacements so small that its laws are linear."""
    mujoco = pytest.importorskip("mujoco")
    made = written("mujoco", tmp_path)
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "mujoco.xml"))
    data, mesh = mujoco.MjData(model), made.mesh
    ours = [made.coefficients[name] for name in ("lambda_h", "mu_h", "hinge")]
    total = stiffness(mesh.vertices, mesh.triangles, mesh.hinges, ours, 3)
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


def numbers(text, before):
    """Those in the brackets after some words of a stage."""
    return [
        float(one)
        for one in re.findall(r"-?[\d.]+(?:e[-+]?\d+)?", text.split(f"{before} = [")[1].split("]")[0])
    ]


def test_openusd_has_the_mesh_and_the_sheets_own_stiffnesses(tmp_path):
    """It has no law of a mesh: a program makes one of the sheet's numbers."""
    mesh = written("openusd", tmp_path).mesh
    text = (tmp_path / "sheet.usda").read_text()
    assert numbers(text, "points") == mesh.vertices.ravel().tolist()
    assert numbers(text, "faceVertexIndices") == mesh.triangles.ravel().tolist()
    assert numbers(text, "held") == np.flatnonzero(mesh.held).tolist()
    own = {name: float(value) for name, value in re.findall(r"float physics:(\w+) = ([\d.e+-]+)", text)}
    young, nu, h = 54.5e6, 0.48, 0.003
    assert own["surfaceStretchStiffness"] == pytest.approx(young * h / (1 - nu**2))
    assert own["surfaceBendStiffness"] == pytest.approx(young * h**3 / 12 / (1 - nu**2))
    assert own["surfaceShearStiffness"] == pytest.approx(young * h / 2 / (1 + nu))


def test_two_layers_of_equal_springs_bend_as_a_sheet_of_a_third(tmp_path):
    """Springs along sides and both diagonals of squares, in turn: Cauchy's D12 = D66 = D11/3."""
    made = setup(SCENE, "pybullet", 4, best=False)
    found = moduli_of(made.cell, {"k": made.coefficients["k"]})
    expected = found.bending[0, 0] * np.array([[1, 1 / 3, 0], [1 / 3, 1, 0], [0, 0, 1 / 3]])
    assert found.bending == pytest.approx(expected, rel=1e-9, abs=1e-12)
    written("pybullet", tmp_path)
    lines = (tmp_path / "sheet.vtk").read_text().splitlines()
    assert f"POINTS {len(made.mesh.vertices)} double" in lines


@pytest.mark.parametrize("code", WRITERS)
def test_masses_and_loads_of_every_code_are_the_sheets(code):
    mesh = setup(SCENE, code, 4, best=False).mesh
    free = mesh.masses[~mesh.held].sum()
    assert free == pytest.approx(1678.0 * 0.003 * 0.188**2 * (7 / 8) ** 2, rel=1e-9)
    assert mesh.forces.sum(axis=0) == pytest.approx([0.01, 0.0, 0.05])
    assert all(sum(shares) == pytest.approx(1.0) for _, shares in mesh.probes.values())


@pytest.mark.parametrize("code", WRITERS)
def test_a_payload_is_in_the_masses_of_codes_that_have_them(code):
    scene = SCENE.replace(masses=({"at": (0.11, 0.1), "mass": 0.02},))
    bare, laden = (setup(one, code, 4, best=False) for one in (SCENE, scene))
    if code not in OWN_MASSES:
        assert not laden.files() and "No files: mass: " in " ".join(laden.notes())
        return
    more = laden.mesh.masses - bare.mesh.masses
    assert more.sum() == pytest.approx(0.02)
    assert more @ laden.mesh.vertices[:, :2] / 0.02 == pytest.approx([0.11, 0.1])
    assert laden.files()
    turning = setup(scene.replace(masses=({"at": (0.1, 0.1), "mass": 0.02, "inertia": (1e-6,) * 3},)), code)
    assert "mass.inertia: their vertices are points" in " ".join(turning.notes())


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


def test_the_verb_writes_a_scene_and_says_where_its_numbers_are_from(tmp_path, capsys):
    options = ("--for", "newton", "--grid", "5", "--out", str(tmp_path / "n"))
    assert run("calibrate", "one-edge-clamped", *options) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "particle_vbd_kernels.py" in said and "least error in this scene" in said
    assert (tmp_path / "n" / "run_newton.py").exists()
    document = json.loads((tmp_path / "n" / "code.json").read_text())
    assert document["parameters"][1]["unit"] == "N/m" and document["limit_error"] < 0.05


def test_what_a_code_does_not_have_is_said():
    curved = setup(scenes.load("curved-edge"), "newton", 4, best=False)
    assert not curved.files() and "No files" in " ".join(curved.notes())
    with pytest.raises(BadInput, match="--for"):
        setup(SCENE, "unity")


@pytest.mark.parametrize(("squares", "grid"), [(8, 28), (40, None)])
def test_layers_too_shallow_for_the_load_are_told_with_the_mesh_that_bears_it(squares, grid):
    """Two layers of springs in a thin sheet: with 8 squares shear turns over 39 % of those between them."""
    notes = setup(references("statics")["thin"].scene, "pybullet", squares, best=False).notes()
    assert [f"--grid {grid} or more" in note for note in notes if "too coarse" in note] == [True] * bool(grid)


DAMPED = SCENE.replace(material=SCENE.material.replace(damping_time=0.01))


def test_mujocos_dampers_are_the_time_times_its_stiffness(tmp_path):
    """At velocities so small that both are linear; without damping there is none."""
    mujoco = pytest.importorskip("mujoco")
    forces = []
    for scene in (DAMPED, SCENE):
        text = setup(scene, "mujoco", 4, best=False).files()
        text["mujoco.xml"](tmp_path / "mujoco.xml")
        model = mujoco.MjModel.from_xml_path(str(tmp_path / "mujoco.xml"))
        moving, displaced = mujoco.MjData(model), mujoco.MjData(model)
        moving.qvel[:] = 1e-6 * np.random.default_rng(2).standard_normal(model.nv)
        displaced.qpos[:] = 0.01 * moving.qvel
        for data in (moving, displaced):
            mujoco.mj_forward(model, data)
        forces.append((moving.qfrc_damper.copy(), displaced.qfrc_spring.copy()))
    (damper, spring), (none, _) = forces
    assert damper == pytest.approx(spring, rel=1e-4, abs=1e-4 * np.abs(spring).max())
    assert np.abs(spring).max() > 0.0 and not none.any()


@pytest.mark.parametrize("code", WRITERS)
def test_dampers_stand_in_the_files_or_are_said_to_be_left_out(code):
    made = setup(DAMPED, code, 4, best=False)
    keys = {key.parameter: key.value for key in made.keys}
    times = {"damping": 0.01, "rayleighStiffness": 0.01}
    if code == "pybullet":
        times = {"springDampingStiffness": 0.01 * keys["springElasticStiffness"]}
    known = keys.keys() & times.keys()
    assert known or any("The scene's damping is left out" in note for note in made.notes())
    assert all(keys[name] == pytest.approx(times[name]) for name in known)
    texts = "".join(write.keywords["text"] for write in made.files().values())
    assert all(name in texts and f"{times[name]:.6g}"[:5] in texts for name in known)
