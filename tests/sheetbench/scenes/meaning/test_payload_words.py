"""[[mass]] as it is written, read back and refused."""

import pytest
from cases import sheet
from scene_files import written

import sheetbench as sb
from sheetbench.errors import SceneError
from sheetbench.scenes import PointLoad, load
from sheetbench.scenes.language.toml import to_toml
from sheetbench.scenes.meaning.composition import weights
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.meaning.plausibility import slips
from sheetbench.scenes.meaning.words import in_words

DISC = "where = {{ circle = {{ centre = [{}, 0.05], radius = 0.01 }} }}".format
BASE = to_toml(sheet(0.2, 0.1, 0.003, 1e7, weight=9.81))
TIP = BASE + '[[mass]]\nat = ["20 cm", 0.05]\nmass = "5 g"\n'


def read(tmp_path, text):
    return load(written(tmp_path, text))


def test_a_payload_is_read_written_and_described(tmp_path):
    turning = f'[[mass]]\nmass = 0.001\ninertia = ["20 g·cm²", 1e-6, "2e-6 kg·m²"]\n{DISC(0.1)}\n'
    scene = read(tmp_path, TIP + turning)
    assert scene.masses[0] == sb.Mass(0.005, (0.2, 0.05)) and scene.masses[1].inertia == (2e-6, 1e-6, 2e-6)
    scene.save(tmp_path / "again.toml")
    assert load(tmp_path / "again.toml") == scene
    words = dict(in_words(scene))
    assert words["mass 1"] == "5 g at (200, 50) mm, on edge x1"
    assert words["mass 2"].endswith(
        ", moments of inertia 20 and 10 g·cm² about x and y; the one about z, the sheet's normal, is ignored"
    )
    assert words["sheet"].endswith(", 60 g") and words["weight"] == "0.647 N along −z, of 66 g in all"
    spread = read(tmp_path, f"{BASE}[[mass]]\nmass = 0.005\n{DISC(0.1)}")
    assert "spread evenly, in the circle of radius 10 mm" in dict(in_words(spread))["mass 1"]
    assert spread.shaped_by == "mass.where" and read(tmp_path, TIP).drawn_by == ""


REFUSED = {
    'at = [0.3, 0.05]\nmass = "5 g"': r"mass 1.at = \[0.3, 0.05\] is off the sheet",
    "mass = 0.005": r"mass 1: give one of at, a point \[x, y\], and where, a part of the sheet",
    f"at = [0.1, 0.05]\nmass = 0.1\n{DISC(0.1)}": "give one of at",
    f"mass = 0.1\n{DISC(0.5)}": "mass 1.where: circle .* no part of it is on the sheet",
    "at = [0.1, 0.05]": "mass 1.mass: missing",
    "at = [0.1, 0.05]\nmass = -0.1": "mass 1.mass = -0.1: must be greater than 0",
    'at = [0.1, 0.05]\nmass = "5 mm"': "'5 mm' is a length; a mass is needed: 20 g",
    f"mass = 0.1\ninertia = [1.0, -1.0, 0.0]\n{DISC(0.1)}": "mass 1.inertia 2 = -1.0: must be 0 or more",
    "at = [0.1, 0.05]\nmass = 0.1\ninertia = [1.0, 1.0, 0.0]": "inertia: the rotation of .* give where, the",
    'at = [0.1, 0.05]\nweight = "5 N"': r"mass 1.weight .* unknown key; known: at, inertia",
}  # fmt: skip


@pytest.mark.parametrize("text", REFUSED)
def test_invalid_payloads_are_refused(tmp_path, text):
    with pytest.raises(SceneError, match=REFUSED[text]):
        read(tmp_path, f"{BASE}[[mass]]\n{text}\n")


def test_a_payload_in_the_wrong_unit_is_hardly_meant(tmp_path):
    heavy = read(tmp_path, TIP).replace(masses=(sb.Mass(7.0, (0.2, 0.05)),))
    assert any('masses are in kg: 7 g is written "7 g"' in said for said in slips(heavy))


def test_its_weight_as_a_load_and_its_mass_as_a_parameter(tmp_path):
    scene = read(tmp_path, TIP)
    assert weights(scene) == (PointLoad(at=(0.2, 0.05), force=(0.0, 0.0, -0.005 * 9.81)),)
    assert weights(scene.replace(gravity=None)) == ()
    found = parameter(scene, "mass1")
    assert (found.value, found.unit, found.low) == (0.005, "kg", 0.0)
    assert put(scene, "mass1", 0.007).masses[0].mass == 0.007
    with pytest.raises(sb.BadInput, match="'mass2': the scene has 1 masses"):
        parameter(scene, "mass2")
