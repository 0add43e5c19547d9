"""Springs out: what `--export` writes, and that other programs find our displacements with nothing else."""

import csv
import json
import re
import runpy
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from cases import CLAMP, GRAVITY, OBLONG, RUBBER, SHEET, SILICONE
from commands import run
from rubbers import LAWS, rubber
from scipy.io import loadmat

import lumped
from comparisons.codes.arrays import NAMES, arrays
from comparisons.codes.lattice import export
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeLoad, Held, Hinged, Material, PointLoad, Pressure, Scene, Sheet, Symmetric
from sheetbench.scenes.objects.grid import grid_of

READERS = Path(__file__).parents[3] / "comparisons" / "codes" / "scripts"
NUMPY = runpy.run_path(str(READERS / "read_lattice.py"))
AGREED = 1e-6  # of the largest displacement, as the readers themselves ask

HINGED = Scene(
    name="hinged",
    sheet=OBLONG,
    material=SILICONE,
    gravity=GRAVITY,
    support=(Hinged(edge="x0"), Hinged(edge="x1"), Held(edge="y0", components=("z",))),
)
HALF = Scene(
    name="half",
    sheet=OBLONG,
    material=SILICONE,
    support=(CLAMP, Symmetric(edge="y1")),
    load=(
        PointLoad(at=(0.2, 0.05), force=(0.0, 0.0, 0.05)),
        EdgeLoad(edge="x1", force_per_length=(1.0, 0.0, 0.0)),
    ),
)

RUBBERS = [rubber(law, damping_time=1e-3) for law in LAWS]


CUT = {"shape": {"rectangle": {"x": (0.09, 0.2), "y": (0.045, 0.1)}}}
ROOT = {"rectangle": {"x": (0.0, 0.02), "y": (0.0, 0.1)}}
DRAWN = HALF.replace(
    supports=[{"kind": "clamped", "where": ROOT}],
    loads=[EdgeLoad(edge="x1", force_per_length=(1.0, 0.0, 0.2))],
    cutouts=[CUT],
    patches=[{"shape": ROOT, "young": 5e6}],
)
FIBRES = {"young_1": 5e6, "young_2": 1e6, "poisson_12": 0.3, "shear_12": 4e5, "angle": 0.5}
SKEW = HALF.replace(  # an oblique rim
    supports=[CLAMP],
    loads=[PointLoad(at=(0.2, 0.1), force=(0.0, 0.0, 0.02))],
    outline=[(0.0, 0.0), (0.12, 0.0), (0.2, 0.1), (0.0, 0.1)],
)
WOVEN = DRAWN.replace(material={"kind": "orthotropic", "density": 1000.0, **FIBRES}, patches=())


def spring_set(scene, grid, **settings):
    cells = lumped.sections_of(scene, grid_of(scene.sheet, grid))
    own = {} if cells is None else {"cells": cells}
    return lumped.calibrate(scene.sheet, scene.material, grid=grid, **own, **settings)


def table(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Habibi et al.'s test 1 on 4 × 4 × 2 masses, edge twist and all."""
    made = tmp_path_factory.mktemp("lattice")
    scene = scenes.load("two-edges-clamped")
    export(made, scene, spring_set(scene, 4, method="consistent"))
    return made


def test_the_tables_hold_what_the_lattice_is(folder):
    scene = scenes.load("two-edges-clamped")
    solution = lumped.solve(scene, spring_set(scene, 4, method="consistent"))
    nodes, links, cells = (table(folder / f"{name}.csv") for name in ("nodes", "links", "cells"))
    assert [*nodes[0]] == ["number", "i", "j", "k", "x", "y", "z", "mass"]
    assert [*links[0]] == ["a", "b", "family", "rest_length", "stiffness", "damping"]
    corners = [f"corner_{n}" for n in (1, 2, 3, 4)]
    assert [*cells[0]][:9] == ["kind", *corners, "rest_area", *(f"stiffness_{n}" for n in (1, 2, 3))]
    assert "0.5 k1 (a/a0 - 1)^2 a0" in [*cells[0]][-1]
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


def test_a_table_of_the_plan_says_what_a_drawn_sheet_is_made_of(tmp_path):
    export(tmp_path, DRAWN, spring_set(DRAWN, (9, 5)))
    nodes, rows = table(tmp_path / "nodes.csv"), table(tmp_path / "plan.csv")
    cell = OBLONG.length_x * OBLONG.length_y / 32
    assert sum(float(row["share"]) for row in rows) * cell == pytest.approx(DRAWN.region.area)
    assert {row["young"] for row in rows if row["patch"] == "1.0"} == {"5000000.0"}
    assert (
        len(rows) < 32 and len(nodes) < 90 and {float(row["poisson"]) for row in rows} == {SILICONE.poisson}
    )
    page = (tmp_path / "README.md").read_text(encoding="utf-8")
    assert "`plan.csv`" in page and "patch 1: rectangle" in page and "left out" in page


def test_matlab_and_numpy_files_hold_the_same(folder):
    arrays, other = dict(np.load(folder / "lattice.npz")), loadmat(folder / "lattice.mat")
    assert set(arrays) == set(NAMES)
    for name, values in arrays.items():
        if values.dtype.kind == "U":
            assert [str(cell[0]) for cell in other[name].ravel()] == values.tolist()
        else:
            np.testing.assert_array_equal(other[name].ravel(), values.ravel(), err_msg=name)
    page = (folder / "README.md").read_text(encoding="utf-8")
    assert all(f"`{name}`" in page for name in NAMES) and "left out" not in page
    assert not any(name in page or (folder / name).exists() for name in ("plan.csv", "natural.csv"))


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("scene", "settings"),
    [
        (HINGED, {"method": "moduli"}),
        (scenes.load("curved-edge"), {"grading": 0.5}),
        (HALF, {"method": "consistent"}),
        (scenes.load("one-edge-clamped"), {"method": "uniform"}),
        *((HALF.replace(material=material), {"method": "hyperelastic"}) for material in RUBBERS),
        (DRAWN, {"grid": (5, 3)}),
        (WOVEN, {"grid": (5, 3)}),
        (SKEW, {"grid": (5, 3)}),
    ],
    ids=["hinged and held", "graded", "half, point and edge loads", "uniform", *LAWS, "cut", "woven", "skew"],
)
def test_numpy_alone_finds_our_displacements(scene, settings):
    lattice = arrays(lumped.describe(scene, spring_set(scene, **{"grid": 3, **settings})))
    assert (lattice["mass"] > 0.0).all()
    assert lattice["coupling_stiffness"].any() == (scene in (WOVEN, SKEW))
    along = NUMPY["differences"](lattice)
    for u, force, energy in zip(
        *(lattice[f"state_{name}"] for name in ("displacement", "force", "energy")), strict=True
    ):
        found, gradient = NUMPY["gradient"](lattice, along, u)
        assert found == pytest.approx(energy, rel=1e-9)  # rounding of lengths: L eps / elongation
        np.testing.assert_allclose(gradient, force, atol=1e-9 * np.abs(force).max())
    if scene.material.law in (None, "gent") and scene is not WOVEN:  # seconds each
        u, truth = NUMPY["equilibrium"](lattice, along, 2), lattice["state_displacement"][-1]
        assert np.abs(u - truth).max() < AGREED * np.abs(truth).max()


def test_an_exported_lattice_carries_the_payload(tmp_path):
    """Its masses, its weight, and the equilibrium that a reader of files alone finds again."""
    scene = scenes.load("two-edges-clamped")
    laden = scene.replace(masses=({"at": (0.17, 0.16), "mass": 0.05},))
    own = spring_set(scene, 3)
    bare, found = (lumped.describe(one, own) for one in (scene, laden))
    assert (found.mass - bare.mass).sum() == pytest.approx(0.05)
    assert (found.dead - bare.dead).sum(axis=0) == pytest.approx([0.0, 0.0, -9.81 * 0.05])
    lattice = arrays(found)
    u, truth = (
        NUMPY["equilibrium"](lattice, NUMPY["differences"](lattice), 2),
        lattice["state_displacement"][-1],
    )
    assert np.abs(u - truth).max() < AGREED * np.abs(truth).max()
    assert np.abs(truth - bare.states[-1].displacement).max() > 0.1 * np.abs(truth).max()
    export(tmp_path, laden, own)
    assert sum(float(row["mass"]) for row in table(tmp_path / "nodes.csv")) == pytest.approx(found.mass.sum())
    with pytest.raises(BadInput, match=r"mass.inertia: an exported lattice has masses alone"):
        lumped.describe(scene.replace(masses=({"at": (0.1, 0.1), "mass": 0.1, "inertia": (1e-6,) * 3},)), own)


def read(folder, capsys):
    """What the reader in NumPy says of a folder, as a program that ends well."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("sys.argv", ["read_lattice.py", str(folder)])
        with pytest.raises(SystemExit) as left:
            runpy.run_path(str(READERS / "read_lattice.py"), run_name="__main__")
    assert not left.value.code
    return capsys.readouterr()


def test_the_numpy_reader_is_a_program(folder, capsys):
    said = read(folder, capsys)
    assert said.out.startswith("forces of 3 states off by")
    assert re.fullmatch(r"(statics of \d+ masses, load in \d+ step\(s\)\n)+", said.err)


@pytest.mark.nightly  # six seconds
def test_the_numpy_reader_takes_as_many_load_steps_as_a_large_rotation_needs():
    """A strip that falls by most of its length: Newton alone ends elsewhere."""
    scene = Scene("strip", Sheet(0.12, 0.04, 0.001), Material(1.5e6, 0.45, 1100.0), GRAVITY, (CLAMP,))
    lattice = arrays(lumped.describe(scene, spring_set(scene, 2)))
    u, truth = NUMPY["equilibrium"](lattice, NUMPY["differences"](lattice)), lattice["state_displacement"][-1]
    assert np.abs(u).max() > 0.1  # of 0.12 m
    assert np.abs(u - truth).max() < AGREED * np.abs(truth).max()


@pytest.fixture(scope="module")
def rubbers(tmp_path_factory):
    """A folder of each law."""
    made = tmp_path_factory.mktemp("rubbers")
    for material in RUBBERS:
        scene = HALF.replace(material=material)
        export(made / str(material.law), scene, spring_set(scene, 3, method="hyperelastic"))
    return list(made.iterdir())


@pytest.mark.skipif(shutil.which("octave") is None, reason="needs Octave: install the Debian package octave")
def test_octave_finds_our_displacements(folder, rubbers):
    for place in (folder, *rubbers):
        command = ["octave", "--quiet", "--no-gui", "--eval", f"read_lattice('{place}', 4)"]
        found = subprocess.run(command, cwd=READERS, capture_output=True, text=True, timeout=120)
        assert found.returncode == 0, found.stderr
        assert "displacements at rest by" in found.stdout


COMPILER = shutil.which("c++") or shutil.which("g++") or shutil.which("clang++")


@pytest.mark.skipif(COMPILER is None, reason="needs a C++ compiler: install the Debian package g++")
def test_cpp_steps_to_our_displacements(folder, rubbers, tmp_path):
    program = tmp_path / "read_lattice"
    source = READERS / "read_lattice.cpp"
    subprocess.run([str(COMPILER), "-O1", "-std=c++17", str(source), "-o", str(program)], check=True)
    others = {"hinged": (HINGED, 3)}
    others |= {name: (scene, (5, 3)) for name, scene in (("cut", DRAWN), ("woven", WOVEN), ("skew", SKEW))}
    for name, (scene, grid) in others.items():
        export(tmp_path / name, scene, spring_set(scene, grid))
    for place in (folder, *(tmp_path / name for name in others), *rubbers):
        found = subprocess.run([str(program), str(place)], capture_output=True, text=True, timeout=120)
        assert found.returncode == 0, found.stdout + found.stderr
    export(tmp_path / "blown", BLOWN, spring_set(BLOWN, 3))
    refused = subprocess.run([str(program), str(tmp_path / "blown")], capture_output=True, text=True)
    assert refused.returncode == 2 and "dead loads only" in refused.stderr


def test_readers_are_short():
    for path in READERS.glob("read_lattice.*"):
        # three kinds of springs, rubber and faces, contact, and a tangent in groups of masses
        assert len(path.read_text(encoding="utf-8").splitlines()) <= 235, path


BLOWN = Scene(
    name="blown",
    sheet=OBLONG,
    material=SILICONE,
    support=(CLAMP,),
    load=(Pressure(value=40.0), EdgeLoad(edge="x1", moment_per_length=0.02, force_per_length=(0, 0, 0))),
)


def test_loads_that_follow_the_sheet_balance_it_as_the_readme_says():
    """At rest, springs, dead loads and the followers by the README's formulas leave the supports alone."""
    lattice = arrays(lumped.describe(BLOWN, spring_set(BLOWN, (4, 4, 3))))
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


def test_what_files_cannot_say_is_refused_or_told(tmp_path, capsys):
    with pytest.raises(BadInput, match="actuators are not springs"):
        scene = scenes.load("actuated-edge")
        lumped.describe(scene, spring_set(scene, 5))
    free = Scene(name="free", sheet=SHEET, material=RUBBER, support=(Hinged(edge="x0"),))
    found = lumped.describe(free, spring_set(free, 3))
    assert [state.name for state in found.states] == ["stretched", "rolled"]
    assert "rotation about edge x0" in found.notes[0]
    said = export(tmp_path, free, spring_set(free, 3))
    assert "no equilibrium to check by" in said
    assert "no equilibrium to check by" in (tmp_path / "README.md").read_text(encoding="utf-8")
    assert read(tmp_path, capsys).out.endswith("the folder has no equilibrium\n")
    with pytest.raises(BadInput, match=r"--export = .*holds files of another 'export'"):
        export(tmp_path, HALF, spring_set(HALF, 3))


def test_verbs_export_the_lattice_that_they_answer_with(tmp_path, capsys):
    sheet = ["--young", "1e6", "--poisson", "0.3", "--thickness", "0.002", "--side", "0.1x0.2"]
    assert run("calibrate", *sheet, "--grid", "3", "--export", str(tmp_path / "a")) == 0
    assert f"loadsin{tmp_path / 'a'}:startatits" in "".join(capsys.readouterr().out.split())
    assert {row["edge"] for row in table(tmp_path / "a" / "supports.csv")} == {"x0"}
    changed = ["--thickness", "0.002", "--grid", "3", "--json", "--export", str(tmp_path / "b")]
    assert run("calibrate", "two-edges-clamped", *changed) == 0
    json.loads(capsys.readouterr().out)
    assert "0.002 m" in (tmp_path / "b" / "README.md").read_text(encoding="utf-8")
    moving = ["--duration", "0.01", "--lumped", "4", "--export", str(tmp_path / "c")]
    assert run("simulate", "two-edges-settling", *moving) == 0
    assert len(table(tmp_path / "c" / "nodes.csv")) == 32
    capsys.readouterr()
    quick = ["--lumped", "3", "--elements", "2", "--no-uncertainty", "--export", str(tmp_path / "e")]
    assert run("compare", "one-edge-clamped", "--calibration", "uniform", *quick) == 0
    assert "calibration uniform" in (tmp_path / "e" / "README.md").read_text(encoding="utf-8")
