"""Scripts beside the packages: gallery, notebooks, docstrings, and what benchmarks hold ours against."""

import doctest
import importlib
import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import nbformat
import numpy as np
import pytest

DOCS = Path(__file__).parent.parent / "docs"
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))
EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("[0-9][0-9]_*.py"))


@pytest.mark.nightly
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs_and_draws(path, monkeypatch):
    assert len(EXAMPLES) >= 8
    pyvista = pytest.importorskip("pyvista")
    shown: list[int] = []
    monkeypatch.setattr(plt, "show", lambda: shown.extend(plt.get_fignums()))
    monkeypatch.setattr(pyvista.Plotter, "show", lambda plotter: shown.append(len(plotter.actors)))
    plt.close("all")
    runpy.run_path(str(path), run_name="__main__")
    plt.close("all")
    assert shown and all(shown)


BENCHMARKS = Path(__file__).parent.parent / "benchmarks"


def test_scipy_is_given_the_lattices_own_jacobian(monkeypatch):
    """Against central differences of the right-hand side, in a bent state at rest."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    system, rate, jacobian = runpy.run_path(str(BENCHMARKS / "settling.py"))["equations"]()
    n, rng, h = system.reduced_mass.shape[0], np.random.default_rng(3), 1e-8
    y, along = np.zeros(2 * n), rng.standard_normal(2 * n)
    y[:n] = 1e-4 * rng.standard_normal(n)
    slope = (rate(0.1, y + h * along) - rate(0.1, y - h * along)) / (2 * h)
    exact = jacobian(0.1, y) @ along
    np.testing.assert_allclose(slope, exact, atol=1e-5 * np.abs(exact).max())


def printed(notebook):
    """What every cell with code prints."""
    cells = [cell.outputs for cell in notebook.cells if cell.cell_type == "code"]
    return ["".join(one.text for one in outputs if one.get("name") == "stdout") for outputs in cells]


@pytest.mark.nightly
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_prints_what_it_keeps(path):
    assert len(NOTEBOOKS) >= 2
    executed = runpy.run_path(str(DOCS / "run_notebooks.py"))["executed"]
    kept, now = nbformat.read(path, as_version=4), executed(path)
    assert printed(kept) == printed(now)
    counts = [cell.execution_count for cell in kept.cells if cell.cell_type == "code"]
    assert counts == list(range(1, len(counts) + 1))
    outputs = [output for cell in kept.cells for output in cell.get("outputs", ())]
    assert any("image/png" in output.get("data", {}) for output in outputs)


MODULES = [
    "fem_reference",
    "fem_reference.linear_buckling",
    "fem_reference.vibration",
    "lumped.dynamics.runs.simulation",
    "lumped.fitting.methods",
    "lumped.statics.buckling",
    "lumped.statics.solver",
    "lumped.vibration",
    "sheetbench.numerics.eigenmodes",
    "sheetbench.numerics.cache",
    "sheetbench.numerics.stability",
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_run_as_written(name):
    found = doctest.testmod(importlib.import_module(name))
    assert found.attempted > 0 and found.failed == 0
