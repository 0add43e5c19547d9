"""Files of results, as pull requests bring them: every one is read, and what is wrong with one is said."""

from __future__ import annotations

import json

import pytest

from sheetbench.errors import BadInput
from studies.trials import page
from studies.trials.study import RESULTS, read_results

FILES = sorted(RESULTS.glob("*.json"))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_file_of_results_is_valid(path):
    assert read_results(path)["code"] == path.stem


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


def test_a_stranger_s_code_has_its_table_and_its_place(tmp_path, monkeypatch):
    """One recipe on one scene: nothing of ours to compare it with."""
    head = {"code": "mine", "title": "Mine 1", "licence": "MIT", "date": "2026-11-23"}
    row = {"scene": "two-edges-clamped", "recipe": "as it is", "mesh": "squares", "status": "converged"}
    document = head | {
        "machine": "x86_64",
        "command": "./mine",
        "rows": [row | {"error": 0.1, "seconds": 1.0}],
    }
    (tmp_path / "results").mkdir()
    (tmp_path / "images").mkdir()
    (tmp_path / "results" / "mine.json").write_text(json.dumps(document))
    monkeypatch.setattr(page, "RESULTS", tmp_path / "results")
    monkeypatch.setattr(page, "DOCS", tmp_path)
    text = page.write_page().read_text().replace(page.NO_BREAK, " ")
    assert "- **Mine 1** (`./mine`): as it is: 10.0 % of 1." in text
    assert "| two-edges-clamped | 10.0 %, 1 s |" in text and "10.0 %, Mine 1`" in text
