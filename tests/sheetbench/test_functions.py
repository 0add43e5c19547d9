"""Every verb is a function of `import sheetbench`, or is named in docs/first-steps.md as one that is not."""

import inspect
import re
from pathlib import Path

import numpy as np
import pytest

import sheetbench as sb
from comparisons.cli.app import VERBS

ROOT = Path(__file__).parents[2]
ONLY_IN_THE_TERMINAL = {"live", "new", "scenes", "study"}
STUDIES = ("reproduce",)  # `sheetbench study reproduction`


def test_every_verb_is_a_function_or_is_said_not_to_be_one():
    page = (ROOT / "docs" / "first-steps.md").read_text(encoding="utf-8")
    for verb in (*VERBS, *STUDIES):
        if verb in ONLY_IN_THE_TERMINAL:
            assert f"`{verb}`" in page.partition("Only in the terminal")[2]
        else:
            assert inspect.isfunction(getattr(sb, verb)) and f"`{verb}`" in page


def test_the_reference_has_every_function_by_the_name_that_is_called():
    page = (ROOT / "docs" / "api" / "verbs.md").read_text(encoding="utf-8")
    functions = {name for name in sb.__all__ if inspect.isfunction(getattr(sb, name))}
    assert set(re.findall(r"autofunction:: (\w+)$", page, re.M)) == functions


def test_springs_are_found_from_numbers_as_the_command_line_finds_them():
    found = sb.calibrate(young="0.6 MPa", poisson=0.45, thickness="2 mm", side=(0.12, 0.04), grid=3)
    sheet, material = sb.Sheet(0.12, 0.04, 0.002), sb.Material(0.6e6, 0.45, 1000.0)
    scene = sb.Scene("s", sheet, material, supports=(sb.Clamped("y0"),), loads=(sb.Pressure(1.0),))
    assert found.document() == sb.calibrate(scene, grid=3).document()
    assert sb.calibrate(scene, young=1.2e6, grid=3) == sb.calibrate(scene.replace(young=1.2e6), grid=3)
    with pytest.raises(sb.BadInput, match="missing poisson, thickness, side"):
        sb.calibrate(young=1e6)


def test_a_lattice_is_exported_from_python(tmp_path):
    folder = sb.export("one-edge-clamped", tmp_path / "lattice", grid=3)
    assert {"nodes.csv", "links.csv", "lattice.npz", "README.md"} <= {path.name for path in folder.iterdir()}
    held = np.load(folder / "lattice.npz")
    springs = sb.calibrate("one-edge-clamped", grid=3)
    again = np.load(sb.export("one-edge-clamped", tmp_path / "again", springs=springs) / "lattice.npz")
    assert np.array_equal(held["link_stiffness"], again["link_stiffness"])


def test_the_other_functions_return_what_their_verbs_report_on(tmp_path):
    assert sb.schema()["properties"]["sheet"] and sb.suite("modes").tables()
    sb.export("one-edge-clamped", tmp_path / "lattice", grid=3)
    assert sb.report(tmp_path) == tmp_path / "report.html" and (tmp_path / "report.html").is_file()
    with pytest.raises(sb.BadInput, match="nosuch"):
        sb.stability("one-edge-clamped", vary="nosuch")
    with pytest.raises(sb.BadInput, match="nosuch"):
        sb.verify(["nosuch"])
    with pytest.raises(sb.BadInput, match="nosuch"):
        sb.score(tmp_path / "a.csv", "nosuch")
    cross = sb.crosscheck("one-edge-clamped", grid=(3, 5), plate=(2, 3), shell=(), solid=(), judges=())
    assert {name: len(found) for name, found in cross.convergences.items()} == {"one-edge-clamped": 2}


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples_import_the_package_alone(path):
    assert not re.search(r"^(from|import) comparisons", path.read_text(encoding="utf-8"), re.M)


SCENE = sb.load("one-edge-clamped")
WRONG = {
    "a keyword of none": (
        lambda: sb.compare(SCENE, gird=5),
        "compare: no keyword 'gird'; .*did you mean grid",
    ),
    "the older name": (lambda: sb.stability(SCENE, varied=["load"]), "did you mean vary"),
    "one too many": (lambda: sb.calibrate(SCENE, grid=3, lumped=3), "lumped and grid are one"),
    "a missing one": (lambda: sb.compare(), "compare: missing a required argument: 'scene'"),
    "an inner one": (lambda: sb.cell("equilateral", SCENE), "spacing = Scene"),
    "the wrong order": (lambda: sb.homogenise("equilateral", SCENE), "the scene comes first"),
    "a list": (lambda: sb.advise(SCENE, tolerance=[1]), r"tolerance = \[1\]: a number is needed"),
    "a length": (lambda: sb.simulate(SCENE, "2 mm", grid=3), "duration = '2 mm': '2 mm' is a length"),
    "shapes": (lambda: sb.error([[1, 2, 3]], [[1, 2]]), "equal shapes"),
    "a key of a part": (lambda: SCENE.replace(yung=1e6), "yung: unknown key; did you mean young"),
    "no scene": (lambda: sb.compare(3), "scene = 3: a Scene, a name of the catalogue or a path"),
    "no model": (lambda: sb.solve(SCENE, 5), "model = 5: a name as 'lumped'"),
    "no number": (lambda: sb.modes(SCENE, count="3", grid=3), "count = 3: a whole number"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_argument_is_refused_in_the_terminals_words(case):
    ask, said = WRONG[case]
    with pytest.raises(sb.BadInput, match=said):
        ask()


def test_an_option_has_one_name_in_command_and_function():
    """By the functions' signatures; what an option lists once a flag is a list."""
    from comparisons.cli.app import verb_group

    other = {"model": "models", "lumped": "grid", "for": "", "tensile": "", "toml": "", "export": ""}
    other |= {"wait": "", "scheduler": "", "retry": "", "animate": "", "measured": "measured"}
    of_terminal = {"json", "overwrite", "figure", "no_pictures", "quiet", "help", "out", "no_uncertainty"}
    for verb in (
        "compare",
        "tradeoff",
        "crosscheck",
        "stability",
        "modes",
        "linearise",
        "advise",
        "verify",
        "suite",
    ):
        known = inspect.signature(getattr(sb, verb)).parameters
        for option in verb_group().commands[verb].params:
            name = option.name
            if option.param_type_name != "option" or name in of_terminal or not other.get(name, name):
                continue
            assert other.get(name, name) in known or name in (*WIDER, *known), (verb, name)


WIDER = {"large", "duration"}  # `crosscheck --duration` is `compare` with models of its own
