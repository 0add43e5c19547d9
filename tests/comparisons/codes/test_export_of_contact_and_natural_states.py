"""Exported lattices with obstacles, and of sheets that are not flat at rest: files alone give our forces."""

import csv
import runpy
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import lumped
from comparisons.codes.arrays import arrays
from comparisons.codes.lattice import export, lattice_files
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes.objects.grid import grid_of

READERS = Path(__file__).parents[3] / "comparisons" / "codes" / "scripts"
NUMPY = runpy.run_path(str(READERS / "read_lattice.py"))
COMPILER = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
AGREED = 1e-6  # of the largest displacement, as the readers themselves ask


def spring_set(scene, grid):
    cells = lumped.sections_of(scene, grid_of(scene.sheet, grid))
    own = {} if cells is None else {"cells": cells}
    return lumped.calibrate(scene.sheet, scene.material, grid=grid, **own)


def table(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize(
    ("name", "grid", "solved"),
    [
        ("bimetal-strip", (7, 3), True),
        ("muscle-bands", (7, 3), True),
        ("strip-on-table", (5, 3), True),
        pytest.param("finger-on-cylinder", (7, 3), True, marks=pytest.mark.nightly),
        pytest.param("finger-on-ball", (5, 3), True, marks=pytest.mark.nightly),
        ("napkin-on-ball", (4, 4), False),  # unstable: no equilibrium in the folder
    ],
)
def test_numpy_alone_finds_our_forces_and_displacements(name, grid, solved):
    scene = scenes.load(name.replace("finger-on-ball", "finger-on-cylinder"))
    if name == "finger-on-ball":
        (bar,) = scene.obstacles
        ball = scenes.Sphere(position=(bar.position[0], 0.01, bar.position[2]), radius=bar.radius)
        scene = scene.replace(obstacles=(ball,))
    lattice = arrays(lumped.describe(scene, spring_set(scene, grid)))
    along, states = NUMPY["differences"](lattice), lattice["state_name"].tolist()
    assert ("pressed" in states) == bool(scene.obstacles)
    for state, u, force, energy in zip(
        states,
        *(lattice[f"state_{part}"] for part in ("displacement", "force", "energy")),
        strict=True,
    ):
        found, gradient = NUMPY["gradient"](lattice, along, u)
        assert found == pytest.approx(energy, rel=1e-9)
        np.testing.assert_allclose(gradient, force, atol=1e-9 * np.abs(force).max())
        if state == "pressed":  # what obstacles add is not lost among the springs
            without = {**lattice, "contact_stiffness": 0.0 * lattice["contact_stiffness"]}
            alone = NUMPY["gradient"](without, along, u)[1]
            assert np.abs(alone - force).max() > 1e-3 * np.abs(force).max()
    if solved:
        u, truth = NUMPY["equilibrium"](lattice, along), lattice["state_displacement"][-1]
        assert states[-1] == "equilibrium"
        assert np.abs(u - truth).max() < AGREED * np.abs(truth).max()


def test_a_natural_shear_is_in_the_files():
    """Of sides that are not at right angles without stress, and grown by a tenth."""
    scene = scenes.load("muscle-bands").replace(
        patches=(), natural={"strain": (0.1, 0.02, 0.03), "curvature": (5.0, -2.0, 3.0)}
    )
    lattice = arrays(lumped.describe(scene, spring_set(scene, 4)))
    assert np.abs(lattice["strain_natural"][:, 2]).max() > 0.05 * lattice["strain_natural"][:, 0].min()
    along = NUMPY["differences"](lattice)
    for u, force in zip(lattice["state_displacement"], lattice["state_force"], strict=True):
        gradient = NUMPY["gradient"](lattice, along, u)[1]
        np.testing.assert_allclose(gradient, force, atol=1e-9 * np.abs(force).max())


def test_tables_hold_obstacles_and_their_points(tmp_path):
    scene = scenes.load("strip-on-table")
    export(tmp_path, scene, spring_set(scene, (5, 3)))
    (row,) = table(tmp_path / "obstacles.csv")
    assert [*row] == ["kind", "x", "y", "z", "ax", "ay", "az", "radius", "stiffness"]
    assert (row["kind"], row["z"], row["az"], row["radius"]) == ("plane", "-0.03", "1.0", "0.0")
    assert float(row["stiffness"]) == pytest.approx(1e6 / 1e-3)
    points = table(tmp_path / "contacts.csv")
    assert len(points) == 15 and sum(float(p["area"]) for p in points) == pytest.approx(0.2 * 0.05)
    assert {p["weight_1"] for p in points} == {"1.0"} and points[0]["corner_1"] == "0+1"
    page = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "`contacts.csv`" in page and "natural.csv" not in page
    for code in ("cpp", "matlab", "sofa"):
        with pytest.raises(BadInput, match="obstacle"):
            lattice_files(scene, spring_set(scene, 3), code)


@pytest.mark.skipif(COMPILER is None, reason="needs a C++ compiler: install the Debian package g++")
def test_cpp_steps_to_our_displacements_of_muscles(tmp_path):
    scene, program = scenes.load("muscle-bands"), tmp_path / "read_lattice"
    source = READERS / "read_lattice.cpp"
    subprocess.run([str(COMPILER), "-O1", "-std=c++17", str(source), "-o", str(program)], check=True)
    export(tmp_path / "muscles", scene, spring_set(scene, (7, 3)))
    page = (tmp_path / "muscles" / "README.md").read_text(encoding="utf-8")
    assert "`natural.csv`" in page and "changes over time" in page
    found = subprocess.run([str(program), str(tmp_path / "muscles")], capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr
    strip = scenes.load("strip-on-table")
    export(tmp_path / "strip", strip, spring_set(strip, 3))
    refused = subprocess.run([str(program), str(tmp_path / "strip")], capture_output=True, text=True)
    assert refused.returncode == 2 and "no obstacles" in refused.stderr
