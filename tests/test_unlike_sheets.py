"""Sheets that are not one isotropic material all over: verbs that know them, and verbs that do not."""

import json
from pathlib import Path

import meshio
import numpy as np
import pytest
from commands import one_line, run

from sheetbench.scenes import catalogue, load

PLAIN = load("one-edge-clamped")
FIBRES = dict(
    young_1=54.5e6, young_2=8e6, poisson_12=0.35, shear_12=4e6, shear_13=3e6, shear_23=2e6, angle=0.5
)
SHEETS = {
    "drawn": PLAIN.replace(
        patches=[{"shape": {"circle": {"centre": (0.1, 0.1), "radius": 0.03}}, "young": 1e9}]
    ),
    "fabric": PLAIN.replace(material={"kind": "orthotropic", "density": PLAIN.material.density, **FIBRES}),
}
SMALL = ["--lumped", "5", "--elements", "4", "--no-pictures"]


@pytest.fixture(autouse=True)
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, scene in SHEETS.items():
        scene.save(f"{name}.toml")


def test_files_say_what_each_cell_is_made_of():
    assert run("compare", "drawn.toml", *SMALL, "--out", "out") == 0
    for model in ("lumped", "shell"):
        (file,) = Path("out").rglob(f"{model}*.vtu")
        young, patch = (np.concatenate(meshio.read(file).cell_data[key]) for key in ("young", "patch"))
        assert set(young) == {54.5e6, 1e9} and set(patch[young == 1e9]) == {1.0}


@pytest.mark.parametrize(("sheet", "key"), [("drawn", "patch"), ("fabric", "material.kind = 'orthotropic'")])
@pytest.mark.parametrize(
    ("verb", "options", "who"),
    [
        ("calibrate", ["--calibration", "uniform"], "calibration 'uniform'"),
        ("compare", ["--calibration", "fit-static"], "calibration 'fit-static'"),
        ("compare", ["--law", "biot"], "the shell's law 'biot'"),
    ],
)
def test_options_for_isotropic_sheets_are_refused_on_others(sheet, key, verb, options, who, capsys):
    assert run(verb, f"{sheet}.toml", *options) == 2
    assert f"{key}: {who} is for isotropic sheets" in one_line(capsys)


@pytest.mark.sweep
@pytest.mark.parametrize(
    "options",
    [
        ["check"],
        ["compare", "--lumped", "5", "--reference", "solid", "--elements", "16"],
        ["modes", "--lumped", "5", "--elements", "8", "--count", "2"],
    ],
)
def test_verbs_take_a_mesh_file_from_its_scenes_folder(capsys, options):
    x, y = (axis.ravel() for axis in np.meshgrid([0.0, 0.05, 0.1, 0.15, 0.2], [-1.0, 0.0, 1.0]))
    points = np.column_stack([x, 0.05 + (0.05 - 0.1 * x) * y, 0.0 * x])
    quads = [[i + 5 * j, i + 1 + 5 * j, i + 6 + 5 * j, i + 5 + 5 * j] for j in range(2) for i in range(4)]
    scenes = Path("scenes")
    scenes.mkdir()
    meshio.write(scenes / "fin.msh", meshio.Mesh(points, [("quad", quads)]), "gmsh22")
    fin = catalogue()["ray-fin"].read_text(encoding="utf-8")
    lines = ['mesh = "fin.msh"' if line.startswith("outline") else line for line in fin.splitlines()]
    (scenes / "fin.toml").write_text("\n".join(lines), encoding="utf-8")
    capsys.readouterr()
    verb, *more = options
    assert run(verb, "scenes/fin.toml", *more, "--json") == 0
    assert json.loads(capsys.readouterr().out)
