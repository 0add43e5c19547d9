"""`sheetbench modes`: both models' natural frequencies, in a table and as a document."""

from __future__ import annotations

import json
from pathlib import Path

import meshio
import numpy as np
import pytest

from comparisons.cli import main
from comparisons.modes.spectra import spectra
from sheetbench import scenes


def run(*arguments: str) -> int:
    with pytest.raises(SystemExit) as caught:
        main(["modes", *arguments])
    return int(caught.value.code or 0)


@pytest.mark.usefixtures("undrawn")
def test_both_models_agree_and_files_are_left(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ("one-edge-clamped", "--count", "6", "--elements", "8", "--json", "--out", str(tmp_path))
    assert run(*arguments) == 0
    document = json.loads(capsys.readouterr().out)
    lattice, shell = document["solutions"]
    assert (lattice["model"], shell["model"]) == ("lumped", "shell")
    assert len(lattice["frequencies_hz"]) == len(shell["frequencies_hz"]) == 6
    np.testing.assert_allclose(lattice["frequencies_hz"][:2], shell["frequencies_hz"][:2], rtol=0.03)
    assert {file.name for file in tmp_path.iterdir()} == {
        "modes.json", "modes.csv", "modes.md", "modes.tex", "manifest.json",
        "modes.vtu", "modes.png", "modes.pdf",
    }  # fmt: skip
    assert json.loads((tmp_path / "modes.json").read_text()) == document
    shapes = meshio.read(tmp_path / "modes.vtu").point_data
    assert len(shapes) == 1 + 2 * 6
    first, second = shapes["lumped_mode_1"][:, 2], shapes["shell_mode_1"][:, 2]
    # of shapes scaled alike; the signs are each model's own
    assert np.abs(np.abs(first) - np.abs(second)).max() < 0.02 * np.abs(second).max()


def test_table_has_ten_modes_and_several_references(capsys: pytest.CaptureFixture[str]) -> None:
    asked = ("--lumped", "5", "--reference", "plate", "--reference", "shell", "--elements", "4")
    assert run("two-edges-clamped", *asked) == 0
    printed = capsys.readouterr().out
    assert all(word in printed for word in ("lumped", "plate", "shell", "10", "Hz"))


def test_a_free_sheet_has_its_rigid_motions_left_out() -> None:
    scene = scenes.load("one-edge-clamped").model_copy(update={"supports": ()})
    found = spectra(scene, count=3, grid=(7, 7, 2), elements=4)
    assert [spectrum.rigid for spectrum in found] == [6, 6]
    assert found[0].frequencies[0] == pytest.approx(found[1].frequencies[0], rel=0.1)
    assert any("rigid motions" in said for said in found.report().notes)


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        (("no-such",), "no-such"),
        (("one-edge-clamped", "--count", "0"), "--count"),
        (("one-edge-clamped", "--reference", "beam"), "beam"),
        (("one-edge-clamped", "--calibration", "guess"), "guess"),
        (("one-edge-clamped", "--lumped", "3", "--count", "500"), "count = 500"),
    ],
)
def test_bad_input_leaves_with_2_and_one_line(
    arguments: tuple[str, ...], named: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(*arguments) == 2
    said = capsys.readouterr().err.splitlines()[-1]
    assert named in said
