"""Every script of the gallery runs and draws something."""

import runpy
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

pytestmark = pytest.mark.nightly
EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("[0-9][0-9]_*.py"))


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
