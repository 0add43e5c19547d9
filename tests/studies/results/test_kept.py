"""Kept results: every file makes a page, and what a run has written comes back as it was shown."""

import re

import pytest
from commands import run

from studies import pages

NAMES = sorted(path.stem for path in pages.RESULTS.glob("*.json") if path.stem != "promises")


@pytest.mark.parametrize("name", NAMES)
def test_every_kept_result_makes_a_page(name):
    report = pages.kept(name)
    assert report.title and all(table.rows for table in report.tables)
    assert len(re.findall(r"^\| ---:? ", report.to_markdown(), re.M)) >= len(report.tables)


def test_a_runs_folder_is_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(pages, "RESULTS", tmp_path)
    assert run("study", "reproduction", "--part", "nearest", "--out", str(tmp_path / "run")) == 0
    assert pages.keep_run(tmp_path / "run") == tmp_path / "reproduction.json"
    page = (tmp_path / "run" / "reproduction.md").read_text(encoding="utf-8")
    kept = pages.kept("reproduction").to_markdown()
    rows, shown = (re.findall(r"^\|.*", text, re.M) for text in (kept, page))
    assert rows == shown
