"""`sheetbench verify`: the quick cases, the table and its document; all of them in the slow run."""

from __future__ import annotations

import json
from functools import cache
from pathlib import Path

import pytest

from comparisons.cli import main
from comparisons.verification import tables as verification
from fem_reference.verification import CASES, Case, Row, run
from fem_reference.verification.rows import absolutely, relatively

QUICK = [name for name, case in CASES.items() if case.quick and "locking" not in name]  # see test_locking
PUBLISHED = {  # rows of ../published: case → number of values
    "end-shear": 16, "roll-up": 6, "slit-annulus": 10, "heavy-elastica": 24, "mindlin-simple": 3,
    "mindlin-clamped": 6, "nafems-fv16": 36, "nafems-fv12": 16, "leissa-one-edge": 24,
    "leissa-two-edges": 24, "nafems-le10": 1,
}  # fmt: skip


@cache
def rows_of(name: str) -> list[Row]:
    return list(run([name]))


def verify(*arguments: str) -> int:
    with pytest.raises(SystemExit) as caught:
        main(["verify", *arguments])
    return int(caught.value.code or 0)


def held(rows: list[Row]) -> None:
    assert rows
    assert not [row for row in rows if not row.passed]


@pytest.mark.parametrize("name", QUICK)
def test_quick_cases_pass(name: str) -> None:
    rows = rows_of(name)
    held(rows)
    assert {row.case for row in rows} == {name}


@pytest.mark.slow
def test_all_cases_pass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert verify("--json", "--out", str(tmp_path)) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert all(row["passed"] for row in rows)
    assert {row["case"] for row in rows} == set(CASES)
    for name, count in PUBLISHED.items():
        values = [row for row in rows if row["case"] == name and "change from" not in row["quantity"]]
        assert len(values) == count, name
        assert all(row["relative"] <= row["tolerance"] for row in values)
    assert {file.name for file in tmp_path.iterdir()} >= {"verification.json", "verification.csv"}


def test_tolerances_are_those_agreed() -> None:
    """Nonlinear shell 0.5 %, roll-up and heavy elastica 0.2 %, linear plates 0.3 %."""
    agreed = {"end-shear": 5e-3, "roll-up": 2e-3, "heavy-elastica": 2e-3, "mindlin-simple": 3e-3}
    for name, tolerance in agreed.items():
        assert {row.tolerance for row in rows_of(name)} == {tolerance}
    modes = {row.tolerance for row in rows_of("nafems-fv16")}
    assert modes == {3e-3, 1.5e-2}


def test_relative_is_to_the_published_value_or_to_a_length() -> None:
    assert relatively("c", "q", "m", -2.0, -2.1, 0.1).relative == pytest.approx(0.05)
    at_zero = relatively("c", "q", "m", 0.0, 0.3, 0.1, scale=12.0)
    assert at_zero.relative == pytest.approx(0.025) and at_zero.passed
    assert absolutely("c", "order", "m", 3.0, 3.2, 0.15).relative is None
    assert not absolutely("c", "order", "m", 3.0, 3.2, 0.15).passed
    assert not relatively("c", "q", "m", 1.0, float("nan"), 0.1).passed


def test_document_has_the_promised_keys(capsys: pytest.CaptureFixture[str]) -> None:
    assert verify("--case", "patch", "--json") == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    promised = {"case", "quantity", "published", "computed", "relative", "passed"}
    assert all(promised <= set(row) for row in rows)
    assert {row["relative"] for row in rows} == {None}


def test_a_row_that_fails_leaves_with_3(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    wrong = Case("a wrong one", "nowhere", lambda case: iter([relatively(case, "w", "one", 1.0, 1.1, 0.05)]))
    monkeypatch.setitem(CASES, "wrong", wrong)
    assert verify("--case", "wrong", "--case", "patch") == 3
    printed = capsys.readouterr()
    assert "wrong: w: 1.1 instead of 1" in printed.err
    assert "NO" in printed.out and "5 of 6 rows pass" in printed.out


@pytest.mark.parametrize("arguments", [("--case", "no-such"), ("--locking", "--case", "patch")])
def test_bad_options_leave_with_2(arguments: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert verify(*arguments) == 2
    assert "--case" in capsys.readouterr().err.replace("case =", "--case =")


def test_unknown_case_is_refused_before_anything_runs() -> None:
    with pytest.raises(ValueError, match="no-such"):
        run(["no-such"])


def test_tables_show_a_case_and_mesh_each() -> None:
    rows = rows_of("patch")
    tables = list(verification.by_case(rows))
    assert len(tables) == 3 and sum(len(table.rows) for table in tables) == len(rows)
    assert "relative" not in tables[0].to_markdown()
