"""The error that is expected of a lattice's grid, beside the one that it has."""

from dataclasses import replace
from math import prod

import fake_solutions
import numpy as np
import pytest

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
from comparisons.models.grading import grading_of
from comparisons.models.layers import layers
from comparisons.models.spec import Lattice
from sheetbench.answers.solution import Status
from sheetbench.scenes import Pressure, load
from studies.promises.expected import stored

SCENE = load("two-edges-clamped")


def test_an_error_of_second_order_is_found_exactly():
    u = np.array([[0.0, 0.0, -0.01], [0.001, 0.0, -0.02]])
    answers = [u * (1.0 + 0.03 / cells**2 * 64.0) for cells in (8, 12)]
    value = grid_error(*answers, ratio=2.25, stretch=0.0)
    assert value == pytest.approx(0.03 / (1.0 + 0.03 * 64 / 144), rel=1e-12)


def test_the_finer_grid():
    grids = {(9, 9, 2): (13, 13, 2), (3, 7, 2): (13, 37, 2), (17, 33, 2): (25, 49, 2)}
    assert {grid: finer_grid(grid) for grid in grids} == grids


def answered(**changes):
    settings = {"grid": [9, 9, 2], "calibration": "consistent"} | changes.pop("settings", {})
    return replace(fake_solutions.solution(SCENE, "lumped", -0.01), settings=settings, **changes)


@pytest.mark.parametrize(
    ("changes", "options", "finer"),
    [
        ({"status": Status.UNSTABLE}, {}, {}),
        ({}, {}, {"status": Status.UNSTABLE}),
        ({"snaps": (0.7,)}, {}, {}),
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


@pytest.mark.parametrize(
    ("finer", "words"),
    [
        (-0.01, "are the same but for rounding"),
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


def test_calibrate_says_it_of_a_scene(compared):
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
