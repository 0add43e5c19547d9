"""First steps with one's own scene: new, check, schema and the reference page, all made of the types."""

import json
import tomllib
from pathlib import Path
from typing import Any

import pytest
from commands import one_line, run
from terminals import COMMAND, Terminal

from comparisons.models.check import check
from comparisons.models.keys_page import markdown
from comparisons.models.template import template
from sheetbench import scenes
from sheetbench.scenes import (
    Chain,
    Clamped,
    EdgeLoad,
    Held,
    Hinged,
    Mass,
    Material,
    PointLoad,
    Scene,
    Sheet,
    load,
)
from sheetbench.scenes.language.schema import for_editors, json_schema
from sheetbench.scenes.language.toml import to_toml
from sheetbench.scenes.meaning.words import in_words

DOCS = Path(__file__).parent.parent / "docs"
SHEET, MATERIAL = Sheet(0.3, 0.2, 0.002), Material(1.2e6, 0.45, 1100.0)


def test_the_reference_page_has_every_key_with_its_unit():
    page, schema = markdown(), json_schema(Scene)
    assert (DOCS / "images" / "scene.svg").is_file()
    for table in schema["$defs"].values():
        for key, node in table["properties"].items():
            if key != "kind" and "x" not in table.get("required", ()):  # {x, y, z} stands in its users' rows
                assert f"| `{key}` | {node.get('unit', '')} |" in page
                assert node["description"] in page


def blocks_out_of_force(text):
    """The commented blocks of a template, without their leading "# "."""
    below = text.partition("# All keys")[2].split("\n\n")[1:]
    return ["\n".join(line.removeprefix("# ") for line in block.splitlines()) for block in below]


def test_every_block_of_a_new_scene_can_be_put_in_force():
    text = template("mine", SHEET, MATERIAL)
    blocks = blocks_out_of_force(text)
    assert len(blocks) == 12
    plain = Scene(**tomllib.loads(text))
    assert plain.supports == (Clamped(edge="x0"),) and plain.sheet == SHEET and plain.material == MATERIAL
    added: list[Any] = []
    for block in blocks:
        scene = Scene(**tomllib.loads(f"{text}\n{block}"))
        assert scene != plain
        added += [*scene.supports[1:], *scene.loads, *scene.masses, *scene.actuators]
    kinds = [type(one) for one in added]
    assert kinds.count(EdgeLoad) == kinds.count(PointLoad) == kinds.count(Chain) == kinds.count(Hinged) == 1
    assert kinds.count(Held) == kinds.count(Mass) == 1


def test_new_writes_a_scene_that_check_explains(tmp_path, capsys):
    path = str(tmp_path / "strip.toml")
    options = ("--side", "0.3x0.2", "--young", "1e5", "--thickness", "0.002", "--clamped", "x0,x1")
    assert run("new", path, *options) == 0
    assert (tmp_path / "scene.schema.json").is_file()
    first = Path(path).read_text(encoding="utf-8").splitlines()[0]
    assert first == "#:schema scene.schema.json"
    scene = load(path)
    assert scene.name == "strip" and scene.sheet.lengths == (0.3, 0.2) and scene.material.young == 1e5
    assert [support.edge for support in scene.supports] == ["x0", "x1"]
    capsys.readouterr()
    assert run("check", path) == 0
    printed = capsys.readouterr()
    for part in ("300 × 200 mm", "E = 100 kPa", "1.29 N along −z", "edge x1", "13 × 9 × 2 masses", "24 × 16"):
        assert part in printed.out
    assert printed.err == ""


def test_new_asks_at_a_terminal(tmp_path):
    """What cannot be understood is asked again; an empty line takes what stands in brackets."""
    answers = ["100x50mm", "", "soft", "2MPa", "", "", "x0 y1", "20Pa"]
    asked = Terminal(COMMAND, "new", str(tmp_path / "asked.toml"), columns=120)
    for question, text in zip(
        ("Sides", "Thickness", "modulus", "'soft' is no quantity", "ratio", "Density", "edges", "Pressure"),
        answers,
        strict=True,
    ):
        asked.wait_for(question)
        asked.press(f"{text}\n".encode())
    assert asked.end() == 0
    scene = load(tmp_path / "asked.toml")
    assert scene.sheet.lengths == (0.1, 0.05) and scene.sheet.thickness == 0.002
    assert scene.material.young == 2e6 and scene.loads[0].value == 20.0
    assert [support.edge for support in scene.supports] == ["x0", "y1"]


def test_what_new_assumes_and_a_misspelt_name_are_said(tmp_path, capsys):
    assert run("new", str(tmp_path / "strip.toml"), "--young", "1MPa") == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "Assumed, to be changed in the file: side along x = 0.3 m" in said and "ρ = 1100 kg/m³" in said
    assert "E =" not in said and "clamped at x0" in said
    assert run("check", str(tmp_path / "striip.toml")) == 2
    assert f"did you mean {tmp_path / 'strip.toml'}?" in one_line(capsys)


def test_new_keeps_what_is_there(tmp_path, capsys):
    path = tmp_path / "mine.toml"
    path.write_text("dear\n")
    assert run("new", str(path)) == 2
    assert "--overwrite" in one_line(capsys)
    assert path.read_text() == "dear\n"
    assert run("new", str(path), "--overwrite") == 0
    assert load(path).name == "mine"


def test_check_warns_and_says_what_floats(tmp_path, capsys):
    path = tmp_path / "loose.toml"
    loose = template("loose", SHEET, Material(1.2, 0.45, 1100.0), ())
    path.write_text(loose, encoding="utf-8")
    assert run("check", str(path), "--json") == 0
    printed = capsys.readouterr()
    document = json.loads(printed.out)
    assert len(document["free_rigid_motions"]) == 6
    assert len(document["warnings"]) == 1 and "1.2 MPa is written 1.2e6" in document["warnings"][0]
    assert "1.2 MPa is written 1.2e6" in printed.err and "the sheet can move as a rigid body" in printed.err
    assert {part["part"] for part in document["parts"]} >= {"sheet", "material", "weight", "lattice", "shell"}


@pytest.mark.parametrize(
    ("name", "more", "at_rest", "command"),
    [
        (
            "napkin-on-ball",
            {},
            "in its plane; obstacles alone can stop translation along z",
            "compare napkin",
        ),
        ("strip-on-table", {"friction": 0.3}, "not solved: friction is in motion only", "--duration 1"),
        ("strip-on-table", {}, "held: no rigid-body motion is free", "compare strip-on-table"),
    ],
)
def test_check_proposes_what_can_be_solved(name, more, at_rest, command):
    scene = load(name)
    scene = scene.replace(obstacles=[one.replace(**more) for one in scene.obstacles])
    found = check(scene)
    assert at_rest in dict(found.parts)["at rest"] and not found.free
    (note,) = found.notes()
    assert command in note


def test_the_schema_is_one_document_with_every_unit(tmp_path, capsys):
    assert run("check", "--schema") == 0
    schema = json.loads(capsys.readouterr().out)
    assert schema == json.loads(json.dumps(for_editors(Scene)))
    assert schema["$defs"]["Material"]["properties"]["young"]["description"].startswith(
        "[Pa] Young's modulus"
    )
    assert schema["$defs"]["EdgeLoad"]["required"] == ["kind", "edge"]
    assert {schema["$defs"]["Shape"][f"{most}Properties"] for most in ("min", "max")} == {1}
    assert run("check", "--schema", "--out", str(tmp_path)) == 0
    assert "$defs" not in capsys.readouterr().out  # where it is written it is not printed
    assert (tmp_path / "scene.md").read_text(encoding="utf-8") == markdown()
    assert json.loads((tmp_path / "schema.json").read_text(encoding="utf-8"))["$defs"] == schema["$defs"]


FIBRES = {"kind": "orthotropic", "young_1": 5e7, "young_2": 5e6, "poisson_12": 0.3, "shear_12": 3e6}
SQUARE = {"rectangle": {"x": [0.0, 0.1], "y": [0.0, 0.1]}}


@pytest.mark.parametrize(
    ("part", "keys", "left_out"),
    [
        ("material", {"young": 1e6, "poisson": 0.4}, ("young", "poisson")),
        ("material", FIBRES, ("young_1", "shear_12")),
        ("material", {"law": "neo-hookean", "young": 1e6, "poisson": 0.4}, ("young",)),
        ("material", {"law": "gent", "shear": 4e5, "limit": 20.0, "poisson": 0.45}, ("limit", "poisson")),
        ("support", {"kind": "clamped", "edge": "x0"}, ("edge",)),
        ("support", {"kind": "clamped", "where": SQUARE}, ("where",)),
        ("cutout", {"shape": SQUARE}, ("shape",)),
        ("cutout", {"shape": {**SQUARE, "circle": {"centre": [0.0, 0.0], "radius": 0.02}}}, ()),
    ],
)
def test_the_schema_needs_what_the_parser_needs(part, keys, left_out):
    jsonschema = pytest.importorskip("jsonschema")
    base = scenes.load("one-edge-clamped").document()

    def accepted(keys):
        value: Any = {**keys, "density": 1e3} if part == "material" else [keys]
        document = {**{key: base[key] for key in ("name", "sheet", "material")}, part: value}
        try:
            Scene.model_validate(document)
        except ValueError:
            parsed = False
        else:
            parsed = True
        return [parsed, jsonschema.Draft202012Validator(for_editors(Scene)).is_valid(document)]

    assert accepted(keys) == [bool(left_out)] * 2
    for name in left_out:
        assert accepted({key: value for key, value in keys.items() if key != name}) == [False, False]


@pytest.mark.parametrize("name", scenes.catalogue())
def test_a_scene_written_is_read_back_as_it_was(tmp_path, name):
    scene = load(name)
    path = tmp_path / "again.toml"
    path.write_text(to_toml(scene), encoding="utf-8")
    assert load(path) == scene


def test_descriptions_give_the_directions_of_loads():
    support = [
        {"edge": "x0", "kind": "clamped", "tilt": -0.02},
        {"edge": "x1", "kind": "held", "components": ["y", "z"]},
    ]
    loads = [
        {"kind": "edge", "edge": "x1", "moment_per_length": -2.0, "force_per_length": [0.0, 3.0, 0.0]},
        {"kind": "pressure", "value": -5.0},
        {"kind": "point", "at": [0.3, 0.2], "force": [0.0, 1.0, -2.0]},
    ]
    scene = Scene(name="a", sheet=SHEET, material=MATERIAL, support=support, load=loads)
    said = dict(in_words(scene))
    assert said["weight"] == "none: weightless"
    assert said["edge x0"].endswith("(1.15°): the sheet starts off upwards")
    assert said["edge x1"] == "held along y and z, free to move along x, free to turn"
    assert said["load 1"] == (
        "on edge x1: 3 N/m along +y (0.6 N in all) and a moment of 2 N·m/m that turns what is outside it down"
    )
    assert said["load 2"].startswith("pressure of 5 Pa against the normal, at first −z; 0.3 N")
    assert said["load 3"] == "(0, 1, −2) N at (300, 200) mm, the corner of x1 and y1"
    assert said["at rest"] == "held: no rigid-body motion is free"
    table = {"time": [0.0, 0.5, 1.0], "value": [0.0, 10.0, 0.0]}
    rod = {"edge": "x1", "segments": 4, "bending_stiffness": 1e-3, "line_density": 0.1, "radius": 1e-3}
    chain = {"kind": "chain", **rod, "curvature": table}
    bent = dict(
        in_words(Scene(name="a", sheet=SHEET, material=MATERIAL, support=support[:1], actuator=[chain]))
    )
    assert "its curvature from 0 to 10 to 0 1/m in 1 s" in bent["actuator 1"]
