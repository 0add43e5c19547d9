"""One rule for grids and one for gradings on every verb, what auto chooses, the error expected of both."""

from dataclasses import replace
from math import prod

import fake_solutions
import numpy as np
import pytest
from cases import GRAVITY, RUBBER, SHEET, sheet
from commands import one_line, run

import lumped
import sheetbench as sb
from comparisons.comparison.comparison import compare
from comparisons.models import expected_error as estimates
from comparisons.models.expected_error import (
    MOST,
    ExpectedError,
    NoEstimate,
    expected_error,
    finer_grid,
    grid_error,
)
from comparisons.models.grading import GRADED, grading_of, parse_grading
from comparisons.models.grids import parse_grid
from comparisons.models.layers import layers
from comparisons.models.spec import Lattice
from fem_reference.surface.mesh import divisions
from fem_reference.verification import strips
from sheetbench.answers.contact import ContactState
from sheetbench.answers.solution import Status
from sheetbench.face import solve
from sheetbench.scenes import BadInput, Chain, Clamped, Plane, Point, Pressure, Scene, Sheet, Sphere, load
from sheetbench.scenes.objects.grading import amount, as_settings, towards
from sheetbench.scenes.objects.grid import grid_of, near_square
from studies.promises.expected import stored
from studies.transfer.scenes import transfer_scenes

LONG = Sheet(length_x=0.2, length_y=0.1, thickness=0.003)
OBLONG = Scene(name="long", sheet=LONG, material=RUBBER, gravity=GRAVITY, support=(Clamped(edge="x0"),))


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
    OBLONG.save(path)
    assert run("calibrate", str(path), "--grid", "9x9", "--toml", "--out", str(out)) == 0
    springs = capsys.readouterr().out
    assert (out / "springs.toml").read_text(encoding="utf-8") == springs
    path.write_text(path.read_text() + springs)
    assert run("modes", str(path), "--lumped", "9") == 2
    said = one_line(capsys)
    assert said.startswith(f"sheetbench: {path}: scene 'long'")
    assert "springs.grid = 9x9x2" in said and "17x9x2" in said and "calibrate --grid 17x9x2" in said


def test_masses_and_grading_of_pasted_springs():
    springs = lumped.calibrate(LONG, RUBBER, 3).springs.replace(grid=(5, 3, 2), masses="gregory")
    assert lumped.given(OBLONG.replace(springs=springs)).masses == "gregory"
    with pytest.raises(BadInput, match=r"grading = 0\.5"):
        lumped.given(OBLONG.replace(springs=springs.replace(grading=0.5)))
    for wrong in ({"grid": (1, 3, 2)}, {"masses": "lumps"}, {"grading": 2.0}):
        with pytest.raises(BadInput, match=next(iter(wrong))):
            springs.replace(**wrong)


def test_automatic_grading_gives_its_reason(capsys):
    """In the tables, beside the other remarks, and in the settings of the document."""
    why = "edge x0, bent by 4 1/m, stretches the sheet within 15.7 mm"
    arguments = ("compare", "curved-edge", "--grid", "3", "--grading", "auto", "--elements", "2")
    assert run(*arguments, "--no-uncertainty", "--verbose") == 0
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
    strip = strips.settling_scene().replace(supports=[Clamped(edge=edge)])
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


# ---- the error of a grid
SCENE = load("two-edges-clamped")


def test_an_error_of_second_order_is_found_exactly():
    u = np.array([[0.0, 0.0, -0.01], [0.001, 0.0, -0.02]])
    answers = [u * (1.0 + 0.03 / cells**2 * 64.0) for cells in (8, 12)]
    value = grid_error(*answers, ratio=2.25, stretch=0.0)
    assert value == pytest.approx(0.03 / (1.0 + 0.03 * 64 / 144), rel=1e-12)


def test_finer_grid_of_the_estimate():
    grids = {(9, 9, 2): (13, 13, 2), (3, 7, 2): (13, 37, 2), (17, 33, 2): (25, 49, 2)}
    assert {grid: finer_grid(grid) for grid in grids} == grids


def test_the_finer_grid_divides_a_chain_finer():
    """Six segments were 12 parts on 9 and on 13 masses: 2.4 times the true error, 0.29 % of 52 elements."""
    rod = dict(edge="x1", segments=6, bending_stiffness=2.9283e-5, line_density=0.027057, radius=1.3204e-3)
    scene = sheet(0.1496, 0.0862, 2.6408e-3, 445158.0, 0.1427, 1188.6, weight=0.0266715)
    scene = scene.replace(
        actuators=(Chain(**rod, curvature=10.901),), probes={"P": (0.1122, 0.0431), "Q": (0.1496, 0.0862)}
    )
    shell = 1e-6 * np.array([[-255.602, 0.0, -6616.799], [-19.175, -400.888, -5345.43]])
    found = compare(scene, Lattice(9, "consistent"), elements=1, uncertainty=False)
    assert isinstance(found.expected, ExpectedError) and found.expected.grid == (24, 14, 2)
    error = np.abs(found.lattice.displacement(scene.probe_points()) - shell).max() / np.abs(shell).max()
    assert 0.5 < found.expected.value / error < 2.0


def answered(**changes):
    settings = {"grid": [9, 9, 2], "calibration": "consistent"} | changes.pop("settings", {})
    return replace(fake_solutions.solution(SCENE, "lumped", -0.01), settings=settings, **changes)


@pytest.mark.parametrize(
    ("changes", "options", "finer"),
    [
        ({"status": Status.UNSTABLE}, {}, {}),
        ({}, {}, {"status": Status.UNSTABLE}),
        ({"snaps": (0.7,)}, {}, {}),
        ({}, {}, {"contacts": {"obstacle 1": ContactState(1e-6, 1e3, 1e-5, 3, 0)}}),  # that the grid missed
        ({}, {"calibration": "uniform"}, {}),
        ({}, {"grid": (9, 9, 3)}, {}),
        ({}, {"grid": (65, 65, 2)}, {}),
        ({}, {"linear": True}, {}),
        ({}, {"layer_distance": 0.004}, {}),
    ],
)
def test_nothing_is_said_where_the_estimate_has_no_ground(changes, options, finer):
    moved = fake_solutions.solution(SCENE, "lumped", -0.0101)

    def answer(candidate):
        assert prod(candidate.settings["grid"][:2]) <= MOST
        return replace(moved, settings=candidate.settings, **finer)

    plain = Lattice(9, "consistent")
    assert isinstance(expected_error(SCENE, plain.but(**options), answered(**changes), answer), NoEstimate)
    assert "too much memory" in str(expected_error(SCENE, plain, answered(), lambda candidate: None))
    assert isinstance(expected_error(SCENE, plain, answered(), lambda candidate: moved), ExpectedError)


@pytest.mark.parametrize(("kind", "area", "silent"), [
    ("sphere", 1e-6, True), ("sphere", 1e-2, False), ("plane", 1e-6, False),
])  # fmt: skip
def test_nothing_is_said_where_a_ball_touches_within_a_cell(kind, area, silent):
    """Of 24 errors of a lattice on a ball 11 were more than twice as large or as small as estimated."""
    body = {"sphere": Sphere(position=(0, 0, -1), radius=0.9), "plane": Plane(position=(0, 0, -1))}[kind]
    scene, touched = SCENE.replace(obstacles=(body,)), {"obstacle 1": ContactState(area, 1e3, 1e-5, 3, 0)}
    moved = replace(fake_solutions.solution(SCENE, "lumped", -0.0101), contacts=touched)
    found = expected_error(scene, Lattice(9, "consistent"), answered(contacts=touched), lambda _: moved)
    assert isinstance(found, NoEstimate if silent else ExpectedError)
    assert not silent or "obstacle 1: touched within a cell of 13 × 13 masses" in str(found)


def test_nothing_is_said_where_points_hold_each_other():
    """Of 30 errors of a lattice on three points 7 were more than twice as large as estimated."""
    moved = fake_solutions.solution(SCENE, "lumped", -0.0101)
    scene = SCENE.replace(supports=tuple(Point(at=at) for at in ((0.0, 0.0), (0.1, 0.0), (0.0, 0.1))))
    found = expected_error(scene, Lattice(9, "consistent"), answered(), lambda _: moved)
    assert "their displacement diverges on finer grids" in str(found)


@pytest.mark.parametrize(
    ("finer", "words"),
    [
        (-0.01, "are equal but for rounding"),
        (0.01, "differ by 200 %, too much to extrapolate from"),
        (-0.010001, "differ by 0.01 %, less than the law of strain may change them at this stretch"),
        (-0.0101, "about 1.8 % (estimated"),  # (0.0001/0.0101)/(1 − 1/2.25)
        (-0.011, "about 16 %: a finer --grid or --grading auto lowers it (estimated"),
    ],
)
def test_the_note_names_the_reason_or_what_lowers_the_error(monkeypatch, finer, words):
    monkeypatch.setattr(estimates, "largest_stretch", lambda *of: 0.01)
    moved = fake_solutions.solution(SCENE, "lumped", finer)
    assert words in str(expected_error(SCENE, Lattice(9, "consistent"), answered(), lambda candidate: moved))


def test_compare_says_it_in_the_norm_of_its_error(compared):
    solutions = compared.report().document["solutions"]
    expected, error = solutions[0]["expected_error"], compared.error(compared.solutions[0])
    assert expected["grid"] == [13, 13, 2] and "13 × 13 masses" in expected["reason"]
    assert error is not None and 0.5 < error / expected["value"] < 2.0
    assert all("expected_error" not in one for one in solutions[1:])
    assert any("expected grid error" in note for note in compared.report().notes)
    assert "no_estimate" not in compared.document()["solutions"][0]
    assert not any("no estimate" in note for note in compared.notes())


@pytest.mark.parametrize("command", [None, -4.0, (0.0, 1.0, -4.0, 2.0, 0.0, 0.0, 0.0)])
def test_a_chain_makes_a_layer_by_the_largest_curvature_it_ends_at(command):
    """The catalogue's is a table that ends at 4 1/m."""
    scene = load("actuated-edge")
    if command is not None:
        scene = scene.replace(actuators=[scene.actuators[0].replace(curvature=command)])
    assert f"bent by {4 if command is None else -4} 1/m" in layers(scene)[0].cause


def test_calibrate_and_compare_expect_one_grid_error(compared):
    estimate = sb.calibrate("two-edges-clamped", grid=5).document()["expected_error"]["value"]
    told = compared.document()["solutions"][0]["expected_error"]["value"]
    assert estimate == pytest.approx(told, rel=1e-9)


def test_loads_in_its_plane_bend_no_flat_sheet():
    """They make no layer at the edges, and `--grading auto` leaves the grid even."""
    pulled, hanging = (stored()[name]["scene"] for name in ("pull-hard", "hanging"))
    assert layers(pulled) == [] == layers(hanging)
    assert grading_of(pulled, (9, 9, 2), Lattice(calibration="consistent", grading="auto"))[0] == 0.0
    both, pressed = stored()["pull-and-weight"]["scene"], pulled.replace(loads=(Pressure(value=3.0),))
    assert len(layers(both)) == len(layers(pressed)) == 1
    assert layers(both) == layers(both.replace(loads=()))


def test_where_none_is_told_the_reason_stands_beside_the_error():
    """Cells wider than the layer in which the weight bends a thin sheet: the table said nothing."""
    found = compare(SCENE.replace(young="0.6 MPa", thickness=0.0005), Lattice(5), elements=4)
    reason = found.document()["solutions"][0]["no_estimate"]
    assert "bends the sheet within a cell" in reason
    assert any(f"no estimate of its grid error: {reason}." in note for note in found.notes())
