"""An exit status, words and numbers as documented, and no file but where it was requested.

A few hundred examples, the same ones every time; `make fuzz` draws 24 000 others (`fuzz.long`).
"""

import pytest
from fuzz import trials
from fuzz.grammar import command_lines, measured, shaped, sound, texts
from hypothesis import HealthCheck, Phase, given, settings

pytestmark = pytest.mark.smoke


def tries(examples):
    """So many examples, the same ones every time."""
    return settings(
        max_examples=examples,
        derandomize=True,
        database=None,
        print_blob=True,
        deadline=None,
        suppress_health_check=list(HealthCheck),
        phases=(Phase.explicit, Phase.generate),
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


@tries(200)
@given(text=texts())
def test_a_scenes_file_is_read_or_refused_in_a_line(folder, text):
    trials.reads(folder, text)


@tries(10)
@given(text=texts())
def test_a_scene_is_checked_and_written_only_where_asked(folder, text):
    place = folder / "check"
    place.mkdir(exist_ok=True)
    trials.checks(place, text)


@tries(20)
@given(data=sound())
def test_a_sound_scene_is_solved_and_what_converges_is_in_balance(folder, data):
    trials.compares(folder, data)


@tries(40)
@given(data=shaped())
def test_a_scene_of_shapes_is_refused_or_solved_in_balance(folder, data):
    trials.solves_shapes(folder, data)


@tries(20)
@given(arguments=command_lines())
def test_a_command_line_is_obeyed_or_refused(folder, arguments):
    place = folder / "commands"
    place.mkdir(exist_ok=True)
    trials.obeys(place, arguments)


@tries(20)
@given(example=measured())
def test_a_measured_file_is_read_or_refused(folder, example):
    trials.measures(folder, example)
