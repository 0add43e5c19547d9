"""Every verb is a function of `import sheetbench`, of the command's words and defaults."""

import inspect
import json
import re
from pathlib import Path

import numpy as np
import pytest
from fake_solutions import solution

import sheetbench as sb
from comparisons.cli.app import VERBS
from comparisons.comparison.answer import Comparison

ROOT = Path(__file__).parents[2]


def test_every_verb_but_a_server_is_a_function():
    assert {verb for verb in VERBS if not inspect.isfunction(getattr(sb, verb, None))} == {"live"}


def test_the_reference_has_every_function_by_the_name_that_is_called():
    page = (ROOT / "docs" / "api" / "verbs.md").read_text(encoding="utf-8")
    functions = {name for name in sb.__all__ if inspect.isfunction(getattr(sb, name))}
    assert set(re.findall(r"autofunction:: (\w+)$", page, re.M)) == functions


def test_springs_are_found_from_numbers_as_the_command_line_finds_them():
    found = sb.calibrate(young="0.6 MPa", poisson=0.45, thickness="2 mm", side=(0.12, 0.04), grid=3)
    sheet, material = sb.Sheet(0.12, 0.04, 0.002), sb.Material(0.6e6, 0.45, 1000.0)
    scene = sb.Scene("s", sheet, material, supports=(sb.Clamped("y0"),), loads=(sb.Pressure(1.0),))
    assert found.springs == sb.calibrate(scene, grid=3).springs
    softer = sb.calibrate(scene.replace(young=1.2e6), grid=3)
    assert sb.calibrate(scene, young=1.2e6, grid=3).springs == softer.springs
    with pytest.raises(sb.BadInput, match="missing poisson, thickness, side"):
        sb.calibrate(young=1e6)


def test_a_lattice_is_exported_from_python(tmp_path):
    springs = sb.calibrate("one-edge-clamped", grid=3, export=tmp_path / "lattice")
    assert {"nodes.csv", "links.csv", "README.md"} <= {path.name for path in (tmp_path / "lattice").iterdir()}
    held = np.load(tmp_path / "lattice" / "lattice.npz")
    assert held["link_stiffness"].max() > 0.0 and springs.grid == (3, 3, 2)


@pytest.mark.usefixtures("in_process")
def test_what_the_terminal_has_python_has(tmp_path):
    """A motion of several models, a folder of files, a page, a study; the rest: test_every_verb.py."""
    moved = sb.compare("two-edges-settling", duration="4 ms", grid=(3, 4), elements=1, uncertainty=False)
    assert len(moved.histories) == 2
    sb.modes("one-edge-clamped", grid=3, elements=2, count=2, out=tmp_path / "modes", no_pictures=True)
    record = json.loads((tmp_path / "modes" / "manifest.json").read_text(encoding="utf-8"))
    assert record["runs"]["modes"]["finished"] and (tmp_path / "modes" / "modes.json").is_file()
    assert sb.report(tmp_path) == tmp_path / "report.html" and (tmp_path / "report.html").is_file()
    assert sb.new(tmp_path / "mine.toml", side=(0.1, 0.2)).is_file()
    for name, part in (("reproduction", "nearest"), ("promises", "expected")):
        assert sb.study(name, part=part).report()


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples_import_the_package_alone(path):
    assert not re.search(r"^(from|import) comparisons", path.read_text(encoding="utf-8"), re.M)


SCENE = sb.load("one-edge-clamped")
WRONG = {
    "a keyword of none": (
        lambda: sb.compare(SCENE, gird=5),
        "compare: got an unexpected keyword argument 'gird'; it has .*did you mean grid\\?",
    ),
    "the older name": (lambda: sb.stability(SCENE, varied=["load"]), "'varied'; it has .*vary"),
    "one too many": (lambda: sb.calibrate(SCENE, grid=3, lumped=3), "lumped and grid are the same option"),
    "a missing one": (lambda: sb.compare(), "compare: missing a required argument: 'scene'"),
    "an inner one": (lambda: sb.cell("equilateral", SCENE), "spacing = Scene"),
    "a list": (lambda: sb.tradeoff(SCENE, tolerance=[1]), r"tolerance = \[1\]: a number is needed"),
    "no effect": (lambda: sb.compare(SCENE, every=1e-3), "every: no effect without duration; leave it out"),
    "another name": (lambda: sb.verify(["nosuch"]), "nosuch"),
    "a length": (lambda: sb.simulate(SCENE, "2 mm", grid=3), "duration = '2 mm': '2 mm' is a length"),
    "shapes": (lambda: sb.error([[1, 2, 3]], [[1, 2]]), "equal shapes"),
    "a key of a part": (lambda: SCENE.replace(yung=1e6), "yung: unknown key; did you mean young"),
    "an object's keyword": (lambda: sb.Sheet(0.1, 0.1, thicknes=1e-3), "did you mean thickness"),
    "an object's values": (lambda: sb.Circle((0.1, 0.1), 0.1, 3), "takes 2 values by place"),
    "an object's value": (lambda: sb.Circle((0.1, 0.1), -0.1), "must be greater than 0"),
    "a model of none": (
        lambda: Comparison(SCENE, (solution(SCENE), solution(SCENE, "shell")))["shel"],
        "model = 'shel': unknown, choose one of lumped, shell; did you mean shell",
    ),
    "no scene": (lambda: sb.compare(3), "scene = 3: a Scene, a name of the catalogue or a path"),
    "no model": (lambda: sb.solve(SCENE, 5), "model = 5: a name as 'lumped'"),
    "no number": (lambda: sb.modes(SCENE, count="3", grid=3), "count = 3: a whole number"),
}


ARGUMENTS = ("a keyword of none", "the older name", "one too many", "a missing one", "a key of a part")
ARGUMENTS += ("an object's keyword", "an object's values")


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_argument_is_refused_in_the_terminals_words(case):
    ask, said = WRONG[case]
    with pytest.raises(sb.BadInput, match=said) as refused:
        ask()
    assert isinstance(refused.value, TypeError) == (case in ARGUMENTS)
