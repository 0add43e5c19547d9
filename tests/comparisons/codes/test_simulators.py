"""Files for named simulators: SOFA's scene holds our lattice; readers in NumPy, C++, MATLAB."""

from xml.etree import ElementTree

import numpy as np
import pytest
from commands import run
from exported import HINGED
from exported import READERS as SCRIPTS

import lumped
from comparisons.codes.files import to_sofa
from comparisons.codes.lattice import CODES, READERS
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import PointLoad, Pressure, Symmetric

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


def test_what_they_do_not_have_is_refused():
    with pytest.raises(BadInput, match="area and strain springs of cells; take --calibration central"):
        to_sofa(described(CORNER, method="consistent"), CORNER)
    with pytest.raises(BadInput, match="hold the mean of their layers"):
        to_sofa(described(HINGED, 3), HINGED)
    blown = CORNER.replace(loads=(Pressure(value=4.0),))
    with pytest.raises(BadInput, match="follow the sheet; dead loads only"):
        to_sofa(described(blown, 3), blown)


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
