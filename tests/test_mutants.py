"""The faults that `make mutants` puts into the solvers, and the tests that it takes for the nearest."""

import ast
import json
from pathlib import Path

import pytest
from mutants.faults import faults
from mutants.nearest import Nearest, words_of
from mutants.reach import Reach

TREE = Path(__file__).parent.parent


@pytest.mark.parametrize(
    ("source", "faulty"),
    [
        ("a < b", ["(a <= b)", "(a >= b)"]),
        ("μ + b", ["(μ - b)"]),
        ("(a + b) * c", ["((a + b) / c)", "((a - b)) * c"]),
        ("a[2]", ["(a[3])", "(a[1])"]),
        ("a = 2.0", ["a = (4.0)"]),
        ("a = 1e-9", []),
        ("a = -b", ["a = (b)"]),
        ("a and b", ["(a or b)"]),
        ("f()", ["pass"]),
        ("a += b", ["a -= b", "pass"]),
        ("c = a if b else d", ["c = a if (not b) else d"]),
        (
            "def f(a: int = 1) -> int | None:\n    '''1'''",
            ["def f(a: int = (2)) -> int | None:\n    '''1'''"],
        ),
        ("raise E(f'{a + 1}')", ["pass"]),
        ("a = f'{b + 1}'", []),
        ("a = f(b, strict=True)", []),
    ],
)
def test_faults_are_single_changes_of_what_runs(source, faulty):
    text = source.encode()
    assert sorted(fault.put_into(text).decode() for fault in faults("a.py", text)) == sorted(faulty)


def test_every_fault_of_a_file_is_python_and_has_a_name_of_its_own():
    path = TREE / "lumped" / "dynamics" / "verlet.py"
    source = path.read_bytes()
    found = faults("verlet.py", source)
    assert len({fault.name for fault in found}) == len(found) > 50
    sound = ast.dump(ast.parse(source))
    for fault in found:
        assert ast.dump(ast.parse(fault.put_into(source))) != sound


def test_names_stay_when_lines_come():
    source = (TREE / "lumped" / "dynamics" / "verlet.py").read_bytes()
    later = faults("verlet.py", b'"""More."""\n\n' + source)
    assert [fault.name for fault in later] == [fault.name for fault in faults("verlet.py", source)]


def test_the_nearest_tests_speak_of_the_module():
    nearest = Nearest(TREE)
    for module, function, test in (
        ("lumped/statics/polygon.py", "", "tests/test_polygon.py"),
        ("lumped/dynamics/verlet.py", "Verlet.advance", "tests/test_dynamics.py"),
        ("fem_reference/solid/element.py", "Bricks.build", "tests/test_solid_element.py"),
    ):
        assert test in nearest.tests(module, words_of(module, function), [])[:2]
    assert "tests/test_cli.py" in nearest.tests("fem_reference/solid/element.py", [], [])


def test_a_compiled_function_is_run_by_what_runs_its_callers(tmp_path):
    (tmp_path / "lumped").mkdir()
    (tmp_path / "lumped" / "links.py").write_text(
        "LIMIT = 3\n@njit\ndef pull(x): return x\n@njit\ndef pulls(x): return pull(x)\n"
        "def forces(x): return pulls(x)\nclass Rod:\n def turn(self): return 1\n"
    )
    (tmp_path / "lumped" / "grid.py").write_text("def even(x): return links.pull(x)\n")
    book = tmp_path / "book"
    runs = {"a": ["lumped/links.py forces"], "b": ["lumped/links.py Rod.turn"], "c": ["lumped/grid.py even"]}
    rows = [{"test": test, "seconds": 1.0, "runs": names} for test, names in runs.items()]
    book.write_text("".join(json.dumps(row) + "\n" for row in rows))
    reach = Reach(tmp_path, book, {})
    for function, tests in (("forces", "a"), ("pull", "a"), ("Rod.turn", "b"), ("Rod", "b"), ("", "ab")):
        assert reach.tests("lumped/links.py", function) == set(tests)
    reach = Reach(tmp_path, book, {"lumped.grid": {"lumped.links"}})
    assert reach.tests("lumped/links.py", "pull") == {"a", "c"}
