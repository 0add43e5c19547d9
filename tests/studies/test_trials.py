"""Trials of other codes go on where they stopped; the archive of the reference set."""

from __future__ import annotations

import json
from dataclasses import replace
from zipfile import ZipFile

from studies.reference_set.archive import archive
from studies.trials import study
from studies.trials.study import read_results


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
