"""What a scene decides where nobody does: the same law and mesh in statics, modes and motion."""

import pytest
from cases import sheet, with_material

import fem_reference
import lumped
from fem_reference.surface.materials import Section, section_of
from sheetbench import scenes

RUBBER = {"law": "neo-hookean", "young": "0.5 MPa", "poisson": 0.45, "density": 1000.0}


def pulled(**material):
    """A strip stretched by more than a half."""
    load = {"kind": "edge", "edge": "x1", "force_per_length": [300.0, 0.0, 0.0]}
    return sheet(0.1, 0.05, 0.002, material=RUBBER | material, loads=[load])


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["shell", "solid"])
def test_statics_modes_and_motion_take_the_rubbers_law(model):
    scene = pulled()
    statics = fem_reference.solve(scene, model, elements=(2, 1))
    modes = fem_reference.modes(scene, model, (2, 1), 2)
    motion = fem_reference.simulate(scene, model, 1e-3, elements=(2, 1))
    assert [found.settings["law"] for found in (statics, modes, motion)] == 3 * ["neo-hookean"]
    chosen = fem_reference.modes(scene, model, (2, 1), 2, law="st-venant-kirchhoff")
    assert chosen.settings["law"] == "st-venant-kirchhoff"
    assert modes.frequencies == pytest.approx(chosen.frequencies, rel=1e-6)  # at rest all laws are alike


def test_modes_about_a_stretched_strip_are_those_of_its_rubber():
    """Those of the linear law, which it had, are 8 % higher."""
    rubber, linear = (
        fem_reference.modes(scene, "shell", 4, 3, about="deformed").frequencies
        for scene in (pulled(), pulled(law=None))
    )
    lattice = lumped.modes(pulled(), count=3, about="deformed").frequencies
    assert lattice == pytest.approx(rubber, rel=5e-3)
    assert linear[0] > 1.05 * rubber[0]


HOLE = {"shape": {"circle": {"centre": [0.05, 0.025], "radius": 0.01}}}


@pytest.mark.parametrize(
    ("last", "cutouts", "graded"), [("clamped", [], False), ("hinged", [], True), ("clamped", [HOLE], True)]
)
def test_meshes_are_graded_where_an_edge_or_a_rim_lets_twist_go(last, cutouts, graded):
    kinds = dict.fromkeys(("x0", "x1", "y0"), "clamped") | {"y1": last}
    held = [{"edge": edge, "kind": kind} for edge, kind in kinds.items()]
    scene = pulled(law=None).replace(supports=held, loads=[], cutouts=cutouts)
    assert fem_reference.solve(scene, "shell", elements=2).settings["graded"] is graded


pytestmark = pytest.mark.smoke

SCENE = scenes.load("two-edges-clamped")
POINTS = SCENE.probe_points()


@pytest.mark.parametrize("model", ["plate", "shell"])
def test_a_section_twice_as_stiff_is_a_material_twice_as_stiff(model):
    twice = with_material(SCENE, young=2 * 54.5e6)
    section = Section(*(2.0 * part for part in section_of(SCENE.material, SCENE.sheet.thickness)))
    stiff = fem_reference.solve(twice, model=model, elements=4)
    given = fem_reference.solve(SCENE, model=model, elements=4, section=section)
    assert given.displacement(POINTS) == pytest.approx(stiff.displacement(POINTS), rel=1e-9)
    assert sum(given.energies.values()) == pytest.approx(sum(stiff.energies.values()), rel=1e-9)
    assert set(given.settings["section"]) == {"membrane", "mixed", "bending", "shear"}
    f = fem_reference.modes(twice, model=model, elements=4, count=3).frequencies
    g = fem_reference.modes(SCENE, model=model, elements=4, count=3, section=section).frequencies
    assert g == pytest.approx(f, rel=1e-9)
