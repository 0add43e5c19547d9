"""Imports run one way: scenes → lumped, fem_reference → comparisons; the two solvers share nothing."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
ALLOWED = {
    "scenes": {"scenes"},
    "lumped": {"scenes", "lumped"},
    "fem_reference": {"scenes", "fem_reference"},
    "comparisons": {"scenes", "lumped", "fem_reference", "comparisons"},
}


def imported(path: Path) -> set[str]:
    """Top-level names that a file imports, also by importlib.import_module and __import__ of a literal."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{path}: relative import"
            names.add((node.module or "").split(".")[0])
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            head = node.value.split(".")[0]  # tables of modules that are loaded when asked for
            if head in ALLOWED and node.value.replace(".", "").isidentifier() and "." in node.value:
                names.add(head)
    return names


@pytest.mark.parametrize("package", ALLOWED)
def test_imports_run_one_way(package):
    files = sorted((ROOT / package).rglob("*.py"))
    assert files
    for path in files:
        forbidden = (imported(path) & set(ALLOWED)) - ALLOWED[package]
        assert not forbidden, f"{path.relative_to(ROOT)} imports {', '.join(sorted(forbidden))}"


def test_the_reader_sees_every_way_to_import(tmp_path):
    file = tmp_path / "sample.py"
    file.write_text(
        'import lumped.springs as s\nfrom comparisons import models\nM = {"a": "fem_reference.shell"}\n'
    )
    assert imported(file) == {"lumped", "comparisons", "fem_reference"}
