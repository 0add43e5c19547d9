"""Models from outside: the example of the docs in our tables, and what is said of faulty ones."""

import sys
import tomllib
from pathlib import Path

import pytest
from commands import json_of, one_line, run

from comparisons.external import plugins
from comparisons.external.answer import ExternalCode
from comparisons.models import solve as solvers
from comparisons.models.spec import parse
from comparisons.sweep import task
from comparisons.sweep.solved import Ask
from sheetbench import face as models
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, EdgeLoad

DOCS = Path(__file__).parents[3] / "docs"
ENTRY = "[sheetbench.models]\nstrip = plugin:MODEL\nabsent = no_such_module:MODEL\nhalf = plugin:np\n"


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """docs/plugin.py as an installed package would offer it, beside two that are broken."""
    metadata = tmp_path / "outside-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: outside\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY)
    monkeypatch.setattr(sys, "path", [str(tmp_path), str(DOCS), *sys.path])
    plugins._found.cache_clear()
    solvers.warm.cache_clear()
    yield
    plugins._found.cache_clear()
    solvers.warm.cache_clear()


def test_the_example_of_the_docs_answers_like_a_beam(installed):
    scene = scenes.load("one-edge-clamped")
    solution = models.solve(scene, "strip", plane_strain=True)
    assert (solution.model, solution.settings) == ("strip", {"plane_strain": True})
    sheet, material = scene.sheet, scene.material
    rigidity = material.young * sheet.thickness**3 / 12 / (1 - material.poisson**2)
    tip = -material.density * sheet.thickness * 9.81 * sheet.length_x**4 / (8 * rigidity)
    assert solution.displacement(scene.probe_points())[3, 2] == pytest.approx(tip)
    assert models.solve(scene, "strip").settings == {"plane_strain": False}


@pytest.mark.usefixtures("in_process")
def test_a_plugin_stands_in_the_same_table_and_on_the_same_front(installed, capsys):
    arguments = ("--lumped", "5", "--calibration", "consistent", "--plate", "", "--shell", "2", "--solid", "")
    options = ("--model", "strip", "--model", "strip:plane_strain=true", "--elements", "4", "--repeats", "1")
    document = json_of(capsys, "tradeoff", "one-edge-clamped", *arguments, *options)
    rows = {row["series"]: row for row in document["rows"]}
    assert set(rows) == {"lumped consistent", "shell", "strip", "strip plane_strain"}
    assert rows["strip"]["error"] == pytest.approx(0.32, abs=0.02)  # it is linear
    assert rows["lumped consistent"]["error"] < rows["strip"]["error"]
    quickest = document["rows"][document["front"][0]]
    assert quickest["model"] == "strip"


def test_what_is_wrong_with_a_plugin_is_said_in_a_line(installed, capsys):
    scene = scenes.load("one-edge-clamped")
    assert plugins.names()[:1] == ["absent"]
    for name, said in (
        ("absent", "cannot be loaded.*no_such_module"),
        ("half", "lacks a name"),
        ("none", "unknown, choose one of lumped, .*plate, shell, solid, absent, .*half"),
    ):
        with pytest.raises(BadInput, match=f"model = '{name}': .*{said}"):
            models.solve(scene, name)
    with pytest.raises(BadInput, match="no setting 'grid'; it has plane_strain"):
        models.solve(scene, "strip", grid=9)
    assert run("tradeoff", "one-edge-clamped", "--model", "strip:grid=9") == 2
    assert "no setting 'grid'" in one_line(capsys)


@pytest.mark.parametrize("where", ["when it is loaded", "when it solves"])
def test_one_that_ends_the_program_is_refused(tmp_path, capsys, where):
    """The exit status was 0, and nothing was said."""
    file, text = tmp_path / f"{where[-5:].strip()}.py", "raise SystemExit(0)\n"
    if where == "when it solves":
        example = (DOCS / "plugin.py").read_text()
        text = f"{example}\n\nclass Ends(Strip):\n    def solve(self, *_):\n        {text}"
    file.write_text(text)
    few = ("--lumped", "3", "--elements", "2", "--no-uncertainty")
    assert run("compare", "one-edge-clamped", *few, "--model", f"{file}:Ends") == 2
    assert "plug-in" in (said := capsys.readouterr().err) and "Traceback" not in said


def test_a_row_is_of_the_plug_in_as_it_is_and_of_what_it_imports_beside_it(tmp_path):
    """Rows of an edited plug-in were read as if nothing had changed."""
    file, beside = tmp_path / "own.py", tmp_path / "constants.py"
    example = (DOCS / "plugin.py").read_text()
    file.write_text(f"from constants import UNIT\n{example}")
    beside.write_text("UNIT = 1\n")
    (tmp_path / "elsewhere.py").write_text("x = 1\n")
    scene, name = scenes.load("one-edge-clamped"), f"{file}:Strip"

    def key():
        return Ask(scene, parse(name)).task.key

    first = key()
    (tmp_path / "elsewhere.py").write_text("x = 2\n")
    assert key() == first
    beside.write_text("UNIT = 2\n")
    second = key()
    file.write_text(f"from constants import UNIT\n{example}\n")
    assert len({first, second, key()}) == 3
    with pytest.raises(RuntimeError, match="changed since this run was requested"):
        task.solve(scene.document(), name, {}, digest=plugins.digest("lumped"))


PLUG_INS = Path(__file__).parents[3] / "examples" / "plug-ins"


@pytest.fixture
def shipped(monkeypatch):
    """The plug-ins of examples/plug-ins, by the entry points that their package has."""
    known = tomllib.loads((PLUG_INS / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "entry-points"
    ]
    monkeypatch.setattr(plugins, "OURS", {**plugins.OURS, **known[plugins.GROUP]})
    plugins._found.cache_clear()
    yield known[plugins.GROUP]
    plugins._found.cache_clear()


def test_the_plug_ins_of_the_examples_are_models_by_their_names(shipped):
    assert shipped.keys() == {"felupe", "mujoco"} <= set(plugins.names())
    for name in shipped:
        assert plugins.plugin(name).name == name
        file = f"{PLUG_INS}/sheetbench_{name}.py:MODEL"
        assert plugins.plugin(file).settings == plugins.plugin(name).settings
    assert isinstance(plugins.plugin("felupe"), ExternalCode)


def test_mujoco_refuses_what_it_does_not_have(shipped):
    base = scenes.load("one-edge-clamped")
    pulled = base.replace(loads=(EdgeLoad(edge="x1", force_per_length=(1.0, 0.0, 0.0)),))
    tilted = base.replace(supports=(Clamped(edge="x0", tilt=0.1),))
    for scene in (scenes.load("curved-edge"), pulled, tilted):
        solution = models.solve(scene, "mujoco")
        assert solution.status is Status.REFUSED and solution.message
    for name, value in (("elastic2d", "none"), ("grid", 2)):
        with pytest.raises(BadInput, match=f"{name} = "):
            models.solve(base, "mujoco", **{name: value})
