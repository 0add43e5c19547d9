"""What a scene's author gets wrong is said in the scene's words: near misses, lists from 1, no tracebacks."""

import pytest
from scene_files import refusal

from sheetbench import scenes
from sheetbench.scenes import SceneError
from sheetbench.scenes.language.schema import json_schema

pytestmark = pytest.mark.smoke

GOOD = scenes.catalogue()["actuated-edge"].read_text(encoding="utf-8")
LOAD = '[[load]]\nkind = "point"\nat = [0.1, 0.1]\nforce = [0.0, 0.0, 0.1]\n'


def with_load(keys):
    return GOOD.replace("[probes]", f"{LOAD}[[load]]\n{keys}\n[probes]")


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (
            GOOD.replace("thickness", "thicknes"),
            "sheet.thickness: missing; sheet.thicknes = 0.003: unknown key; did you mean thickness?",
        ),
        (
            with_load('kind = "edge"\nedge = "x1"\nforce = [0.0, 0.0, 1.0]'),
            "load 2.force = [0.0, 0.0, 1.0]: unknown key; "
            "known: edge, force_per_length, history, hold, kind, moment_per_length, where",
        ),
        (
            with_load('kind = "pressure"\nvalue = "2"'),
            "load 2.value: '2' is text: write the number [Pa] without quotes, or with a unit",
        ),
        (
            GOOD.replace('"clamped"', '"clamp"'),
            "support 1: kind = 'clamp': did you mean clamped? "
            "choose one of clamped, hinged, held, point, curved, symmetric",
        ),
        (
            GOOD.replace('edge = "x1"', 'edge = "X1"'),
            "actuator 1.edge = 'X1': did you mean x1? choose one of x0, x1, y0, y1",
        ),
        (GOOD.replace("segments = 8", "segments = 2.5"), "actuator 1.segments = 2.5: must be a whole number"),
        (
            GOOD.replace("[[support]]", "[support]"),
            "support = {'edge': 'x0', 'kind': 'clamped'}: must be a list of tables, each headed [[support]]",
        ),
        (GOOD.replace("[0.0, 0.0, -9.81]", "[0.0, -9.81]"), "gravity.acceleration 3: missing"),
        (GOOD.replace("[0.0, 0.0, -9.81]", "-9.81"), "gravity.acceleration = -9.81: must be a list of 3"),
        (
            GOOD.replace("P4 = [", "edge = ['a', "),
            "probes.edge = ['a', 0.188, 0.188]: must have 2 entries, not 3",
        ),
        (GOOD.replace("[probes]", "[air]\ndrag = 0\n[probes]"), "air.drag = 0: must be greater than 0"),
        (GOOD.replace("[probes]", "[air]\ndensity = 1.2\n[probes]"), "air.drag: missing"),
        (
            GOOD.replace("[probes]", "[springs]\naxial = {x = 1.0}\n[probes]"),
            "springs.axial.y: missing; springs.diagonal: missing; springs.vertical: missing; and 3 more",
        ),
    ],
)
def test_the_key_the_value_and_what_is_allowed_are_said(tmp_path, text, said):
    assert text != GOOD
    assert refusal(tmp_path, text) == said


@pytest.mark.parametrize(("text", "part"), [
    (GOOD.replace('edge = "x0"', "edge = []"), "support 1.edge = []"),
    (GOOD.replace('edge = "x0"', "edge = {}"), "support 1.edge = {}"),
    ("support = 3.0\n" + GOOD.replace('[[support]]\nedge = "x0"\nkind = "clamped"', ""),
        "support = 3.0: must be a list"),
    (f"a = {'[' * 500}{']' * 500}\n{GOOD}", "within each other"),
    (GOOD.replace("thickness = 0.003", f"thickness = 1{'0' * 4301}"), "more digits than can be read"),
    (GOOD.replace("thickness = 0.003", f"thickness = 0x1{'0' * 9000}"), "a number of about 1083"),
    (f"{'.'.join(['a'] * 5000)} = 1\n{GOOD}", "a = {'a': {'a'"),
    (f"{'a' * 5000} = 1\n{GOOD}", "unknown key"),
    (GOOD.replace("thickness = 0.003", f'thickness = "{"3" * 9000}"'), "write a number"),
])  # fmt: skip
def test_hostile_files_are_refused_in_a_short_line(tmp_path, text, part):
    assert text != GOOD
    said = refusal(tmp_path, text)
    assert part in said
    assert len(said) < 400


def test_control_characters_are_written_out(tmp_path):
    said = refusal(tmp_path, '"\\u001b[31mred\\nline" = 3\n' + GOOD)
    assert "\\x1b[31mred\\nline" in said and said.isprintable()


def test_a_byte_order_mark_is_no_fault(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.encode())
    assert scenes.load(path) == scenes.load("actuated-edge")


def test_objects_are_refused_in_one_line_too():
    with pytest.raises(SceneError, match=r"^Sheet: thickness = -0.1: must be greater than 0$"):
        scenes.Sheet(0.2, 0.1, -0.1)
    with pytest.raises(SceneError, match=r"^Scene: sheet.thickness: missing; material: missing$"):
        scenes.Scene(name="a", sheet={"length_x": 1.0, "length_y": 1.0})


WITHOUT_UNIT = {"quads", 
    "grid", "grading", "graded_edges", "poisson", "factor", "components", "support", "load", "actuator",
    "x", "y", "z", "limit", "poisson_12", "poisson_13", "poisson_23", "loss_factor", "relaxation", "share",
    "patch", "cutout", "layer", "drag", "friction", "normal", "axis",
}  # fmt: skip


def test_every_key_says_what_it_is():
    schema = json_schema(scenes.Scene)
    for name, table in {"Scene": schema, **schema["$defs"]}.items():
        of_above = name == "Stiffnesses"  # whose unit is that of membrane or bending
        for key, facts in table["properties"].items():
            assert facts.get("description", "").endswith((".", ")")), f"{name}.{key}"
            tables = {"$ref", "oneOf"} & facts.get("items", {}).keys()
            if (
                facts.get("type") in ("number", "array")
                and key not in WITHOUT_UNIT
                and not tables
                and not of_above
            ):
                assert "unit" in facts, f"{name}.{key}"
