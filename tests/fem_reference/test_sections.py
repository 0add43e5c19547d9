"""Plate and shell with a section given, not derived: the same sheet, a stiffer one, an orthotropic strip."""

import numpy as np
import pytest
from cases import with_material

import fem_reference
from fem_reference.surface.materials import Section, section_of
from sheetbench import scenes
from sheetbench.scenes import Clamped, PointLoad, Sheet

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


def test_an_orthotropic_strip_bends_with_its_stiffness_along_itself():
    """Cantilever of width b with D12 = 0: w = F L³/(3 D11 b) + F L/(S b); D22 and D66 have no part in it."""
    sheet = Sheet(length_x=0.2, length_y=0.05, thickness=0.002)
    ends = (0.0, 0.025, 0.05)
    force = 1e-4
    loads = tuple(
        PointLoad(at=(0.2, y), force=(0.0, 0.0, share * force))
        for y, share in zip(ends, (1, 4, 1), strict=True)
    )  # 1 : 4 : 1 over one biquadratic element is an even line load
    scene = SCENE.model_copy(
        update={"sheet": sheet, "supports": (Clamped(edge="x0"),), "loads": loads, "gravity": None}
    )
    bending, shear = np.diag([0.2, 0.05, 0.03]), np.diag([40.0, 90.0])
    section = Section(np.diag([1e4, 2e4, 1e4]), bending, shear)
    found = fem_reference.solve(scene, model="plate", elements=(8, 1), section=section)
    expected = 6 * force * (0.2**3 / (3 * 0.2) + 0.2 / 40.0) / 0.05
    assert found.displacement(np.array([[0.2, 0.025]]))[0, 2] == pytest.approx(expected, rel=1e-6)
