"""Programs with nothing but the files find our forces and displacements: in NumPy, C++ and Octave."""

import re
import runpy
import shutil
import subprocess

import numpy as np
import pytest
from cases import calibrated
from exported import BLOWN, READERS, SCENES

import lumped
from comparisons.codes.lattice import export
from comparisons.codes.tables import arrays

NUMPY = runpy.run_path(str(READERS / "read_lattice.py"))
AGREED = 1e-6  # of the largest displacement, as the readers themselves ask
COMPILER = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
# every fourth by day: between them are those that take seconds
AT_REST = ("hinged", "half", "cylinder", "gent", "cut", "bimetal", "table", "ball", "skew", "muscles")


def described(name):
    scene, settings = SCENES[name]
    lattice = arrays(lumped.describe(scene, calibrated(scene, **settings)))
    return lattice, NUMPY["differences"](lattice)


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Folders by the scene that is in them."""
    made = tmp_path_factory.mktemp("lattices")
    for name in ("graded", "mooney-rivlin", "gent", "hinged", "woven", "skew", "muscles", "table", "napkin"):
        scene, settings = SCENES[name]
        export(made / name, scene, calibrated(scene, **settings))
    export(made / "blown", BLOWN, calibrated(BLOWN, 3))
    return {path.name: path for path in made.iterdir()}


@pytest.mark.parametrize("name", SCENES)
def test_numpy_alone_finds_our_forces(name):
    lattice, along = described(name)
    assert (lattice["mass"] > 0.0).all()
    assert lattice["coupling_stiffness"].any() == (name in ("woven", "skew"))
    without, touched = {**lattice, "contact_values": lattice["contact_values"] * ([1] * 9 + [0])}, False
    parts = (lattice[f"state_{part}"] for part in ("displacement", "force", "energy"))
    for u, force, energy in zip(*parts, strict=True):
        found, gradient = NUMPY["gradient"](lattice, along, u)
        assert found == pytest.approx(energy, rel=1e-9)  # rounding of lengths: L eps / elongation
        np.testing.assert_allclose(gradient, force, atol=1e-9 * np.abs(force).max())
        alone = NUMPY["gradient"](without, along, u)[1]
        touched |= bool(np.abs(alone - force).max() > 1e-3 * np.abs(force).max())
    assert touched == bool(SCENES[name][0].obstacles)  # what these add is not lost among the springs


@pytest.mark.sweep(4)
@pytest.mark.parametrize("name", AT_REST)
def test_numpy_alone_finds_our_displacements(name):
    lattice, along = described(name)
    assert lattice["state_name"][-1] == "equilibrium"
    u, truth = NUMPY["equilibrium"](lattice, along, 2), lattice["state_displacement"][-1]
    assert np.abs(u - truth).max() < AGREED * np.abs(truth).max()


@pytest.mark.parametrize(
    ("name", "found", "count"),
    [("hinged", "3 states off by", "+"), ("napkin", "2 states off by", "*")],
)
def test_the_numpy_reader_is_a_program(folders, capsys, name, found, count):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["read_lattice.py", str(folders[name])])
        with pytest.raises(SystemExit) as left:
            runpy.run_path(str(READERS / "read_lattice.py"), run_name="__main__")
    assert not left.value.code
    said = capsys.readouterr()
    assert said.out.startswith(f"forces of {found}")
    assert ("the folder has no equilibrium" in said.out) == (name == "napkin")
    assert re.fullmatch(rf"(statics of \d+ masses, load in \d+ step\(s\)\n){count}", said.err)


@pytest.mark.skipif(shutil.which("octave") is None, reason="needs Octave: install the Debian package octave")
def test_octave_finds_our_displacements(folders):
    for place in (folders[name] for name in ("graded", "mooney-rivlin", "gent")):
        command = ["octave", "--quiet", "--no-gui", "--eval", f"read_lattice('{place}', 4)"]
        found = subprocess.run(command, cwd=READERS, capture_output=True, text=True, timeout=120)
        assert found.returncode == 0, found.stderr
        assert "displacements at rest by" in found.stdout


@pytest.mark.skipif(COMPILER is None, reason="needs a C++ compiler: install the Debian package g++")
def test_cpp_steps_to_our_displacements(folders, tmp_path):
    program = tmp_path / "read_lattice"
    source = READERS / "read_lattice.cpp"
    subprocess.run([str(COMPILER), "-O1", "-std=c++17", str(source), "-o", str(program)], check=True)
    page = (folders["muscles"] / "README.md").read_text(encoding="utf-8")
    assert "`natural.csv`" in page and "changes over time" in page
    refusals = {"blown": "dead loads only", "table": "no obstacles", "napkin": "no obstacles"}
    for name, place in folders.items():
        found = subprocess.run([str(program), str(place)], capture_output=True, text=True, timeout=120)
        assert found.returncode == (2 if name in refusals else 0), found.stdout + found.stderr
        assert refusals.get(name, "") in found.stderr


def test_the_numpy_reader_says_what_it_is_too_small_for():
    many = {"positions": np.zeros((5000, 3))}
    with pytest.raises(SystemExit, match="for 1500 masses at most: write a lattice of a smaller --grid"):
        NUMPY["equilibrium"](many, {})
