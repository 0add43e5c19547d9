"""The maps of published and extreme scenes: uneven masses and springs, other units, thin sheets."""

import json

import pytest
from commands import json_of, run

from studies.stability import limit, study
from studies.stability.scenes import sheet


def test_uneven_masses_move_the_limit_as_computed(monkeypatch):
    monkeypatch.setattr(limit, "SHARPNESS", 4e-3)
    rows = [study.chess_masses(5, ratio) for ratio in (1.0, 1e6)]
    assert all(row["error"] < 0.02 and abs(row["energy_drift"]) < 1e-8 for row in rows)
    assert rows[1]["limit"] < 2e-3 * rows[0]["limit"]


@pytest.mark.parametrize("model", ["lumped", "plate", "shell"])
def test_other_units_of_force_change_nothing(model):
    """E and all loads times a factor: to rounding, of the plate to its iterations' tolerance."""
    row = study.stiffer(1e6, model)
    assert row["status"] == "converged" and row["error"] < (1e-8 if model == "plate" else 1e-12)


@pytest.mark.usefixtures("few")
def test_command_writes_maps_and_tables_and_resumes(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(study, "TURNS", (0.1,))
    monkeypatch.setattr(study.maps, "__defaults__", (study.PARTS, (0.1,)))
    few = {name: (task, cells[:1]) for name, (task, cells) in study.TASKS.items()}
    monkeypatch.setattr(study, "TASKS", few)
    monkeypatch.setattr(study, "published", lambda: [sheet(0.016, 1.0)])
    words = ("study", "stability", "--workers", "1", "--out", str(tmp_path))
    assert run(*words) == 0
    shown = capsys.readouterr().out
    assert all(part in shown for part in ("pressed", "bent-up-0.1", "mass", "stiffness", "family"))
    names = {path.name for path in tmp_path.iterdir()}
    assert {"holds.csv", "steps.csv", "cells.csv", "bent-clamps.png", "stability-x0-clamped.pdf"} <= names
    document = json.loads((tmp_path / "stability.json").read_text())
    assert len(document["scenes"]) == 3 and len(document["rows"]) == 3
    before = (tmp_path / "campaign.sqlite").stat().st_mtime_ns
    assert json_of(capsys, *words) == document
    assert (tmp_path / "campaign.sqlite").stat().st_mtime_ns == before
