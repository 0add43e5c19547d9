"""Files that a comparison leaves: VTU that opens elsewhere, tables with units, manifest, picture."""

import json
import subprocess
from dataclasses import replace

import fake_solutions
import meshio
import numpy as np
import pytest
import pyvista

from comparisons.comparison.answer import Comparison
from comparisons.comparison.comparison import compare
from comparisons.models.spec import Lattice
from comparisons.pictures import offscreen as rendering
from comparisons.sweep.folder import Folder
from sheetbench import scenes
from sheetbench.scenes import Scene


@pytest.fixture(scope="module")
def scene():
    return scenes.load("two-edges-clamped")


@pytest.fixture(scope="module")
def comparison(scene):
    return compare(scene, Lattice((5, 5, 2)), elements=4)


@pytest.fixture(scope="module")
def folder(comparison, tmp_path_factory):
    place = tmp_path_factory.mktemp("out")
    about = {"scene": comparison.scene.model_dump(mode="json", by_alias=True, exclude_none=True)}
    kept = Folder(place, "compare", ["sheetbench", "compare"], about=about)
    kept.report(replace(comparison.report(), pictures=()))
    assert sorted([*kept.written, "manifest.json"]) == sorted(path.name for path in place.iterdir())
    return place


@pytest.mark.parametrize("fault", [OSError(), subprocess.TimeoutExpired("trial", 120)], ids=["start", "end"])
def test_no_picture_where_the_trial_of_drawing_does_not_start_or_end(fault, monkeypatch):
    def run(*_, **__):
        raise fault

    monkeypatch.setattr(subprocess, "run", run)
    assert "off-screen drawing does not work" in (rendering.why_not.__wrapped__() or "")


def test_common_plan_grid_holds_all_solutions_and_their_difference(folder, comparison):
    fields = meshio.read(folder / "comparison.vtu").point_data
    points = meshio.read(folder / "comparison.vtu").points[:, :2]
    lumped, shell, uniform = (solution.displacement(points) for solution in comparison.solutions)
    assert np.allclose(fields["displacement"], shell) and np.abs(shell).max() > 0.01
    assert np.allclose(fields["displacement_lumped"], lumped)
    assert np.allclose(fields["displacement_shell"], shell)
    assert np.allclose(fields["difference"], lumped - shell)
    assert np.allclose(fields["difference_lumped-uniform"], uniform - shell)


def test_manifest_tells_versions_machine_scene_and_settings(folder, scene):
    record = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    assert {"numpy", "scipy", "numba", "scikit-fem", "pyvista", "meshio"} <= set(record["versions"])
    assert record["machine"]["python"] and record["machine"]["cpu_count"] >= 1
    assert record["settings"]["lumped"]["grid"] == [5, 5, 2]
    assert Scene.model_validate(record["scene"]) == scene
    assert record["command"] == ["sheetbench", "compare"]
    assert record["date"]


def draw(comparison, folder):
    return comparison.figures()[0].write(folder)


def test_without_a_way_to_draw_there_is_a_sentence_and_no_picture(scene, tmp_path, monkeypatch):
    monkeypatch.setattr(rendering, "_draws", lambda environment: False)
    rendering.why_not.cache_clear()
    both = Comparison(
        scene, (fake_solutions.solution(scene), fake_solutions.solution(scene, "shell", -0.011))
    )
    said = draw(both, tmp_path)
    rendering.why_not.cache_clear()
    assert said is not None and "libegl1" in said
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["lumped", "shell", "comparison"])
def test_vtu_opens_in_meshio_and_pyvista_alike(folder, name):
    points = meshio.read(folder / f"{name}.vtu").point_data["displacement"]
    assert np.isfinite(points).all()
    assert np.allclose(pyvista.read(folder / f"{name}.vtu").point_data["displacement"], points)
