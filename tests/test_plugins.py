"""Models from outside: the example of the docs in our tables, and what is said of faulty ones."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from test_cli import one_line, run

import scenes
from comparisons import models, plugins
from comparisons.errors import BadInput

DOCS = Path(__file__).parent.parent / "docs"
ENTRY = "[sheetbench.models]\nstrip = plugin:MODEL\nabsent = no_such_module:MODEL\nhalf = plugin:np\n"


@pytest.fixture
def installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """docs/plugin.py as an installed package would offer it, beside two that are broken."""
    metadata = tmp_path / "outside-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: outside\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY)
    monkeypatch.setattr(sys, "path", [str(tmp_path), str(DOCS), *sys.path])
    plugins._found.cache_clear()
    models.warm.cache_clear()
    yield
    plugins._found.cache_clear()
    models.warm.cache_clear()


def test_the_example_of_the_docs_answers_like_a_beam(installed: None) -> None:
    scene = scenes.load("one-edge-clamped")
    solution = models.solve(scene, "strip", plane_strain=True)
    assert (solution.model, solution.settings) == ("strip", {"plane_strain": True})
    sheet, material = scene.sheet, scene.material
    rigidity = material.young * sheet.thickness**3 / 12 / (1 - material.poisson**2)
    tip = -material.density * sheet.thickness * 9.81 * sheet.length_x**4 / (8 * rigidity)
    assert solution.displacement(scene.probe_points())[3, 2] == pytest.approx(tip)
    assert models.solve(scene, "strip").settings == {"plane_strain": False}


def test_a_plugin_stands_in_the_same_table_and_on_the_same_front(
    installed: None, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ("--lumped", "5", "--calibration", "consistent", "--plate", "", "--shell", "2", "--solid", "")
    options = ("--model", "strip", "--model", "strip:plane_strain=true", "--elements", "4", "--repeats", "1")
    assert run("tradeoff", "one-edge-clamped", *arguments, *options, "--json") == 0
    document = json.loads(capsys.readouterr().out)
    rows = {row["series"]: row for row in document["rows"]}
    assert set(rows) == {"lumped consistent", "shell", "strip", "strip plane_strain"}
    assert rows["strip"]["error"] == pytest.approx(0.32, abs=0.02)  # it is linear
    assert rows["lumped consistent"]["error"] < rows["strip"]["error"]
    quickest = document["rows"][document["front"][0]]
    assert quickest["model"] == "strip"


def test_what_is_wrong_with_a_plugin_is_said_in_a_line(
    installed: None, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = scenes.load("one-edge-clamped")
    assert plugins.names()[:1] == ["absent"]
    for name, said in (
        ("absent", "cannot be loaded.*no_such_module"),
        ("half", "lacks a name"),
        ("none", "unknown, choose one of lumped, plate, shell, solid, absent, half"),
    ):
        with pytest.raises(BadInput, match=f"model = '{name}': .*{said}"):
            models.solve(scene, name)
    with pytest.raises(BadInput, match="no setting 'grid'; it has plane_strain"):
        models.solve(scene, "strip", grid=9)
    assert run("tradeoff", "one-edge-clamped", "--model", "strip:grid=9") == 2
    assert "no setting 'grid'" in one_line(capsys)
