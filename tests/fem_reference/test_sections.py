"""Plate and shell with a section given, not derived: the same sheet, a stiffer one, an orthotropic strip."""

import pytest
from cases import with_material

import fem_reference
from fem_reference.surface.materials import Section, section_of
from sheetbench import scenes

pytestmark = pytest.mark.smoke

SCENE = scenes.load("two-edges-clamped")
POINTS = SCENE.probe_points()


def own(scene):
    return section_of(scene.material, scene.sheet.thickness)


@pytest.mark.parametrize("model", ["plate", "shell"])
def test_the_sheets_own_section_changes_nothing(model):
    plain = fem_reference.solve(SCENE, model=model, elements=4)
    given = fem_reference.solve(SCENE, model=model, elements=4, section=own(SCENE))
    assert given.displacement(POINTS) == pytest.approx(plain.displacement(POINTS), rel=1e-12)
    assert sum(given.energies.values()) == pytest.approx(sum(plain.energies.values()), rel=1e-12)
    assert set(given.settings["section"]) == {"membrane", "bending", "shear"}


@pytest.mark.parametrize("model", ["plate", "shell"])
def test_a_section_twice_as_stiff_is_a_material_twice_as_stiff(model):
    twice = with_material(SCENE, young=2 * 54.5e6)
    section = Section(*(2.0 * part for part in own(SCENE)))
    stiff = fem_reference.solve(twice, model=model, elements=4).displacement(POINTS)
    given = fem_reference.solve(SCENE, model=model, elements=4, section=section).displacement(POINTS)
    assert given == pytest.approx(stiff, rel=1e-9)
    f = fem_reference.modes(twice, model=model, elements=4, count=3).frequencies
    g = fem_reference.modes(SCENE, model=model, elements=4, count=3, section=section).frequencies
    assert g == pytest.approx(f, rel=1e-9)
