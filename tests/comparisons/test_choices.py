"""What the command line offers is what there is: the names, options and defaults of the tables themselves."""

from inspect import signature
from typing import get_args

import pytest

import fem_reference
import lumped
from comparisons.cli.app import verb_group
from sheetbench import choices
from sheetbench.choices import REFERENCES


def test_every_name_is_there_and_described():
    assert list(lumped.CALIBRATIONS) == list(choices.CALIBRATIONS)
    assert set(lumped.INTEGRATORS) == set(choices.INTEGRATORS)
    given, more = get_args(lumped.Inertia)
    assert {*get_args(given), *get_args(more)} == set(choices.MASSES)
    assert list(fem_reference.MODELS) == list(choices.REFERENCES) == list(REFERENCES)
    for name, method in lumped.CALIBRATIONS.items():
        assert vars(choices.CALIBRATIONS[name]).items() <= vars(method).items()
        assert method.fitted == ("targets" in signature(method.make).parameters)


def test_the_usual_choices_are_those_of_the_functions():
    assert signature(lumped.calibrate).parameters["method"].default == choices.CALIBRATION
    assert signature(lumped.simulate).parameters["integrator"].default == choices.INTEGRATOR == choices.AUTO
    assert signature(fem_reference.solve).parameters["model"].default == choices.REFERENCE


NAMES = {
    "calibration": choices.CALIBRATIONS,
    "reference": choices.REFERENCES,
    "masses": choices.MASSES,
    "integrator": choices.INTEGRATORS,
}


@pytest.mark.parametrize("verb", ["compare", "calibrate", "identify", "modes", "simulate", "tradeoff"])
def test_help_names_every_choice(verb):
    known = [(one.help, NAMES[one.name]) for one in verb_group().commands[verb].params if one.name in NAMES]
    assert known and all(name in said for said, names in known for name in names)
