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
        sb.stability("one-edge-clamped", varied=["nosuch"])
    with pytest.raises(sb.BadInput, match="nosuch"):
        sb.verify(["nosuch"])
    with pytest.raises(sb.BadInput, match="nosuch"):
        sb.score(tmp_path / "a.csv", "nosuch")
    cross = sb.crosscheck("one-edge-clamped", grid=(3, 5), plate=(2, 3), shell=(), solid=(), programs=())
    assert {name: len(found) for name, found in cross.convergences.items()} == {"one-edge-clamped": 2}


@pytest.mark.parametrize("path", sorted((ROOT / "examples").glob("*.py")), ids=lambda path: path.stem)
def test_examples_import_the_package_alone(path):
    assert not re.search(r"^(from|import) comparisons", path.read_text(encoding="utf-8"), re.M)
