"""Habibi et al.'s study in depth: errors recomputed, what its tables ask of any sheet, the nearest sheets."""

import json
from collections import Counter

import numpy as np
import pytest
from commands import run

from comparisons.reproduction.published import scene
from sheetbench.scenes.habibi import published_inputs
from studies.reproduction.chords import of_table
from studies.reproduction.inputs import checks
from studies.reproduction.nearest import ENOUGH, SQUARES, Scan, fits, matches
from studies.reproduction.printed_errors import Cell, cells, means
from studies.reproduction.sheets import Sheets
from studies.reproduction.study import study

SMALL = (3, 3, 2)


@pytest.fixture(scope="module")
def errors():
    return study(["errors"])


def test_every_printed_error_is_of_the_larger_value():
    """By hand: 0.02/0.35 = 5.71 % of the experiment is printed 5.7; 0.06/0.87 = 6.90 % of the model, 6.8."""
    found = {(cell.test, cell.component, cell.probe): cell for cell in cells()}
    assert len(found) == 24 and all(cell.by_larger for cell in found.values())
    first, second = found[1, "ux", "P1"], found[1, "ux", "P2"]
    assert (first.of, first.digits, first.changes) == ("experiment", "rounded", False)
    assert (second.of, second.digits, second.changes) == ("model", "cut off", True)
    assert second.of_experiment == pytest.approx(0.06 / 0.81) and second.of_model == pytest.approx(
        0.06 / 0.87
    )
    assert Counter(cell.of for cell in found.values()) == {"model": 13, "experiment": 8, "both": 3}
    mean = means(list(found.values()))
    assert mean["printed"] == pytest.approx(0.0492, abs=5e-5) and mean["of_experiment"] > mean["printed"]


def test_a_printed_error_of_neither_is_said_to_be():
    cell = Cell(1, "ux", "P1", 0.09, 0.0571, 0.0606, 0.0571, "neither", "")
    assert cell.changes and not cell.by_larger


def test_inputs_against_one_another():
    found = {check.what: check for check in checks() if check.what != "k"}
    assert found["mass of a point"].agrees and not found["equations"].agrees
    assert found["equations"].computed == 486
    assert all(found[f"links, {where}"].agrees for where in ("interior", "edge", "corner"))
    assert found["layer distance"].computed == pytest.approx(0.01702, abs=1e-5)
    assert found["layer distance"].agrees is None


def chord(found, start, end):
    return next(one for one in found if (one.start, one.end) == (start, end))


def test_a_rolled_sheet_asks_for_its_own_turning_and_for_no_stretch():
    """A sheet rolled about y to a radius R: from x0 to P3 it turns through a/R, and c = 2 R sin(a/2R)."""
    asked = scene(2)
    x, radius = asked.probe_points()[:, 0], 0.1
    rolled = np.column_stack([radius * np.sin(x / radius) - x, 0.0 * x, radius * (np.cos(x / radius) - 1.0)])
    one = chord(of_table(2, "model", rolled), "P1", "P3")
    assert one.stretch == 0.0
    assert one.published == pytest.approx(2 * radius * np.sin(0.094 / (2 * radius)))
    assert 0.9 * 0.094 / (2 * radius) < one.turning < 0.094 / radius  # the least of any curve of that chord


def test_a_stretched_sheet_is_seen_less_what_digits_leave_open():
    points = scene(1).probe_points()
    moved = np.column_stack([0.002 * points, np.zeros(4)])
    one = chord(of_table(1, "model", moved), "P1", "P3")
    assert one.stretch == pytest.approx(0.002 - 1e-5 / 0.094, rel=1e-6)
    assert not any(c.stretch for c in of_table(1, "model", 0.01 * moved))  # within the digits


def test_published_distances_that_no_sheet_has():
    found = of_table(2, "model")
    assert chord(found, "P3", "P4").stretch == pytest.approx(0.0046, abs=1e-4)
    assert np.degrees(chord(found, "P1", "P3").turning) == pytest.approx(54.7, abs=0.1)


@pytest.mark.parametrize(
    ("kind", "true", "start"),
    [
        ("sheet", {"young": 30e6, "tilt": 0.05}, 60e6),
        ("lattice", {"layer_distance": 0.012, "k": 800.0}, 0.008),
    ],
)
def test_a_sheet_is_found_from_its_own_table(kind, true, start, monkeypatch):
    """E, tilt, k and lz come back as they were; a plate turned as a whole is what the tilt says it is."""
    sheets = Sheets(kind, [scene(1)], SMALL)
    monkeypatch.setattr("studies.reproduction.nearest.sheets_of", lambda *_: sheets)
    (table,) = sheets.displacements([true])
    name = next(iter(true))
    (first,) = sheets.displacements([{name: start}])
    found = fits(Scan(kind, (1,), 0, name, np.array([start]), first[None]), table)
    best = next(fit for fit in found if set(fit.sought) == set(true) and fit.by == SQUARES)
    assert dict(best.sought) == pytest.approx(true, rel=100 * ENOUGH)
    assert best.matches.all() and best.error < 1e-4 and best.converged
    assert not matches(1.2 * table, table).all()


def test_supports_turned_as_one_turn_a_stiff_sheet_rigidly():
    """E a million times as large: uz = −sin τ · distance from the turning axis, and nothing along it."""
    tilt, side = 0.1, published_inputs()["side"]
    sheets = Sheets("sheet", [scene(1)], SMALL)
    (moved,) = sheets.displacements([{"young": 54.5e12, "tilt": tilt}])
    away = scene(1).probe_points() @ np.array([1.0, 1.0]) / np.sqrt(2.0)
    np.testing.assert_allclose(moved[:, 2], -np.sin(tilt) * away, atol=1e-6 * side)
    np.testing.assert_allclose(moved[:, 0], (np.cos(tilt) - 1.0) * away / np.sqrt(2.0), atol=1e-6 * side)


def test_the_document(errors):
    document = errors.document()
    assert {"parts", "inputs", "known_faults", "findings", "checks", "errors"} == set(document)
    assert document["errors"]["means"]["quoted"] == 0.048
    assert document["errors"]["cells"][1]["changes"] is True
    assert len(document["findings"]) == 5
    assert document["findings"][1]["finding"].startswith("The printed errors have a mean of 4.92 %")


def test_the_verb_writes_a_page_and_says_what_it_found(tmp_path, capsys):
    assert run("study", "reproduction", "--part", "errors", "--out", str(tmp_path)) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert "24 of 24 printed errors" in shown
    page = (tmp_path / "reproduction.md").read_text(encoding="utf-8")
    assert page.startswith("# The study of Habibi et al., reproduced") and "model \\*" in page
    assert json.loads((tmp_path / "reproduction.json").read_text())["parts"] == ["errors"]
    assert (tmp_path / "errors.csv").read_text().count("\n") == 25
