"""Imports run one way: sheetbench.scenes → lumped, fem_reference → comparisons.

The two solvers share the question (what a scene's words mean), never the mechanics.
"""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
ALLOWED = {
    "sheetbench/scenes": {"sheetbench.scenes"},
    "lumped": {"sheetbench.scenes", "lumped"},
    "fem_reference": {"sheetbench.scenes", "fem_reference"},
    "comparisons": {"sheetbench.scenes", "lumped", "fem_reference", "comparisons"},
}


PACKAGES = ("sheetbench", "lumped", "fem_reference", "comparisons")


def imported(path: Path) -> set[str]:
    """Our packages that a file imports, `sheetbench.scenes` apart from the face; a literal's name counts,
    but for the name of the plug-ins' entry points."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            names |= {f"{node.module}.{alias.name}" for alias in node.names}
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and "." in node.value:
            names.add(node.value)  # tables of modules that are loaded when asked for
    names.discard("sheetbench.models")
    parts = (name.split(".") for name in names)
    return {
        "sheetbench.scenes" if part[:2] == ["sheetbench", "scenes"] else part[0]
        for part in parts
        if part[0] in PACKAGES
    }


@pytest.mark.parametrize("package", ALLOWED)
def test_imports_run_one_way(package):
    files = sorted((ROOT / package).rglob("*.py"))
    assert files
    for path in files:
        forbidden = imported(path) - ALLOWED[package]
        assert not forbidden, f"{path.relative_to(ROOT)} imports {', '.join(sorted(forbidden))}"


def test_the_reader_sees_every_way_to_import(tmp_path):
    file = tmp_path / "sample.py"
    file.write_text(
        "import lumped.springs.links as s\nfrom comparisons import models\n"
        'from sheetbench import scenes\nM = {"a": "fem_reference.shell.statics"}\n'
    )
    assert imported(file) == {"lumped", "comparisons", "fem_reference", "sheetbench.scenes"}
