"""The documentation's notebooks run, and what they keep is of the cells that they have."""

import sys
from pathlib import Path

import nbformat
import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "docs"))
from run_notebooks import NOTEBOOKS, executed

pytestmark = pytest.mark.nightly


def printed(notebook):
    """What every cell with code prints."""
    cells = [cell.outputs for cell in notebook.cells if cell.cell_type == "code"]
    return ["".join(one.text for one in outputs if one.get("name") == "stdout") for outputs in cells]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_prints_what_it_keeps(path):
    assert len(NOTEBOOKS) >= 2
    kept, now = nbformat.read(path, as_version=4), executed(path)
    assert printed(kept) == printed(now)
    counts = [cell.execution_count for cell in kept.cells if cell.cell_type == "code"]
    assert counts == list(range(1, len(counts) + 1))
    outputs = [output for cell in kept.cells for output in cell.get("outputs", ())]
    assert any("image/png" in output.get("data", {}) for output in outputs)
