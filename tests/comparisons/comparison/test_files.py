"""Files that a comparison leaves: VTU that opens elsewhere, tables with units, manifest, picture."""

import json
import subprocess
from dataclasses import replace

import meshio
import numpy as np
import pytest
import pyvista

from comparisons.pictures import offscreen as rendering
from comparisons.sweep.folder import Folder
from sheetbench.scenes import Scene


@pytest.fixture(scope="module")
def folder(compared, tmp_path_factory):
    place = tmp_path_factory.mktemp("out")
    kept = Folder(place, "compare", ["sheetbench", "compare"], about={"scene": compared.scene.document()})
    kept.report(replace(compared.report(), pictures=()))
    assert sorted([*kept.written, "manifest.json"]) == sorted(path.name for path in place.iterdir())
    return place


@pytest.mark.parametrize("fault", [OSError(), subprocess.TimeoutExpired("trial", 120)], ids=["start", "end"])
def test_no_picture_where_the_trial_of_drawing_does_not_start_or_end(fault, monkeypatch):
    def run(*_, **__):
        raise fault

    monkeypatch.setattr(subprocess, "run", run)
    assert "off-screen drawing does not work" in (rendering.why_not.__wrapped__() or "")


def test_common_plan_grid_holds_all_solutions_and_their_difference(folder, compared):
    """In meshio and PyVista alike."""
    read = meshio.read(folder / "comparison.vtu")
    fields = read.point_data
    lumped, shell, uniform = (one.displacement(read.points[:, :2]) for one in compared.solutions)
    assert np.allclose(fields["displacement"], shell) and np.abs(shell).max() > 0.01
    assert np.allclose(fields["displacement_lumped"], lumped)
    assert np.allclose(fields["displacement_shell"], shell)
    assert np.allclose(fields["difference"], lumped - shell)
    assert np.allclose(fields["difference_lumped-uniform"], uniform - shell)
    for name in ("lumped", "shell", "comparison"):
        path = folder / f"{name}.vtu"
        one, other = (reader.read(path).point_data["displacement"] for reader in (meshio, pyvista))
        assert np.isfinite(one).all() and np.allclose(one, other)


def test_manifest_tells_versions_machine_scene_and_settings(folder, compared):
    record = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    assert {"numpy", "scipy", "numba", "scikit-fem", "pyvista", "meshio"} <= set(record["versions"])
    assert record["machine"]["python"] and record["machine"]["cpu_count"] >= 1
    assert record["settings"]["lumped"]["grid"] == [5, 5, 2]
    assert Scene.model_validate(record["scene"]) == compared.scene
    assert record["command"] == ["sheetbench", "compare"] and record["date"]


def test_without_a_way_to_draw_there_is_a_sentence_and_no_picture(compared, tmp_path, monkeypatch):
    monkeypatch.setattr(rendering, "_draws", lambda environment: False)
    rendering.why_not.cache_clear()
    said = compared.figures()[0].write(tmp_path)
    rendering.why_not.cache_clear()
    assert said is not None and "libegl1" in said and not list(tmp_path.iterdir())
