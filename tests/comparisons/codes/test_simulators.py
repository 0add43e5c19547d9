"""Files for named simulators: SOFA's scene holds our lattice; readers in NumPy, C++, MATLAB."""

import runpy
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from cases import CLAMP, GRAVITY, OBLONG, SILICONE
from commands import run

import lumped
from comparisons.codes.files import to_sofa
from comparisons.codes.lattice import CODES, READERS
from comparisons.codes.tables import arrays, tables
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


def test_sofas_scene_holds_the_lattice():
    """Our NumPy reader finds the displacements of ours in it: of a bent edge, weight and a force."""
    scene = scenes.load("curved-edge").replace(loads=CORNER.loads)
    lattice = described(scene, 3)
    found = lattice_of(ElementTree.fromstring(to_sofa(lattice, scene)))
    for kind, constants in (("coupling", (0, 3)), ("rubber", (0, 8)), ("face", (0,))):  # SOFA has none
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


def test_sofas_springs_and_masses_are_damped_as_ours():
    scene = CORNER.replace(material=CORNER.material.replace(damping_time=2e-3, damping_rate=3.0))
    lattice = described(scene, 3)
    sheet = ElementTree.fromstring(to_sofa(lattice, scene)).find("Node")
    springs = np.array(sheet.find("SpringForceField").attrib["spring"].split(), float).reshape(-1, 5)
    assert springs[:, 3].tolist() == lattice.links.damping.tolist() and lattice.links.damping.all()
    assert float(sheet.find("EulerImplicitSolver").attrib["rayleighMass"]) == 3.0
    masses = sheet.find("DiagonalMass").attrib["vertexMass"].split()
    assert list(map(float, masses)) == lattice.mass.tolist()


def test_loads_and_holds_keep_their_signs():
    loads = tables(described(CORNER, 3))["loads.csv"].splitlines()[1:]
    force = sum(np.array(row.split(",")[1:], float) for row in loads)
    assert force == pytest.approx([0.05, 0.0, 0.1])
    bent = described(scenes.load("curved-edge"), 3)
    held = [hold.displacement for hold in bent.holds]
    assert arrays(bent)["hold_displacement"].tolist() == held and any(held)


def test_what_they_do_not_have_is_refused():
    with pytest.raises(BadInput, match="area and strain springs of cells; take --calibration central"):
        to_sofa(described(CORNER, method="consistent"), CORNER)
    with pytest.raises(BadInput, match="hold the mean of their layers"):
        to_sofa(described(HINGED, 3), HINGED)


@pytest.mark.parametrize("code", CODES)
def test_the_verb_writes_the_lattice_for_a_code(code, tmp_path):
    """Beside the tables; SOFA has central springs."""
    arguments = ("two-edges-clamped", "--grid", "3", "--for", code, "--out", str(tmp_path))
    assert run("calibrate", *arguments, "--quiet") == 0
    own = {"sofa": "sofa.scn", **READERS}[code]
    assert {own, "links.csv", "lattice.npz", "calibration.json"} <= {path.name for path in tmp_path.iterdir()}
    assert f"`{own}`" in (tmp_path / "README.md").read_text(encoding="utf-8")
    if code in READERS:
        assert (tmp_path / own).read_text(encoding="utf-8") == (SCRIPTS / own).read_text(encoding="utf-8")


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
