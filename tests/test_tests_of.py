"""The files of tests that `make tests-of` names for a module."""

from pathlib import Path

from nearest import Nearest, words_of


def test_the_nearest_tests_speak_of_the_module():
    nearest = Nearest(Path(__file__).parent.parent)
    for module, function, test in (
        ("lumped/actuators/division.py", "", "tests/lumped/actuators/test_division.py"),
        ("lumped/dynamics/explicit/verlet.py", "Verlet.advance", "tests/lumped/dynamics/test_dynamics.py"),
        ("fem_reference/solid/element.py", "Bricks.build", "tests/fem_reference/solid/test_solid_element.py"),
    ):
        assert test in nearest.tests(module, words_of(module, function))[:2]
    assert "tests/comparisons/cli/test_cli.py" in nearest.tests("fem_reference/solid/element.py", [])
