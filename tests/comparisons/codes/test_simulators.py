"""Files for named simulators: MuJoCo finds our forces and our equilibrium, SOFA's scene holds our lattice."""

import runpy
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from cases import CLAMP, GRAVITY, OBLONG, SILICONE
from commands import run
from sheetbench_mujoco import relax

import lumped
from comparisons.codes.arrays import arrays
from comparisons.codes.lattice import CODES, MODELS, READERS
from comparisons.codes.mujoco import to_mjcf
from comparisons.codes.sofa import to_sofa
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import Hinged, PointLoad, Scene

SCRIPTS = Path(__file__).parents[3] / "comparisons" / "codes" / "scripts"
READER = runpy.run_path(str(SCRIPTS / "read_lattice.py"))
CORNER = scenes.load("two-edges-clamped").replace(
    loads=(PointLoad(at=(0.188, 0.188), force=(0.05, 0.0, 0.1)),), gravity=None
)
HINGED = Scene(
    name="hinged", sheet=OBLONG, material=SILICONE, gravity=GRAVITY, support=(CLAMP, Hinged(edge="x1"))
)


def described(scene, grid=4, method="central"):
    return lumped.describe(scene, lumped.calibrate(scene.sheet, scene.material, grid=grid, method=method))


def loaded(mujoco, text):
    """Model and data of an MJCF text, under its loads."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


def put(model, data, displacement, rest):
    """Masses where displacements (n, 3) [m] from their rest (n, 3) [m] say; held ones stand there already."""
    for joint in range(model.njnt):
        mass, axis = int(model.jnt_bodyid[joint]) - 1, int(np.argmax(model.jnt_axis[joint]))
        data.qpos[joint] = rest[mass, axis] + displacement[mass, axis] - model.body_pos[mass + 1][axis]


def displacement(data, rest):
    """Displacements (n, 3) [m] of the masses."""
    moved = data.site_xpos - rest
    return moved


LADEN = scenes.load("two-edges-clamped").replace(name="laden", masses=({"at": (0.17, 0.16), "mass": 0.05},))


@pytest.mark.parametrize(
    "scene",
    [scenes.load("two-edges-clamped"), scenes.load("curved-edge"), CORNER, LADEN],
    ids=lambda s: s.name,
)
def test_mujocos_masses_rest_where_ours_do(scene):
    """Put where we say, no mass accelerates by more than rounding beside what its springs would do to it."""
    mujoco = pytest.importorskip("mujoco")
    lattice = described(scene)
    model, data = loaded(mujoco, to_mjcf(lattice, scene))
    put(model, data, lattice.states[-1].displacement, lattice.positions)
    mujoco.mj_forward(model, data)
    links = lattice.links
    pull = (links.stiffness * links.rest_length).max() / lattice.mass.min()
    assert np.abs(data.qacc).max() < 1e-9 * pull


def test_mujocos_hinged_edge_holds_the_mean_of_its_layers():
    """A constraint there takes 0.9999 of what would break it, so masses along the edge accelerate by 1e-4 of
    what their springs do to them, the others by nothing; brought to rest the mean stays by as much."""
    mujoco = pytest.importorskip("mujoco")
    lattice = described(HINGED, 3)
    model, data = loaded(mujoco, to_mjcf(lattice, HINGED))
    truth = lattice.states[-1].displacement
    put(model, data, truth, lattice.positions)
    mujoco.mj_forward(model, data)
    links = lattice.links
    pull = (links.stiffness * links.rest_length).max() / lattice.mass.min()
    held = [hold for hold in lattice.holds if len(hold.masses) > 1]
    along = np.zeros(truth.shape, dtype=bool)
    for hold in held:
        along[list(hold.masses), hold.axis] = True
    joints = [
        (int(body) - 1, int(axis.argmax()))
        for body, axis in zip(model.jnt_bodyid, model.jnt_axis, strict=True)
    ]
    fast = np.abs(data.qacc) / pull
    assert held and fast[[not along[joint] for joint in joints]].max() < 1e-9
    assert 0.0 < fast.max() < 1e-4
    assert relax(mujoco, model, data, 0.2e-9)[1]
    found = displacement(data, lattice.positions)
    assert np.abs(found - truth).max() < 1e-3 * np.abs(truth).max()
    for hold in held:
        assert abs(found[list(hold.masses), hold.axis].mean()) < 1e-4 * np.abs(truth).max()


def test_mujoco_comes_to_rest_there_by_itself():
    mujoco = pytest.importorskip("mujoco")
    scene = scenes.load("two-edges-clamped")
    lattice = described(scene)
    model, data = loaded(mujoco, to_mjcf(lattice, scene))
    assert relax(mujoco, model, data, 0.188e-9)[1]
    truth = lattice.states[-1].displacement
    assert np.abs(displacement(data, lattice.positions) - truth).max() < 5e-3 * np.abs(truth).max()


def test_sofas_scene_holds_the_lattice():
    """Read back by our NumPy reader, which finds the displacements of ours."""
    for scene in (scenes.load("curved-edge"), CORNER):
        lattice = described(scene, 3)
        root = ElementTree.fromstring(to_sofa(lattice, scene))
        found = lattice_of(root)
        for kind, constants in (
            ("coupling", (0, 3)),
            ("rubber", (0, 8)),
            ("face", (0,)),
        ):  # SOFA has no such springs
            found[f"{kind}_corners"] = np.zeros((0, 4, 1), int)
            found |= {f"{kind}_rest": np.zeros(0), f"{kind}_stiffness": np.zeros(constants)}
        own = arrays(lattice)  # nor obstacles, nor sheets that are not flat at rest
        found |= {name: own[name] for name in own if name.startswith(("contact_", "obstacle_"))}
        found |= {f"{kind}_natural": np.zeros((0, 3)) for kind in ("strain", "coupling")}
        assert not len(found["contact_area"]) and not len(found["strain_rest"])
        u = READER["equilibrium"](found, READER["differences"](found), 1)
        truth = lattice.states[-1].displacement
        assert np.abs(u - truth).max() < 1e-6 * np.abs(truth).max()


def test_sofas_scene_has_what_it_names():
    root = ElementTree.fromstring(to_sofa(described(CORNER, 3), CORNER))
    assert root.tag == "Node" and {child.tag for child in root} == {
        "RequiredPlugin",
        "DefaultAnimationLoop",
        "Node",
    }
    sheet = root.find("Node")
    assert sheet is not None
    order = [child.tag for child in sheet]
    assert order.index("MechanicalObject") < order.index("SpringForceField")
    assert len(set(order)) == len(order)


def test_what_they_do_not_have_is_refused():
    with pytest.raises(BadInput, match="area and strain springs of cells; take --calibration central"):
        to_mjcf(described(CORNER, method="consistent"), CORNER)
    with pytest.raises(BadInput, match="hold the mean of their layers"):
        to_sofa(described(HINGED, 3), HINGED)


@pytest.mark.parametrize("code", CODES)
def test_the_verb_writes_the_lattice_for_a_code(code, tmp_path):
    """Beside the tables; MuJoCo has a sheet of its own unless springs are named, SOFA central ones."""
    springs = ("--calibration", "central") if code == "mujoco" else ()
    arguments = ("two-edges-clamped", "--grid", "3", *springs, "--for", code, "--out", str(tmp_path))
    assert run("calibrate", *arguments, "--quiet") == 0
    own = {**{name: file for name, (file, _) in MODELS.items()}, **READERS}[code]
    assert {own, "links.csv", "lattice.npz", "calibration.json"} <= {path.name for path in tmp_path.iterdir()}
    assert f"`{own}`" in (tmp_path / "README.md").read_text(encoding="utf-8")
    if code in READERS:
        assert (tmp_path / own).read_text(encoding="utf-8") == (SCRIPTS / own).read_text(encoding="utf-8")


def test_simulators_get_masses_gravity_held_ones_and_loads():
    """Read back without the simulator; SOFA's in `test_sofas_scene_holds_the_lattice`."""
    scene = LADEN.replace(loads=CORNER.loads)
    lattice = described(scene, 3)
    root = ElementTree.fromstring(to_mjcf(lattice, scene))
    bodies = root.findall("worldbody/body")
    free = [n for n, body in enumerate(bodies) if body.find("joint") is not None]
    held = {hold.masses[0] for hold in lattice.holds}
    assert set(range(len(bodies))) - set(free) == held
    masses = [
        float(body.find("inertial").attrib["mass"]) for body in bodies if body.find("joint") is not None
    ]
    assert masses == lattice.mass[free].tolist()
    gravity = np.array(root.find("option").attrib["gravity"].split(), float)
    assert gravity.tolist() == [0.0, 0.0, -9.81]
    force = np.zeros_like(lattice.dead)
    values = root.find("keyframe/key").attrib["ctrl"].split()
    for motor, value in zip(root.findall("actuator/motor"), values, strict=True):
        joint = motor.attrib["joint"]
        force[int(joint[4:-1]), "xyz".index(joint[-1])] = float(value)
    expected = lattice.dead - lattice.mass[:, None] * gravity
    expected[sorted(held)] = 0.0
    assert force == pytest.approx(expected, abs=1e-12)


def lattice_of(root):
    """What the scene says, as the reader's arrays."""
    sheet = root.find("Node")
    assert sheet is not None
    data = {child.tag: child.attrib for child in sheet}

    def numbers(tag, name, *shape):
        return np.array(data[tag][name].split(), dtype=float).reshape(*shape)

    rest, start = (numbers("MechanicalObject", name, -1, 3) for name in ("rest_position", "position"))
    springs = numbers("SpringForceField", "spring", -1, 5)
    held = numbers("FixedProjectiveConstraint", "indices", -1).astype(int)
    mass = numbers("DiagonalMass", "vertexMass", -1)
    load = mass[:, None] * np.array(root.attrib["gravity"].split(), dtype=float)
    if "ConstantForceField" in data:
        loaded_at = numbers("ConstantForceField", "indices", -1).astype(int)
        load[loaded_at] += numbers("ConstantForceField", "forces", -1, 3)
    nothing = {"rest": np.empty(0), "corners": np.empty((0, 4, 2), dtype=int)}
    return {
        "positions": rest,
        "link_masses": springs[:, :2].astype(int),
        "link_stiffness": springs[:, 2],
        "link_rest_length": springs[:, 4],
        **{f"{kind}_{name}": value for kind in ("area", "strain") for name, value in nothing.items()},
        "area_stiffness": np.empty(0),
        "strain_stiffness": np.empty((0, 3)),
        "hold_masses": np.repeat(held, 3)[:, None],
        "hold_axis": np.tile(np.arange(3), len(held)),
        "hold_displacement": (start - rest)[held].ravel(),
        "load": load,
    }
