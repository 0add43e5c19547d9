"""What type checkers read of `import sheetbench`: made of the declarations; it finds what is wrong alone."""

import inspect
import re
import subprocess
import sys
from pathlib import Path

import pytest
import stubs

import sheetbench as sb

ROOT = Path(__file__).parents[2]
RIGHT = """\
import numpy as np
import sheetbench as sb
from pathlib import Path

hole = sb.Cutout(sb.Shape(circle=sb.Circle((0.05, 0.05), 0.01)))
scene = sb.Scene("s", sb.Sheet(0.1, 0.1, 0.001), sb.Material(1e6, 0.4, 1000.0), cutouts=(hole,))
both = sb.compare(scene, grid=9)
reveal_type(both)
reveal_type(both.lattice)
reveal_type(both["shell"].label)
reveal_type(sb.compare(Path("a.toml"), duration="0.1 s", lumped=(9, 5)))
reveal_type(sb.sweep("one-edge-clamped", {"sheet.thickness": np.linspace(1e-3, 2e-3, 5)}).to_pandas())
reveal_type(sb.tradeoff(scene, tolerance=0.01))
reveal_type(sb.calibrate(scene, k="5 N/m").springs)
reveal_type(sb.modes(scene, state_space=8))
reveal_type(sb.load("one-edge-clamped").replace(young=2e6))
"""
REVEALED = (
    *("Comparison", "Solution", "str", "MotionComparison", "DataFrame|Any", "Advice"),
    *("SpringSet", "Linearisation", "Scene"),
)
WRONG = {
    'sb.compare(3, grid=9)': "No overload variant",
    'sb.compare("a", gird=9)': "No overload variant",
    'sb.simulate("a", [1])': 'expected "float | str"',
    'sb.sweep("a")': 'Missing positional argument "vary"',
    'sb.compare("a").histories': 'has no attribute "histories"',
    'sb.compare("a", duration=1).lattice_': 'has no attribute "lattice_"',
    'sb.Patch(shap=3)': 'shap',
    'sb.Clamped("x7")': 'x7',
    'sb.compare("a", out=3)': "No overload variant",
    'sb.nosuch': 'has no attribute "nosuch"',
}  # fmt: skip


def test_the_stub_is_that_of_the_declarations():
    """Else `make stubs`."""
    assert stubs.STUB.read_text(encoding="utf-8") == stubs.stub()


@pytest.mark.nightly
def test_a_checker_finds_what_is_wrong_and_nothing_else(tmp_path):
    """In the tree's cache of mypy, which `make check` has filled."""
    wrong = tmp_path / "wrong.py"
    wrong.write_text("\n".join(["import sheetbench as sb", *WRONG]), encoding="utf-8")
    (tmp_path / "right.py").write_text(RIGHT, encoding="utf-8")
    command = [
        sys.executable,
        "-m",
        "mypy",
        "--follow-imports=silent",
        str(tmp_path / "right.py"),
        str(wrong),
    ]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False).stdout
    revealed = re.findall(r'right.py.*Revealed type is "(?:\w+\.)*(\w+)', said)
    assert len(revealed) == len(REVEALED), said
    assert all(re.fullmatch(known, one) for known, one in zip(REVEALED, revealed, strict=True)), revealed
    assert "right.py" not in "".join(line for line in said.splitlines() if "error" in line), said
    for number, words in enumerate(WRONG.values(), start=2):
        lines = [line for line in said.splitlines() if f"wrong.py:{number}: error" in line]
        assert any(words in line for line in lines), (words, said)


def test_signatures_say_what_is_taken():
    taken = inspect.signature(sb.compare).parameters
    assert taken["scene"].annotation == "Scene | str | Path"
    assert taken["grid"].annotation == "int | Sequence[int] | str | None"
    assert taken["progress"].annotation == "Callable[[Any], object] | None"
    assert inspect.signature(sb.simulate).parameters["duration"].annotation == "float | str"
    assert inspect.signature(sb.sweep).parameters["vary"].annotation.startswith("Mapping[str, Any] | ")
