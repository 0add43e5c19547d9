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


def test_tests_beside_the_module_come_before_those_that_speak_of_its_folder():
    nearest = Nearest(Path(__file__).parent.parent)

    def of(module):
        return nearest.tests(module, words_of(module, ""))

    for module in (
        "lumped/dynamics/implicit/midpoint.py",
        "lumped/dynamics/system.py",
        "lumped/statics/validity.py",
    ):
        folder = "/".join(module.split("/")[:2])
        assert sum(test.startswith(f"tests/{folder}/") for test in of(module)[:4]) >= 3, of(module)[:4]
    assert "tests/lumped/actuators/test_division.py" in of("lumped/actuators/division.py")[:2]
    assert of("comparisons/sweep/store.py")[0].startswith("tests/comparisons/sweep/")
