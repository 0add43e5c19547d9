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
    return [
        "".join(
            output.text
            for output in cell.outputs
            if output.output_type == "stream" and output.name == "stdout"
        )
        for cell in notebook.cells
        if cell.cell_type == "code"
    ]


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_prints_what_it_keeps(path):
    kept, now = nbformat.read(path, as_version=4), executed(path)
    assert printed(kept) == printed(now)
    counts = [cell.execution_count for cell in kept.cells if cell.cell_type == "code"]
    assert counts == list(range(1, len(counts) + 1))
    drawn = [
        output
        for cell in kept.cells
        for output in cell.get("outputs", ())
        if "image/png" in output.get("data", {})
    ]
    assert drawn


def test_there_are_notebooks():
    assert len(NOTEBOOKS) >= 2
