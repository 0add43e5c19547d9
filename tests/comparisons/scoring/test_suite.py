"""The reference set: frozen, complete, and what the codes of today still find."""

import csv
import json
from hashlib import sha256

import numpy as np
import pytest
from commands import json_of

import fem_reference
from comparisons.scoring.answers import read_answers
from comparisons.scoring.reference import FILE, VERSION, document, references
from sheetbench import scenes
from sheetbench.choices import SUITES
from sheetbench.errors import BadInput

FROZEN = {  # of scenes and values, by the version that they are from
    ("statics", "motion", "modes"): "15198e1a28208c6d",  # 2.0
    ("curves",): "bfd47df4914f80ff",  # 2.1
    ("natural", "contact"): "4f2d9024223f2472",  # 2.2
}


def values_digest(suites):
    """Of scenes and values alone: titles, measured times and the machine may change."""
    kept = [
        {key: case[key] for key in ("name", "scene", "probes", "frequencies_hz", "time") if key in case}
        for case in document()["cases"]
        if case["suite"] in suites
    ]
    for case in kept:
        case["scene"] = {**case["scene"], "title": ""}
    return sha256(json.dumps(kept, sort_keys=True).encode()).hexdigest()[:16]


def test_a_published_version_does_not_change():
    assert document()["version"] == VERSION
    assert {suites: values_digest(suites) for suites in FROZEN} == FROZEN, "others: another VERSION"
    assert sorted(name for suites in FROZEN for name in suites) == sorted(SUITES)
    assert document()["licence"] == "CC-BY-4.0"


def test_every_case_has_a_suite_a_model_that_agrees_and_a_small_bar():
    assert len(references()) == len(document()["cases"]) == 56
    for known in references().values():
        assert known.suite in SUITES and known.agreeing and known.why, known.name
        assert (known.duration is not None) == (known.suite == "motion"), known.name
    limits = dict.fromkeys(SUITES, 1e-3) | {"motion": 0.02}
    first_order = {"over-cylinder": 0.02}  # of where the nodes are on it
    for known in references().values():
        assert 0.0 < known.bar <= first_order.get(known.name, limits[known.suite]), known.name
        assert known.values.shape == known.bars.shape and np.isfinite(known.values).all()


@pytest.mark.parametrize("name", ["thick", "poisson-0"])
def test_a_coarser_shell_finds_the_values(name):
    """On 8 elements instead of 24: nine times the error at order 2, which is what these limits leave."""
    known = references()[name]
    solution = fem_reference.solve(known.scene, "shell", elements=8)
    off = np.abs(solution.displacement(known.scene.probe_points()) - known.values).max()
    assert off < 2e-3 * np.abs(known.values).max()


def test_the_verb_lists_and_exports_it(tmp_path, capsys):
    assert json_of(capsys, "score", "--out", str(tmp_path))["cases"] == json.loads(FILE.read_text())["cases"]
    assert scenes.load(str(tmp_path / "thick.toml")) == references()["thick"].scene
    assert "CC-BY-4.0" in (tmp_path / "LICENCE.txt").read_text()
    with (tmp_path / "values-statics.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 4 * 20 and float(rows[0]["ux"]) == references()["two-edges-clamped"].values[0, 0]
    forms = {(tmp_path / f"answers-{suite}.csv").read_text().splitlines()[0] for suite in SUITES}
    assert len(forms) == 3  # all at rest have that of statics
    for suite in ("statics", "motion"):  # where the probes are, and nothing answered yet
        with (tmp_path / f"answers-{suite}.csv").open() as file:
            row = list(csv.DictReader(file))[-1]
        place = references(suite)[row["case"]].scene.probes[row["probe"]]
        assert (float(row["x"]), float(row["y"])) == place and row["ux"] == row["seconds"] == ""
        with pytest.raises(BadInput, match="no answer yet"):  # x and y are none
            read_answers(tmp_path / f"answers-{suite}.csv")
