"""The fitted methods on the command line and in `compare`: what they train on, and what is said of them."""

import pytest
from commands import json_of, run

from comparisons.models import training as targets
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench import scenes
from sheetbench.errors import BadInput

SCENE = scenes.load("two-edges-clamped")


def test_training_scenes_are_the_seeds_sheet_held_by_one_and_two_edges():
    one, two = targets.training_scenes(SCENE.sheet, SCENE.material)
    assert [s.edge for s in one.supports] == ["x0"] and [s.edge for s in two.supports] == ["x0", "y0"]
    assert two.gravity == SCENE.gravity


def test_a_fit_is_computed_once():
    fit = resolve(SCENE, Lattice(5, "fit-modal"))
    first = fit.springs
    assert fit.calibrated() is first
    assert first.method == "fit-modal" and first.masses == "gregory"


def test_calibrate_trains_on_the_scene_it_is_given(capsys):
    found = []
    for scene in ("two-edges-clamped", "one-edge-clamped"):
        found.append(json_of(capsys, "calibrate", scene, "--calibration", "fit-static", "--grid", "5"))
    assert found[0]["springs"] != found[1]["springs"]
    assert found[0]["fit"]["residual"] < 0.01
    assert set(found[0]["fit"]["half_widths"]) <= set(found[0]["springs"])


def test_calibrate_shows_what_the_data_tell(capsys):
    sheet = ("--young", "54.5e6", "--poisson", "0.48", "--thickness", "0.003", "--side", "0.188")
    assert run("calibrate", *sheet, "--calibration", "fit-static", "--grid", "5") == 0
    printed = capsys.readouterr().out
    assert "What the data tell of each spring" in printed and "do not see" in printed


def test_a_scene_in_which_nothing_moves_is_nothing_to_train_on():
    still = SCENE.replace(gravity=None)
    with pytest.raises(BadInput, match="nothing moves"):
        resolve(SCENE, Lattice(3, "fit-static")).calibrated([still])
