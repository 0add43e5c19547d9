"""Codes: files of results as pull requests bring them, trials that go on where they stopped, ladders."""

import json
from dataclasses import replace

import pytest

from comparisons.models.spec import Lattice
from sheetbench.errors import BadInput
from studies.codes import models, results, trials
from studies.codes.answer import codes
from studies.codes.results import RESULTS, read_results

FILES = sorted(RESULTS.glob("*.json"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_file_of_results_is_valid(path):
    assert read_results(path).code == path.stem


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"date": "yesterday"}, "yesterday"),
        ({"rows": []}, "not to be empty"),
        ({"machine": ""}, "not to be empty"),
        ({"rows": [{"scene": "moon"}]}, "missing"),
        ({"status": "converged", "error": None}, "converged without"),
    ],
)
def test_what_is_wrong_with_a_file_of_results_is_said(tmp_path, change, message):
    document = json.loads(FILES[0].read_text(encoding="utf-8"))
    (document["rows"][0] if "status" in change else document).update(change)
    (tmp_path / "x.json").write_text(json.dumps(document))
    with pytest.raises(BadInput, match=rf"x\.json.*{message}"):
        read_results(tmp_path / "x.json")


def test_stored_rows_have_the_published_numbers():
    """Of docs/codes.md's findings: in use and ours on the cantilever and test 1, the mean of all."""
    rows = {(one.code.split()[0], one.scene): one for one in codes().least_errors()}
    mujoco = rows["MuJoCo", "one-edge-clamped"]
    assert (mujoco.in_use, mujoco.ours) == pytest.approx((0.316, 0.014), abs=1e-3)
    assert rows["MuJoCo", "mean of 13 statics"].nearer == pytest.approx(10.7, abs=0.1)


def test_a_ladder_is_measured_against_the_reference_set(tmp_path, monkeypatch):
    monkeypatch.setattr(results, "RESULTS", tmp_path)
    monkeypatch.setitem(models.SIZES, "lattice", models.Sizes("lattice", "MIT", (Lattice(3), Lattice(5))))
    models.measure_sizes("lattice", lambda _: None)
    rows = read_results(tmp_path / "lattice.json").rows
    assert [row.recipe for row in rows] == ["3 × 3", "5 × 5"]
    assert rows[0].error > rows[1].error > 0.0 < rows[0].seconds


def test_rows_with_the_same_inputs_are_not_run_again(tmp_path, monkeypatch):
    """A code that answers with nothing moved: all off by 100 %."""
    code = tmp_path / "python"
    probes = {name: [0.0, 0.0, 0.0] for name in results.CASES["thick"].scene.probes}
    answer = json.dumps({"status": "converged", "probes": probes, "solve_seconds": 0.5})
    code.write_text(f"#!/bin/sh\necho '{answer}'\n")
    code.chmod(0o755)
    recipes = [trials.Recipe(name, trials.ONE, keys=lambda _: {"tri_ke": 1.0}, squares=2) for name in "ab"]
    for module in (trials, results):
        monkeypatch.setattr(module, "RESULTS", tmp_path)
    monkeypatch.setattr("comparisons.codes.setup.limit_errors", lambda _: lambda _: 0.0)
    monkeypatch.setattr(trials, "CALIBRATED", {"thick": results.CASES["thick"]})
    monkeypatch.setattr(trials, "RECIPES", {"newton": recipes})
    said = []
    trials.run_trials("newton", str(code), 1.0, -1.0, said.append)
    assert said == ["newton: -1 s have passed; 2 of 2 rows not checked"]
    trials.run_trials("newton", str(code), 1.0, 1e9, said.append)
    before = (tmp_path / "newton.json").read_text()
    code.write_text("#!/bin/sh\nexit 1\n")
    trials.run_trials("newton", str(code), 1.0, 1e9, said.append)
    assert (tmp_path / "newton.json").read_text() == before and before.count('"error": 1.0') == 2
    recipes[1] = replace(recipes[1], squares=3)
    trials.run_trials("newton", str(code), 1.0, 1e9, said.append)
    assert [row.status for row in read_results(tmp_path / "newton.json").rows] == ["converged", "failed"]
