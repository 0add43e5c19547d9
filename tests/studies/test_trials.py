"""Results of other codes: files that a pull request brings are read, and what is wrong with one is said."""

from __future__ import annotations

import json
from dataclasses import replace
from zipfile import ZipFile

import pytest

from sheetbench.errors import BadInput
from studies.reference_set.archive import archive
from studies.trials import study
from studies.trials.study import OURS, RESULTS, read_results

FILES = sorted(RESULTS.glob("*.json"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_file_of_results_is_valid(path):
    document = read_results(path)
    assert document["code"] == path.stem and {row["recipe"] for row in document["rows"]} >= {OURS}


@pytest.mark.parametrize(
    "change", [{"date": "yesterday"}, {"rows": []}, {"machine": ""}, {"rows": [{"scene": "moon"}]}]
)
def test_what_is_wrong_with_a_file_of_results_is_said(tmp_path, change):
    document = json.loads(FILES[0].read_text(encoding="utf-8")) | change
    (tmp_path / "x.json").write_text(json.dumps(document))
    with pytest.raises(BadInput, match=r"x\.json"):
        read_results(tmp_path / "x.json")


def test_a_row_without_an_error_is_no_converged_one(tmp_path):
    document = json.loads(FILES[0].read_text(encoding="utf-8"))
    document["rows"][0] |= {"status": "converged", "error": None}
    (tmp_path / "x.json").write_text(json.dumps(document))
    with pytest.raises(BadInput, match="converged without"):
        read_results(tmp_path / "x.json")


def test_rows_with_the_same_inputs_are_not_run_again(tmp_path, monkeypatch):
    """A code that answers with nothing moved: all off by 100 %. Then it is gone, and only a changed recipe
    would need it; one row is left where the budget is none."""
    code = tmp_path / "python"
    probes = {name: [0.0, 0.0, 0.0] for name in study.CASES["thick"].scene.probes}
    answer = json.dumps({"status": "converged", "probes": probes, "solve_seconds": 0.5})
    code.write_text(f"#!/bin/sh\necho '{answer}'\n")
    code.chmod(0o755)
    recipes = [study.Recipe(name, study.ONE, keys=lambda _: {"tri_ke": 1.0}, squares=2) for name in "ab"]
    monkeypatch.setattr(study, "RESULTS", tmp_path)
    monkeypatch.setattr(study, "CASES", {"thick": study.CASES["thick"]})
    monkeypatch.setattr(study, "RECIPES", {"newton": recipes})
    said = []
    study.run_trials("newton", str(code), 1.0, -1.0, said.append)
    assert said == ["newton: -1 s have passed; 2 of 2 rows not looked at"]
    study.run_trials("newton", str(code), 1.0, 1e9, said.append)
    before = (tmp_path / "newton.json").read_text()
    code.write_text("#!/bin/sh\nexit 1\n")
    study.run_trials("newton", str(code), 1.0, 1e9, said.append)
    assert (tmp_path / "newton.json").read_text() == before and before.count('"error": 1.0') == 2
    recipes[1] = replace(recipes[1], squares=3)
    study.run_trials("newton", str(code), 1.0, 1e9, said.append)
    assert [row["status"] for row in read_results(tmp_path / "newton.json")["rows"]] == [
        "converged",
        "failed",
    ]


def test_the_archive_of_the_reference_set_is_the_same_bytes_every_time(tmp_path):
    first, second = (archive(tmp_path / name).read_bytes() for name in ("a.zip", "b.zip"))
    assert first == second
    with ZipFile(tmp_path / "a.zip") as opened:
        names = {name.split("/")[1] for name in opened.namelist()}
    assert {"README.md", "LICENCE.txt", "SHA256SUMS", "suite.json", "cases.csv", "values-modes.csv"} <= names
