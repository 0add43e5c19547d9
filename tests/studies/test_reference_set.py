"""The reference set computed anew, on coarse meshes."""

import json
from zipfile import ZipFile

import pytest

from comparisons.scoring.reference import document, references
from studies.codes import models as leaderboard
from studies.reference_set import study as regenerate
from studies.reference_set.archive import archive


def test_one_command_computes_the_reference_set(monkeypatch):
    """On coarse meshes and one case of each suite, with the keys and cases of the file."""
    names = ("thick", "corner-struck", "modes-one-edge", "quarter-turn")
    chosen = [case for case in regenerate.cases() if case.name in names]
    monkeypatch.setattr(regenerate, "cases", lambda: chosen)
    for name, value in (("ELEMENTS", 4), ("SOLID", 2), ("OTHERS", {}), ("MOVING", (2, 1e-4)), ("GRID", 3)):
        monkeypatch.setattr(regenerate, name, value)
    found = regenerate.regenerate(lambda text: None)
    kept = {case["name"]: case for case in document()["cases"]}
    assert set(found) == set(document())
    for case in found["cases"]:
        assert set(case) == set(kept[case["name"]])
    assert found["standing"] == document()["standing"]


def test_rows_of_the_leaderboard_go_into_the_file(tmp_path, monkeypatch):
    """Of one case: its own rows anew, all others as they were; what is not installed is said."""
    file, before, said = tmp_path / "suite.json", document(), []
    file.write_text("{}")
    monkeypatch.setattr(leaderboard, "FILE", file)
    (name, known), *_ = references("statics").items()
    monkeypatch.setattr(leaderboard, "references", lambda suite: {name: known})
    leaderboard.measure_models(["plate:elements=16", "kratos:elements=16"], said.append)
    after = json.loads(file.read_text())
    assert said[0] == "plate:elements=16" and len(said) == 2
    rows = [{(row["model"], row["case"]): row for row in one["standing"]} for one in (before, after)]
    old, new = (one.pop(("plate", name)) for one in rows)
    assert new["error"] == pytest.approx(old["error"], rel=1e-9) and new["status"] == old["status"]
    assert rows[0] == rows[1] and after["cases"] == before["cases"]
    assert len(after["standing"]) == len(before["standing"])


def test_the_archive_of_the_reference_set_is_the_same_bytes_every_time(tmp_path):
    first, second = (archive(tmp_path / name).read_bytes() for name in ("a.zip", "b.zip"))
    assert first == second
    with ZipFile(tmp_path / "a.zip") as opened:
        names = {name.split("/")[1] for name in opened.namelist()}
    assert {"README.md", "LICENCE.txt", "SHA256SUMS", "suite.json", "cases.csv", "values-modes.csv"} <= names
