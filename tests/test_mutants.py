"""The faults that `make mutants` puts into the solvers, and the tests that it takes for the nearest."""

import ast
import sys
from contextlib import nullcontext
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "mutants"))
from faults import faults  # its files are run, not imported
from nearest import Nearest, words_of
from page import interval, line
from session import Draw, Session, drawn

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
    path = TREE / "lumped" / "dynamics" / "explicit" / "verlet.py"
    source = path.read_bytes()
    found = faults("verlet.py", source)
    assert len({fault.name for fault in found}) == len(found) > 50
    sound = ast.dump(ast.parse(source))
    for fault in found:
        assert ast.dump(ast.parse(fault.put_into(source))) != sound


def test_names_stay_when_lines_come():
    source = (TREE / "lumped" / "dynamics" / "explicit" / "verlet.py").read_bytes()
    later = faults("verlet.py", b'"""More."""\n\n' + source)
    assert [fault.name for fault in later] == [fault.name for fault in faults("verlet.py", source)]


def test_the_nearest_tests_speak_of_the_module():
    nearest = Nearest(TREE)
    for module, function, test in (
        ("lumped/statics/polygon.py", "", "tests/lumped/statics/test_polygon.py"),
        ("lumped/dynamics/explicit/verlet.py", "Verlet.advance", "tests/lumped/dynamics/test_dynamics.py"),
        ("fem_reference/solid/element.py", "Bricks.build", "tests/fem_reference/solid/test_solid_element.py"),
    ):
        assert test in nearest.tests(module, words_of(module, function))[:2]
    assert "tests/comparisons/cli/test_cli.py" in nearest.tests("fem_reference/solid/element.py", [])


def test_noticed_is_what_a_test_of_the_first_commit_notices():
    def trial(fault: str, commit: str, failed: str | None) -> dict[str, str | None]:
        return {"draw": "others", "fault": f"lumped/a.py f: {fault}", "commit": commit, "failed": failed}

    rows = [
        [trial("1 → 2", "a", "t")],
        [trial("2 → 3", "a", None), trial("2 → 3", "a", "t")],
        [trial("3 → 4", "a", None), trial("3 → 4", "b", "t")],
        [trial("4 → 5", "a", None), trial("4 → 5", "b", None)],
        [trial("5 → 6", "a", None)],
    ]
    tried, reasons = {trials[0]["fault"]: trials for trials in rows}, {"lumped/a.py f: 4 → 5": "As right."}
    shares = f"{interval(2, 4)} | {interval(3, 4)}"
    assert line("|", tried, reasons, "others", "lumped/") == f"| 5 | 2 | 1 | 1 | 1 | {shares} |\n"
    assert line("|", tried, reasons, "kernels") == "| 0 | 0 | 0 | 0 | 0 | – | – |\n"
    assert interval(2, 4) == "50 % (15 to 85)"


def test_faults_are_drawn_in_shares_the_packages_mixed(tmp_path):
    for name, text in (
        ("lumped/a.py", "a = 2 * b"),
        ("comparisons/b.py", "c = 3 * d + 4 < e"),
        ("lumped/c.py", "@njit"),
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text + "\ndef f(x): return x + 5\n")
    found = drawn(tmp_path, Draw(7, {"lumped": 2, "comparisons": 4}, kernels=False))
    names = [fault.name for fault in found]
    assert [name.split(" ")[0] for name in names] == [
        *("comparisons/b.py", "lumped/a.py", "comparisons/b.py")
    ] * 2
    assert len(set(names)) == 6
    assert names != [f.name for f in drawn(tmp_path, Draw(8, {"lumped": 2, "comparisons": 4}, kernels=False))]
    kernels = drawn(tmp_path, Draw(7, {"lumped": 9, "comparisons": 9}, kernels=True))
    assert {fault.module for fault in kernels} == {"lumped/c.py"}


def test_a_test_that_fails_anyway_is_passed_over(tmp_path, monkeypatch):
    trial = Session.__new__(Session)
    trial._sound, trial.cache = {}, tmp_path
    trial.faulty = lambda fault: nullcontext()
    asked = []

    def verdict(files, words, skipped, most, cache, compiled):
        asked.append((tuple(files), tuple(skipped)))
        return ("unsound" if files == ["a"] and not skipped else "b::t" if files == ["b"] else None), 1.0

    trial.verdict = verdict
    fault = faults("lumped/a.py", b"a < b")[0]
    monkeypatch.setattr(
        Session, "is_sound", lambda self, test, way: self._sound.setdefault((test, way), "b" in test)
    )
    found = trial.first_to_notice(fault, [["a"], ["b"], ["c"]], 9.0, tmp_path, True)
    assert found == ("b::t", 3.0, {"a", "b"})
    assert asked == [(("a",), ()), (("a",), ("unsound",)), (("b",), ("unsound",))]
