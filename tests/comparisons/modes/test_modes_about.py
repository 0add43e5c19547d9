"""Modes about the equilibrium: the heavy string, lattice beside shell, and flat where nothing loads it."""

import json

import numpy as np
import pytest
from cases import sheet
from commands import run

import fem_reference
import lumped
import sheetbench as sb
from sheetbench.errors import BadInput
from sheetbench.scenes import Gravity, Pressure, load


def hanging():
    """A strip of soft silicone, 250 × 120 × 1.5 mm, hanging down from x0."""
    return sheet(0.25, 0.12, 0.0015, 125e3, 0.49, 1070.0, gravity=Gravity(acceleration=(9.81, 0.0, 0.0)))


def test_a_hanging_strip_swings_as_a_heavy_string():
    """f = j/(4π) √(g/L), j = 2.4048 the zero of J0."""
    string = 2.4048 / (4.0 * np.pi) * np.sqrt(9.81 / 0.25)
    shell = fem_reference.modes(hanging(), "shell", 8, 2, "deformed").frequencies
    assert shell[0] == pytest.approx(string, rel=0.02)
    springs = lumped.calibrate(hanging().sheet, hanging().material, (33, 17))
    lattice = lumped.modes(hanging(), springs, 2, about="deformed").frequencies
    assert lattice[0] == pytest.approx(shell[0], rel=0.02)
    assert fem_reference.modes(hanging(), "shell", 8, 1).frequencies[0] < 0.05 * string


def test_what_has_no_modes_is_refused_in_a_line():
    scene = load("two-edges-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, (5, 5))
    pressed = scene.model_copy(update={"loads": (Pressure(value=1.0),)})
    for ask in (
        lambda: lumped.modes(pressed, springs, 2, about="deformed"),
        lambda: fem_reference.modes(pressed, "shell", 2, 2, "deformed"),
        lambda: fem_reference.modes(scene, "plate", 2, 2, "deformed"),
        lambda: sb.modes(scene, count=1, about="sideways"),
    ):
        with pytest.raises(BadInput):
            ask()


def test_the_verb_warns_of_a_sheet_that_is_not_flat(capsys):
    arguments = ["modes", "two-edges-clamped", "--lumped", "5", "--elements", "2", "--count", "1", "--json"]
    for about in ("flat", "deformed"):
        assert run(*arguments, "--about", about) == 0
        said = capsys.readouterr()
        assert ("--about deformed" in said.err) is (about == "flat")
        assert json.loads(said.out)["about"] == about
