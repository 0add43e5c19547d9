"""Numbers that are fine in SI units and hardly meant are said once, with the unit, and solved."""

import json
import warnings
from pathlib import Path

import pytest
from commands import run
from scene_files import GOOD, SPRINGS, written

import sheetbench as sb
from sheetbench import scenes
from sheetbench.scenes import Implausible
from sheetbench.scenes.meaning.plausibility import slips

FAR = SPRINGS.replace("0.001", "2.0") + "\n[probes]"
LOAD = '[[load]]\nkind = "point"\nat = [0.1, 0.1]\nforce = [0.0, 0.0, 1.0e5]\n'
SLIPS = {
    "E in MPa": ("54.5e6", "54.5", ["young = 54.5 Pa", "54.5 MPa is written 54.5e6"]),
    "E of a metal": ("54.5e6", "2.0e11", ["young = 2e+11 Pa is 200 GPa"]),
    "density in g/cm³": ("1678.0", "1.1", ["density = 1.1 kg/m³", "1.1 g/cm³ is written 1100"]),
    "density of nothing": ("1678.0", "30000.0", ["density = 30000 kg/m³", "heavier than any metal"]),
    "a thick sheet": ("0.003", "0.05", ["thickness = 0.05 m", "0.188 m", "metres"]),
    "gravity in mm/s²": ("-9.81", "-9810.0", ["9810 m/s²", "9810 mm/s² is written 9.81"]),
    "another planet": ("-9.81", "-1.0", ["gravity.acceleration = [0.0, 0.0, -1.0]", "9.81", "m/s²"]),
    "layers far apart": ("[probes]", FAR, ["springs.layer_distance = 2 m", "667 times the thickness"]),
    "too heavy": ("54.5e6", "2.0e4", ["ρ g a/E = 0.155", "0.05"]),
    "loads in mN": ("[probes]", f"{LOAD}[probes]", ["the loads are 3.25 times", "N/m"]),
    "no load": ("[0.0, 0.0, -9.81]", "[0.0, 0.0, 0.0]", ["nothing moves the sheet"]),
}
IN_MILLIMETRES = GOOD.replace("0.188", "188.0").replace("0.003", "3.0").replace("0.094", "94.0")


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_said_with_file_key_value_and_unit(tmp_path, slip):
    instead_of, stands, said = SLIPS[slip]
    assert instead_of in GOOD
    path = str(written(tmp_path, GOOD.replace(instead_of, stands)))
    with pytest.warns(Implausible) as caught:
        scenes.load(path)
    (warning,) = caught
    text = str(warning.message)
    assert text.startswith(f"{path}: ") and all(part in text for part in said)
    assert "\n" not in text


def test_a_scene_in_millimetres_is_said_to_be_one(tmp_path):
    with pytest.warns(Implausible, match=r"length_x = 188 m, .*thickness = 3 m: .* 188 mm is written 0.188"):
        scenes.load(written(tmp_path, IN_MILLIMETRES))


def test_what_is_plausible_is_not_remarked_on():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for name in scenes.catalogue():
            assert slips(scenes.load(name)) == ()
        for path in (Path(__file__).parents[4] / "examples" / "rubber").glob("*.toml"):  # to λ = 2
            assert slips(scenes.load(path)) == ()


def test_every_verb_says_it_once_on_standard_error(tmp_path, capsys):
    path = str(written(tmp_path, GOOD.replace("54.5e6", "54.5")))
    assert (
        run("calibrate", path, "--grid", "5", "--calibration", "fit-modal", "--json") == 0
    )  # loads it twice
    printed = capsys.readouterr()
    assert printed.err.count("young = 54.5 Pa") == 1
    (said,) = json.loads(printed.out)["warnings"]
    assert said in printed.err


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--young", "54.5"), ["54.5 MPa is written 54.5e6"]),
        (("--thickness", "3", "--side", "188"), ["188 mm is written 0.188"]),
        (("--density", "1.1"), ["1.1 g/cm³ is written 1100"]),
        (("--layer-distance", "3"), ["layer-distance = 3 m", "1000 times"]),
    ],
)
def test_implausible_options_get_a_warning(options, said, capsys):
    assert run("calibrate", "one-edge-clamped", "--grid", "5", *options) == 0
    # a busy machine says how far it is
    lines = [line for line in capsys.readouterr().err.splitlines() if not line.startswith("solving")]
    assert len(lines) == 1 and all(part in lines[0] for part in said)


def test_a_scene_that_was_loaded_is_not_warned_of_again(tmp_path):
    with pytest.warns(Implausible):
        scene = scenes.load(written(tmp_path, IN_MILLIMETRES))
    with warnings.catch_warnings():
        warnings.simplefilter("error", Implausible)
        sb.solve(scene, "plate", elements=1)
    other = scene.replace()
    assert other == scene and repr(other) == repr(scene)
    with pytest.warns(Implausible):
        sb.solve(other, "plate", elements=1)
