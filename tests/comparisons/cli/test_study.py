"""`sheetbench study`: names, options and exit statuses of the studies; refused without a checkout."""

from pathlib import Path

from commands import one_line, run

from comparisons.cli import study
from studies import STUDIES

ROOT = Path(__file__).parents[3]


def test_studies_are_listed_and_each_has_a_help_page(capsys):
    assert run("study") == 0
    listed = capsys.readouterr().out
    for name in (*study.INSTALLED, *STUDIES):
        assert f"\n{name} " in listed
        assert run("study", name, "--help") == 0
        assert f"sheetbench study {name}" in capsys.readouterr().out


def test_every_study_is_in_the_documentation_and_has_a_make_target():
    page = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
    targets = (ROOT / "studies" / "Makefile").read_text(encoding="utf-8")
    for name in (*study.INSTALLED, *STUDIES):
        assert f"| `{name}` |" in page and f"sheetbench study {name}" in targets


def test_an_installed_package_has_the_reproduction_and_names_the_way_to_the_others(
    tmp_path, monkeypatch, capsys
):
    monkeypatch.setattr(study, "CHECKOUT", tmp_path)
    assert run("study", "promises") == 2
    assert "choose from reproduction; others need a clone of the repository" in one_line(capsys)
    assert run("study") == 0
    listed = capsys.readouterr().out
    assert "reproduction " in listed and "promises" not in listed
    assert run("study", "reproduction", "--part", "nearest", "--json") == 0
