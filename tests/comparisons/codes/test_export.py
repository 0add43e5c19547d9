"""Springs out: what `--export` writes, by which verbs; programs that read nothing but the files."""

import csv
import json
import re
import runpy
import shutil
import subprocess

import numpy as np
import pytest
from cases import CLAMP, RUBBER, SHEET, calibrated
from commands import run
from exported import BLOWN, DRAWN, HALF, READERS, SCENES
from scipy.io import loadmat

import lumped
from comparisons.codes.lattice import export, lattice_files
from comparisons.codes.tables import NAMES, arrays
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import Hinged, Scene
from sheetbench.scenes.objects.springs import DamperSet


def table(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Folders by the scene that is in them; the first is Habibi et al.'s test 1, edge twist and all."""
    made = tmp_path_factory.mktemp("lattices")
    seed = scenes.load("two-edges-clamped")
    export(made / "seed", seed, calibrated(seed, 4, method="consistent"))
    for name in ("graded", "mooney-rivlin", "gent", "hinged", "woven", "skew", "muscles", "table", "napkin"):
        scene, settings = SCENES[name]
        export(made / name, scene, calibrated(scene, **settings))
    export(made / "blown", BLOWN, calibrated(BLOWN, 3))
    return {path.name: path for path in made.iterdir()}


def test_the_tables_hold_what_the_lattice_is(folders):
    folder, scene = folders["seed"], scenes.load("two-edges-clamped")
    solution = lumped.solve(scene, calibrated(scene, 4, method="consistent"))
    nodes, links, cells = (table(folder / f"{name}.csv") for name in ("nodes", "links", "cells"))
    assert [*nodes[0]] == ["number", "i", "j", "k", "x", "y", "z", "mass"]
    assert [*links[0]] == ["a", "b", "family", "rest_length", "stiffness", "damping"]
    corners = [f"corner_{n}" for n in (1, 2, 3, 4)]
    assert [*cells[0]][:9] == ["kind", *corners, "rest_area", *(f"stiffness_{n}" for n in (1, 2, 3))]
    assert all(len(name) < 12 and name.replace("_", "").isalnum() for name in cells[0])
    assert sum(float(row["mass"]) for row in nodes) == pytest.approx(1678.0 * 0.003 * 0.188**2)
    families = {row["family"] for row in links}
    assert families == {"axial", "diagonal", "vertical", "cross", "cross_diagonal"}
    assert len(links) == len(solution.mesh.cells[0][1])
    assert {row["kind"] for row in cells} == {"area", "strain"}
    assert any("+" in row["corner_1"] for row in cells) and any(row["corner_1"] == "0" for row in cells)
    check = [row for row in table(folder / "check.csv") if row["state"] == "equilibrium"]
    at_rest = [[float(row[name]) for name in ("ux", "uy", "uz")] for row in check]
    np.testing.assert_array_equal(at_rest, solution.mesh.point_data["displacement"])
    assert len(table(folder / "states.csv")) == 3
    manifest = json.loads((folder / "manifest.json").read_text())
    assert set(manifest["runs"]["export"]["files"]) == {p.name for p in folder.iterdir()} - {"manifest.json"}


def test_the_page_says_what_a_drawn_sheet_is_made_of(tmp_path):
    export(tmp_path, DRAWN, calibrated(DRAWN, (9, 5)))
    page = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert len(table(tmp_path / "nodes.csv")) < 90
    assert "patch 1: rectangle" in page and "left out" in page


def test_matlab_and_numpy_files_hold_the_same(folders):
    folder = folders["seed"]
    arrays, other = dict(np.load(folder / "lattice.npz")), loadmat(folder / "lattice.mat")
    assert set(arrays) == set(NAMES)
    for name, values in arrays.items():
        if values.dtype.kind == "U":
            assert [str(cell[0]) for cell in other[name].ravel()] == values.tolist()
        else:
            np.testing.assert_array_equal(other[name].ravel(), values.ravel(), err_msg=name)
    page = (folder / "README.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in page for name in NAMES) and "left out" not in page
    assert "natural.csv" not in page and not (folder / "natural.csv").exists()


def test_an_exported_lattice_carries_the_payload(tmp_path):
    scene = scenes.load("two-edges-clamped")
    laden = scene.replace(masses=({"at": (0.17, 0.16), "mass": 0.05},))
    own = calibrated(scene, 3)
    bare, found = (lumped.describe(one, own) for one in (scene, laden))
    assert (found.mass - bare.mass).sum() == pytest.approx(0.05)
    assert (found.dead - bare.dead).sum(axis=0) == pytest.approx([0.0, 0.0, -9.81 * 0.05])
    export(tmp_path, laden, own)
    assert sum(float(row["mass"]) for row in table(tmp_path / "nodes.csv")) == pytest.approx(found.mass.sum())
    with pytest.raises(BadInput, match=r"mass.inertia: an exported lattice has point masses only"):
        part = {"circle": {"centre": (0.1, 0.1), "radius": 0.05}}
        lumped.describe(scene.replace(masses=({"where": part, "mass": 0.1, "inertia": (1e-6,) * 3},)), own)


def test_tables_hold_obstacles_and_their_points(tmp_path):
    scene = scenes.load("strip-on-table")
    export(tmp_path, scene, calibrated(scene, (5, 3)))
    (row,) = table(tmp_path / "obstacles.csv")
    assert [*row] == ["kind", "x", "y", "z", "ax", "ay", "az", "radius"]
    assert (row["kind"], row["z"], row["az"], row["radius"]) == ("plane", "-0.03", "1.0", "0.0")
    points = table(tmp_path / "contacts.csv")
    assert len(points) == 4 * 8 and sum(float(p["area"]) for p in points) == pytest.approx(0.2 * 0.05)
    assert [float(p["stiffness"]) for p in points] == pytest.approx([1e6 / 1e-3] * 32)
    assert {p["weight_1"] for p in points} == {"0.0", "0.5"} and points[0]["mass_8"] == "11"
    page = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "`contacts.csv`" in page and "natural.csv" not in page
    for code in ("cpp", "matlab", "sofa"):
        with pytest.raises(BadInput, match="obstacle"):
            lattice_files(scene, calibrated(scene, 3), code)


def test_loads_that_follow_the_sheet_balance_it_as_the_readme_says():
    """At rest, springs, dead loads and the followers by the README's formulas leave the supports alone."""
    lattice = arrays(lumped.describe(BLOWN, calibrated(BLOWN, (4, 4, 3))))
    x = lattice["positions"] + lattice["state_displacement"][-1]
    unbalanced = lattice["state_force"][-1] - lattice["load"]
    corners, layers = lattice["pressed_corners"], 3
    mean = x[corners].mean(axis=2)
    turned = [np.cross(mean[:, (i + 1) % 4] - mean[:, i], mean[:, i - 1] - mean[:, i]) for i in range(4)]
    for i in range(4):
        beside = turned[(i + 1) % 4] + turned[i - 1]
        push = lattice["pressure"][:, None] / 36 * (4 * turned[i] + 2 * beside + turned[(i + 2) % 4])
        np.subtract.at(unbalanced, corners[:, i].ravel(), np.repeat(push / layers, layers, axis=0))
    top, bottom = lattice["couple_masses"].T
    along = x[lattice["couple_after"]].mean(axis=1) - x[lattice["couple_before"]].mean(axis=1)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    director = x[top] - x[bottom]
    couple = (lattice["couple_moment"] / (director**2).sum(axis=1))[:, None] * np.cross(along, director)
    np.subtract.at(unbalanced, top, couple)
    np.add.at(unbalanced, bottom, couple)
    scale = np.abs(unbalanced).max()
    free = lattice["index"][:, 0] > 0
    assert np.abs(unbalanced[free]).max() < 1e-6 * scale  # the solver's own tolerance is 1e-9 of all forces


def test_what_files_cannot_say_is_refused_or_told(tmp_path):
    with pytest.raises(BadInput, match="actuators are not springs"):
        scene = scenes.load("actuated-edge")
        lumped.describe(scene, calibrated(scene, 5))
    free = Scene(name="free", sheet=SHEET, material=RUBBER, support=(Hinged(edge="x0"),))
    found = lumped.describe(free, calibrated(free, 3))
    assert [state.name for state in found.states] == ["stretched", "rolled"]
    assert "rotation about edge x0" in found.notes[0]
    assert "no equilibrium to check by" in export(tmp_path, free, calibrated(free, 3))
    assert "no equilibrium to check by" in (tmp_path / "README.md").read_text(encoding="utf-8")
    with pytest.raises(BadInput, match=r"--export = .*holds files of another 'export'"):
        export(tmp_path, HALF, calibrated(HALF, 3))


def test_verbs_export_the_lattice_that_they_answer_with(tmp_path, capsys):
    sheet = ["--young", "1e6", "--poisson", "0.3", "--thickness", "0.002", "--side", "0.1x0.2"]
    assert run("calibrate", *sheet, "--grid", "3", "--export", str(tmp_path / "a")) == 0
    assert f"loadsin{tmp_path / 'a'}:startatits" in "".join(capsys.readouterr().out.split())
    assert {row["edge"] for row in table(tmp_path / "a" / "supports.csv")} == {"x0"}
    changed = ["--thickness", "0.002", "--grid", "3", "--json", "--export", str(tmp_path / "b")]
    assert run("calibrate", "two-edges-clamped", *changed) == 0
    json.loads(capsys.readouterr().out)
    assert "0.002 m" in (tmp_path / "b" / "README.md").read_text(encoding="utf-8")


def test_exported_dampers_are_those_of_the_motion():
    material = RUBBER.model_copy(update={"damping_time": 4e-3, "damping_rate": 2.0})
    scene = Scene(name="damped", sheet=SHEET, material=material, support=(CLAMP,))
    found = lumped.describe(scene, calibrated(scene, 3))
    np.testing.assert_allclose(found.links.damping, 4e-3 * found.links.stiffness)
    for cells in found.cells:
        np.testing.assert_allclose(cells.damping, 4e-3 * cells.stiffness)
    assert found.damping_rate == 2.0
    own = scene.model_copy(update={"dampers": DamperSet(axial=3.0, vertical=5.0)})
    found = lumped.describe(own, calibrated(scene, 3))
    ends = found.links.masses[found.links.damping > 0.0]
    assert set(found.links.family[found.links.damping > 0.0]) == {"axial", "vertical"}
    assert len({tuple(pair) for pair in found.links.masses.tolist()}) == len(found.links.masses)
    assert len(ends) == 24 + 9 and not any(cells.damping.any() for cells in found.cells)


# ---- readers
NUMPY = runpy.run_path(str(READERS / "read_lattice.py"))
AGREED = 1e-6  # of the largest displacement, as the readers themselves ask
COMPILER = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")
# every fourth by day: between them are those that take seconds
AT_REST = ("hinged", "half", "cylinder", "gent", "cut", "bimetal", "table", "ball", "skew", "muscles")


def described(name):
    scene, settings = SCENES[name]
    lattice = arrays(lumped.describe(scene, calibrated(scene, **settings)))
    return lattice, NUMPY["differences"](lattice)


@pytest.mark.parametrize("name", SCENES)
def test_numpy_alone_finds_our_forces(name):
    lattice, along = described(name)
    assert (lattice["mass"] > 0.0).all()
    assert lattice["coupling_stiffness"].any() == (name in ("woven", "skew", "bimetal"))
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
