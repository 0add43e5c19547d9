"""One rule for grids: a number counts along the shorter side with near-square cells, on every verb."""

import numpy as np
import pytest
from cases import GRAVITY, RUBBER, SHEET
from commands import one_line, run

import lumped
from comparisons.models.grids import parse_grid
from fem_reference.surface.mesh import divisions
from sheetbench.scenes import BadInput, Clamped, Scene, Sheet, SpringTable
from sheetbench.scenes.objects.grid import grid_of, near_square

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
