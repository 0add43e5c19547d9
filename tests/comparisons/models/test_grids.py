"""One rule for grids and one for gradings on every verb; what is chosen where a grading is auto."""

import numpy as np
import pytest
from cases import GRAVITY, RUBBER, SHEET
from commands import one_line, run

import lumped
import sheetbench as sb
from comparisons.models.grading import GRADED, grading_of, parse_grading
from comparisons.models.grids import parse_grid
from comparisons.models.spec import Lattice
from fem_reference.surface.mesh import divisions
from fem_reference.verification import settling_strip
from sheetbench.face import solve
from sheetbench.scenes import BadInput, Clamped, Scene, Sheet, SpringTable, load
from sheetbench.scenes.objects.grading import amount, as_settings, towards
from sheetbench.scenes.objects.grid import grid_of, near_square
from studies.transfer.scenes import transfer_scenes

LONG = Sheet(length_x=0.2, length_y=0.1, thickness=0.003)
SCENE = Scene(name="long", sheet=LONG, material=RUBBER, gravity=GRAVITY, support=(Clamped(edge="x0"),))


def test_elements_and_cells_are_divided_by_one_rule():
    """Also where the longer side is as near to one number as to the next: to the even one, at any scale."""
    for length, count, along in ((0.19, 5, 10), (0.27, 15, 40), (0.35, 25, 88)):
        for scale in (1.0, 0.3, 7.0):
            sheet = Sheet(length_x=scale * length, length_y=scale * 0.1, thickness=0.003)
            assert divisions(sheet, count) == near_square(sheet, count) == (along, count)
    assert divisions(LONG, (3, 2)) == (3, 2)


def test_a_number_counts_along_the_shorter_side():
    assert grid_of(SHEET) == (9, 9, 2)
    assert grid_of(LONG) == grid_of(LONG, 9) == grid_of(LONG, np.int64(9)) == (17, 9, 2)
    assert grid_of(Sheet(length_x=0.1, length_y=0.3, thickness=0.003)) == (9, 25, 2)
    assert grid_of(LONG, (9, 9)) == (9, 9, 2) and grid_of(LONG, [9, 5, 3]) == (9, 5, 3)
    assert near_square(Sheet(length_x=0.3, length_y=0.1, thickness=0.003), 16) == (48, 16)
    for wrong in (1, (9, 1), (9, 9, 1), (9.0, 9.0), "9", (), (9, 9, 2, 2), 10**30):
        with pytest.raises(BadInput, match="grid = "):
            grid_of(LONG, wrong)


def test_grids_are_read_as_people_write_them():
    assert parse_grid(LONG, "9") == (17, 9, 2)
    assert parse_grid(LONG, "9x13") == (9, 13, 2)
    assert parse_grid(LONG, "5×7×3") == (5, 7, 3)
    for text in ("", "9x", "1", "9x9x1", "3.5", "9x9x2x2", "-4"):
        with pytest.raises(BadInput, match=r"--lumped = .*--grid"):
            parse_grid(LONG, text)


def test_springs_of_another_grid_are_refused(tmp_path, capsys):
    """Pasted as `calibrate --toml` prints and writes them."""
    path, out = tmp_path / "long.toml", tmp_path / "out"
    SCENE.save(path)
    assert run("calibrate", str(path), "--grid", "9x9", "--toml", "--out", str(out)) == 0
    springs = capsys.readouterr().out
    assert (out / "springs.toml").read_text(encoding="utf-8") == springs
    path.write_text(path.read_text() + springs)
    assert run("modes", str(path), "--lumped", "9") == 2
    said = one_line(capsys)
    assert said.startswith(f"sheetbench: {path}: scene 'long'")
    assert "springs.grid = 9x9x2" in said and "17x9x2" in said and "calibrate --grid 17x9x2" in said


def test_masses_and_grading_of_pasted_springs():
    springs = lumped.calibrate(LONG, RUBBER, 3).springs.model_dump()
    table = {**springs, "grid": (5, 3, 2), "masses": "gregory"}
    scene = SCENE.model_copy(update={"springs": SpringTable(**table)})
    assert lumped.given(scene).masses == "gregory"
    graded = SCENE.model_copy(update={"springs": SpringTable(**table, grading=0.5)})
    with pytest.raises(BadInput, match=r"grading = 0\.5"):
        lumped.given(graded)
    for wrong in ({"grid": (1, 3, 2)}, {"masses": "lumps"}, {"grading": 2.0}):
        with pytest.raises(BadInput, match=next(iter(wrong))):
            SpringTable(**{**table, **wrong})


def test_auto_says_why(capsys):
    """In the tables, beside the other remarks, and in the settings of the document."""
    why = "edge x0, bent by 4 1/m, stretches the sheet within 15.7 mm"
    arguments = ("compare", "curved-edge", "--grid", "3", "--grading", "auto", "--elements", "2")
    assert run(*arguments, "--no-uncertainty") == 0
    assert f"grading 0.3: {why}" in " ".join(capsys.readouterr().out.split())
    document = sb.simulate("curved-edge", grid=3, grading="auto", duration=1e-3).document()
    assert document["settings"]["grading"] == 0.3 and document["settings"]["grading_reason"].startswith(why)


AUTO = Lattice(grading="auto")
GRADED_SCENES = (
    "curved-edge", "curved-edge-down", "half-thickness", "tenth-of-young", "tenth-of-young-one-edge",
    "pressure",
)  # fmt: skip


def test_auto_grades_the_scenes_that_grading_mends():
    """Of the transfer study's seventeen: on nine masses a side the others lose by it."""
    for name, scene in transfer_scenes().items():
        value, why = grading_of(scene, (9, 9, 2), AUTO)
        by = 0.5 if name == "tenth-of-young-one-edge" else GRADED
        assert amount(value) == (by if name in GRADED_SCENES else 0.0), (name, why)
        assert why


@pytest.mark.parametrize(("edge", "graded"), [("x0", True), ("y0", False)])
def test_a_sheet_that_juts_out_far_is_graded_at_its_clamp(edge, graded):
    """The layer of 72 mm beside the length of 180 mm that juts out, not beside the width."""
    strip = settling_strip.scene().replace(supports=[Clamped(edge=edge)])
    assert (grading_of(strip, (33, 17, 2), AUTO)[0] == towards(0.5, ["x0"])) == graded


def test_auto_leaves_alone_what_the_cells_resolve_and_what_has_cells_of_one_size_only():
    curved = load("curved-edge")
    assert grading_of(curved, (9, 9, 2), AUTO)[0] == 0.3
    value, why = grading_of(curved, (513, 513, 2), AUTO)
    assert value == 0.0 and "cells of 0.367 mm" in why
    for settings in ({"calibration": "uniform"}, {"k": 500.0}, {"layer_distance": 0.003}):
        assert grading_of(curved, (9, 9, 2), Lattice(grading="auto", **settings))[0] == 0.0
    assert grading_of(curved, (9, 9, 3), AUTO)[0] == 0.0
    weightless = curved.replace(supports=[{"edge": "x0", "kind": "clamped"}], gravity=None)
    why = "nothing bends the sheet, so that it has no layers at its edges"
    assert grading_of(weightless, (9, 9, 2), AUTO) == (0.0, why)
    assert [parse_grading(text) for text in (None, "auto", "0.25", 1)] == [None, "auto", 0.25, 1.0]
    with pytest.raises(BadInput, match=r"grading = 0.5: the calibration uniform is for cells of one size"):
        solve(curved, "lumped", grid=3, calibration="uniform", grading=0.5)


@pytest.mark.parametrize("text", ["0.7", "0.6:x0"])
def test_a_scene_file_brings_its_grading(text, tmp_path, capsys):
    """As `calibrate --toml --grading` writes it: solved so without an option, and not otherwise."""
    path, grading = tmp_path / "own.toml", parse_grading(text)
    load("one-edge-clamped").save(path)
    springs = ("--grid", "5", "--grading", text)
    assert run("calibrate", str(path), *springs, "--calibration", "consistent", "--toml") == 0
    with path.open("a") as file:
        file.write(capsys.readouterr().out)
    scene = load(path)
    own = lumped.calibrate(scene.sheet, scene.material, 5, "consistent", grading=grading)
    points = scene.probe_points()
    for settings in ({}, {"grading": text}, {"grading": "auto"}):
        found = solve(scene, "lumped", **settings)
        assert as_settings(grading).items() <= found.settings.items()
        assert np.array_equal(found.displacement(points), lumped.solve(scene, own).displacement(points))
    for other in ("0.5", "0"):
        assert run("compare", str(path), "--grading", other) == 2
        assert f"springs.grading = {text}" in one_line(capsys)
