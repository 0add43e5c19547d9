"""Quantities with units, scene objects by place, and what sheetbench does not model, refused as such."""

import inspect
import warnings
from pathlib import Path

import pytest
from scene_files import GOOD, refusal, written

import sheetbench as sb
from sheetbench.scenes import Implausible
from sheetbench.scenes.language.limits import PAGE, UNSUPPORTED
from sheetbench.scenes.language.schema import for_editors
from sheetbench.scenes.language.units import NAMES, quantity
from sheetbench.scenes.objects.supports import Motion

ROOT = Path(__file__).parents[4]
SHEET, MATERIAL = sb.Sheet(0.12, 0.04, 0.002), sb.Material(0.6e6, 0.45, 1100.0)


@pytest.mark.parametrize(
    ("text", "unit", "value"),
    [
        ("2 mm", "m", 0.002),
        ("0.6MPa", "Pa", 0.6e6),
        ("1.2 g/cm³", "kg/m³", 1200.0),
        ("1.2 g/cm^3", "kg/m³", 1200.0),
        ("5 ms", "s", 0.005),
        ("5 N/mm2", "Pa", 5e6),
        ("−9.81 m/s2", "m/s²", -9.81),
        ("20 N·cm²", "N·m²", 0.002),
        ("2 mN*m/m", "N·m/m", 0.002),
        ("180 deg", "rad", 3.141592653589793),
        ("0.1 1/cm", "1/m", 10.0),
        ("4 m⁻¹", "1/m", 4.0),
        ("3 µm", "m", 3e-6),
        ("54.5e6", "Pa", 54.5e6),
        ("0.45", "", 0.45),
    ],
)
def test_a_quantity_is_the_number_in_si_units_to_the_last_digit(text, unit, value):
    assert quantity(text, unit) == value


@pytest.mark.parametrize(
    ("text", "unit", "said"),
    [
        ("2 MPa", "m", "'2 MPa' is a stress or modulus; a length is needed: 2 mm"),
        ("2 mm", "Pa", "'2 mm' is a length; a stress or modulus is needed: 0.6 MPa"),
        ("5 %", "rad", "is a pure number; an angle is needed: 2 deg"),
        ("2 foo", "m", "'foo' is no known unit"),
        ("2 Mpa", "Pa", "'Mpa' is no known unit (MPa or mPa?)"),
        ("3 mm/", "m", "nothing follows the last /"),
        ("1,2 mm", "m", "with a decimal point"),
        ("two", "m", "write a number [m], or with a unit: 2 mm"),
        ("nan", "m", "is no quantity"),
        ("1e301 m", "m", "too large"),
        ("3 m^999999999", "m", "no known unit"),
    ],
)
def test_what_is_no_quantity_of_the_kind_is_refused_by_name(text, unit, said):
    with pytest.raises(sb.BadInput) as caught:
        quantity(text, unit)
    assert said in str(caught.value)


def test_every_unit_of_a_scene_has_a_name_and_an_example_that_reads_back():
    units = {
        node["unit"]
        for table in for_editors(sb.Scene)["$defs"].values()
        for node in table["properties"].values()
        if "unit" in node
    }
    assert units <= set(NAMES)
    for unit, (_, example) in NAMES.items():
        assert quantity(example, unit) > 0.0


WITH_UNITS = """
name = "s"
[sheet]
length_x = "120 mm"
length_y = "4 cm"
thickness = 0.002
[material]
young = "0.6 MPa"
poisson = 0.45
density = "1.1 g/cm3"
[gravity]
acceleration = [0.0, 0.0, "-9.81 m/s2"]
[[support]]
edge = "x0"
kind = "clamped"
motion = {time = [0.0, "100 ms"], displacement = [[0.0, 0.0, "1 mm"], [0.0, 0.0, 0.0]]}
[[actuator]]
edge = "x1"
segments = 8
bending_stiffness = "20 N·cm2"
line_density = "50 g/m"
radius = "1.5 mm"
curvature = {time = [0.0, "100 ms"], value = [0.0, "0.1 1/cm"]}
[probes]
P1 = ["10 mm", 0.02]
"""


def test_a_file_takes_quantities_wherever_a_number_has_a_unit(tmp_path):
    scene = sb.load(written(tmp_path, WITH_UNITS))
    assert (scene.sheet, scene.material) == (SHEET, MATERIAL)
    assert scene.gravity == sb.Gravity((0.0, 0.0, -9.81))
    assert scene.supports[0].motion == Motion((0.0, 0.1), ((0.0, 0.0, 0.001), (0.0, 0.0, 0.0)))
    chain = scene.actuators[0]
    assert (chain.bending_stiffness, chain.line_density, chain.radius) == (0.002, 0.05, 0.0015)
    assert (chain.curvature.time, chain.curvature.value) == ((0.0, 0.1), (0.0, 10.0))
    assert scene.probes == {"P1": (0.01, 0.02)}
    assert sb.Sheet("120 mm", "4 cm", "2 mm") == SHEET


@pytest.mark.parametrize(
    ("text", "stands", "said"),
    [
        ('"120 mm"', '"120 MPa"', "sheet.length_x: '120 MPa' is a stress or modulus; a length is needed"),
        ('"100 ms"], value', '"100 mm"], value', "curvature.time 2: '100 mm' is a length; a time is needed"),
        ('"10 mm"', '"10 s"', "probes.P1 1: '10 s' is a time; a length is needed"),
        ("poisson = 0.45", 'poisson = "0.45"', "material.poisson = '0.45': must be a number"),
        ("segments = 8", 'segments = "8"', "segments = '8': must be a whole number"),
    ],
)
def test_a_wrong_unit_is_refused_where_it_stands(tmp_path, text, stands, said):
    assert said in refusal(tmp_path, WITH_UNITS.replace(text, stands))


def test_signatures_name_every_key_with_its_type():
    assert str(inspect.signature(sb.Curved)).startswith(
        "(edge: Literal['x0', 'x1', 'y0', 'y1'], curvature: fl"
    )
    names = list(inspect.signature(sb.Scene).parameters)
    assert names[:5] == ["name", "sheet", "material", "gravity", "supports"]
    assert not {"values", "support", "load", "actuator"} & set(names)
    for kind in (sb.Scene, sb.Sheet, sb.Chain, sb.EdgeMotion, sb.EdgeLoad):
        assert set(inspect.signature(kind).parameters) == set(kind.model_fields)


def test_a_scene_replaces_what_its_sheet_and_material_hold():
    scene = sb.Scene("strip", SHEET, MATERIAL, supports=(sb.Clamped("x0"),), loads=(sb.Pressure(1.0),))
    other = scene.replace(young="2 MPa", thickness=0.001, length_x=0.2)
    assert other.material == MATERIAL.replace(young=2e6)
    assert other.sheet == sb.Sheet(0.2, 0.04, 0.001)
    assert other.probes["P4"] == (0.2, 0.04)  # probes that nobody chose
    chosen = scene.replace(probes={"A": (0.1, 0.0)})
    assert chosen.replace(length_x=0.2).probes == {"A": (0.1, 0.0)}


def test_a_scene_shows_itself_on_a_few_lines():
    text = repr(sb.load("curved-edge"))
    assert text.startswith("Scene curved-edge\n") and len(text.splitlines()) <= 10
    assert repr(sb.Clamped("x0", 0.1)) == str(sb.Clamped("x0", 0.1)) == "Clamped(edge='x0', tilt=0.1)"


@pytest.mark.parametrize("module", ["__main__", "studies.mine", "lumped"])
def test_an_implausible_scene_made_in_python_is_warned_of_by_the_verb_that_reads_it(module):
    mine = {"__name__": module, "sb": sb, "sheet": sb.Sheet(120, 40, 2), "material": MATERIAL}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        exec('scene = sb.Scene("mm", sheet, material, supports=(sb.Clamped("x0"),))', mine)
    for read in (sb.calibrate, sb.solve):
        scene = mine["scene"].replace(title=read.__name__)  # each scene is warned of once
        with pytest.warns(Implausible, match="120 mm is written 0.12") as caught:
            read(scene, grid=3)
        assert caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read(scene, grid=3)
        good = sb.load("two-edges-clamped").replace(name="other")
        sb.calibrate(good, grid=3)
        assert any("120 mm" in said for said in sb.check(mine["scene"]).complaints())
        assert sb.check(good).complaints() == []


@pytest.mark.parametrize(
    ("text", "key"),
    [
        ("[[hole]]\nx = 1\n[probes]", "hole"),
        ("[[laminate]]\nx = 1\n[probes]", "laminate"),
        ("[contact]\n[probes]", "contact"),
        ("[initial_state]\nx = 1\n[probes]", "initial_state"),
        ('[[load]]\nkind = "magnetic"\n[probes]', "magnetic"),
        ("[material.young_x]\n[probes]", "young_x"),
        ("[material.c10]\n[probes]", "c10"),
    ],
)
def test_what_is_not_modelled_is_refused_as_such(tmp_path, text, key):
    said = refusal(tmp_path, GOOD.replace("[probes]", text))
    assert UNSUPPORTED[key] in said and PAGE in said
    assert "did you mean" not in said and "unknown key" not in said


def test_a_refusal_says_what_is_meant():
    with pytest.raises(sb.SceneError, match=r"Material.young cannot be changed.*replace\(young=…\)"):
        MATERIAL.young = 1.0
    with pytest.raises(sb.SceneError, match="did you mean two-edges-clamped"):
        sb.load("two-edge-clamped")


def test_no_key_that_a_scene_has_is_said_not_to_be_modelled():
    schema = for_editors(sb.Scene)
    tables = [*schema["$defs"].values(), schema]
    keys = {key for table in tables for key in table["properties"]}
    assert keys & set(UNSUPPORTED) == {"hole"}  # of `where`; a table [[hole]] is none
    assert (ROOT / PAGE).is_file()
