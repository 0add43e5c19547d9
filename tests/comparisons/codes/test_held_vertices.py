"""Sheets held at vertices and by parts in files for other codes, and MuJoCo's answer beside the shell's."""

import json
import runpy

import numpy as np
import pytest

import fem_reference
import lumped
from comparisons.codes.files import WRITERS
from comparisons.codes.setup import setup
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, Sheet

TRAMPOLINE = Scene(
    name="trampoline",
    sheet=Sheet(1.5, 1.5, 0.01),
    material={"young": 3e5, "poisson": 0.0, "density": 444.4},
    gravity={"acceleration": (0.0, 0.0, -9.81)},
)


def corners(size, kind="clamped", rest=1.5):
    """Supports of the corners of a square: squares of this size, or points."""
    spans = [(0.0, size), (rest - size, rest)]
    if not size:
        return tuple(scenes.Point(at=(x, y)) for x in (0.0, rest) for y in (0.0, rest))
    shapes = [{"rectangle": {"x": x, "y": y}} for x in spans for y in spans]
    return tuple({"kind": kind, "where": shape} for shape in shapes)


@pytest.mark.parametrize("code", WRITERS)
def test_single_vertices_and_corners_are_held(code):
    pinned = setup(TRAMPOLINE.replace(supports=corners(0.0)), code, 4, named=False)
    mesh = pinned.problem.mesh
    held = np.unique(mesh.vertices[mesh.held][:, :2], axis=0)
    assert held.tolist() == [[0.0, 0.0], [0.0, 1.5], [1.5, 0.0], [1.5, 1.5]]
    assert pinned.files() and "No files" not in " ".join(pinned.notes())
    assert any("diverges as a mesh gets finer" in note for note in pinned.notes())
    assert (code == "pybullet") == any("cannot turn there" in note for note in pinned.notes())
    squares = setup(TRAMPOLINE.replace(supports=corners(0.375)), code, 4, named=False).problem.mesh
    assert len(np.unique(squares.vertices[squares.held][:, :2], axis=0)) == 16
    for supports, why in (
        ((scenes.Point(at=(0.1, 0.0)), *corners(0.0)), "not on vertices of 4 × 4 squares; take --grid 16"),
        (corners(0.2), "its sides are not on vertices of 4 × 4 squares; take --grid 16"),
        (corners(0.1 * np.sqrt(2.0)), "not on vertices of 4 × 4 squares; take another --grid"),
    ):
        with pytest.raises(BadInput, match=why):
            _ = setup(TRAMPOLINE.replace(supports=supports), code, 4, named=False).problem
    for supports, why in (
        (corners(0.2, "hinged"), "points and clamped rectangles"),
        ((scenes.Point(at=(0.0, 0.0), components=("z",)), *corners(0.0)[1:]), "not along some of them"),
    ):
        assert why in setup(TRAMPOLINE.replace(supports=supports), code, 4, named=False).notes()[0]


@pytest.fixture
def hung(tmp_path, monkeypatch, capsys):
    """Displacements at the probes of a scene by MuJoCo, on so many squares."""
    pytest.importorskip("mujoco")

    def hang(scene, squares):
        for name, write in setup(scene, "mujoco", squares, named=False).files().items():
            write(tmp_path / name)
        monkeypatch.setattr("sys.argv", ["run_mujoco.py", "60"])
        runpy.run_path(str(tmp_path / "run_mujoco.py"), run_name="__main__")
        found = json.loads(capsys.readouterr().out)
        assert found["status"] == "converged"
        return np.array(list(found["probes"].values()))

    return hang


def test_mujoco_hangs_a_sheet_by_its_corners_as_the_shell_does(hung):
    """Corners of one square in sixteen: 0.6 % off."""
    scene = TRAMPOLINE.replace(supports=corners(0.09375))
    shell = fem_reference.solve(scene, model="shell", elements=8).displacement(scene.probe_points())
    assert np.abs(hung(scene, 16) - shell).max() < 0.03 * np.abs(shell).max()


@pytest.mark.parametrize("squares", [8, pytest.param(16, marks=pytest.mark.nightly)])
def test_mujoco_hangs_a_sheet_by_points_as_the_lattice_of_as_many_masses_does(hung, squares):
    """By points alone no two meshes agree: both are 15 % off the shell of as many elements."""
    stiff = TRAMPOLINE.material.replace(young=3e7)
    scene = TRAMPOLINE.replace(supports=corners(0.0), material=stiff, probes={"middle": (0.75, 0.75)})
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(squares + 1, squares + 1))
    lattice = lumped.solve(scene, springs).displacement(scene.probe_points())
    shell = fem_reference.solve(scene, model="shell", elements=squares).displacement(scene.probe_points())
    found = hung(scene, squares)
    assert found[:, 2] == pytest.approx(lattice[:, 2], rel=0.015)
    assert found[0, 2] / shell[0, 2] == pytest.approx(0.85, abs=0.01)
