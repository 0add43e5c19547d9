"""The motion of a sheet by every model and CalculiX: `crosscheck --duration`."""

import json
from pathlib import Path

import numpy as np
import pytest
from commands import one_line, run

from comparisons.external.calculix.model import MODEL as CALCULIX
from sheetbench.scenes import Air, BadInput, FactorTable, Gravity, Relaxation, Status, load

SWING = load("one-edge-clamped")
SMALL = ("--lumped", "3,4", "--shell", "1,2", "--plate", "", "--solid", "", "--workers", "1")


@pytest.mark.skipif(CALCULIX.version() is None, reason=f"needs {CALCULIX.needs}")
def test_calculix_swings_as_the_shell(tmp_path: Path) -> None:
    """On two elements a side: the difference is that of the elements, and falls with them."""
    asked = ("one-edge-clamped", "--duration", "0.02", *SMALL, "--meshes", "1,2", "--judges", "calculix")
    assert run("crosscheck", *asked, "--out", str(tmp_path)) == 0
    found = json.loads((tmp_path / "motion.json").read_text())
    assert [one["model"] for one in found["solutions"]] == ["lumped", "calculix", "shell"]
    of = {one["of"]: one for one in found["motion"]["differences"]}
    assert of["calculix"]["largest"] < 0.03 and of["calculix"]["energies"] == {}
    assert found["motion"]["uncertainty"]["finer"] > 0.0
    rows = (tmp_path / "calculix.csv").read_text().splitlines()
    assert "kinetic" not in rows[0] and len(rows) == len(found["motion"]["time"]) + 1


def test_a_motion_that_calculix_is_not_given_says_why() -> None:
    grown = FactorTable(time=(0.0, 1.0), factor=(0.0, 1.0))
    scenes = {
        "no dampers": SWING.replace(damping_rate=1.0),
        "relaxation out": SWING.replace(relaxation=(Relaxation(0.2, 0.1),)),
        r"\[air\] out": SWING.replace(air=Air(drag=1.0)),
        "with a history": SWING.replace(gravity=Gravity((0.0, 0.0, -9.81), history=grown)),
        "bent or turned": load("curved-edge"),
    }
    for why, scene in scenes.items():
        with pytest.raises(BadInput, match=f"calculix: .*{why}"):
            CALCULIX.simulate(scene, CALCULIX.settings, 0.1, every=0.01)


def test_a_program_that_ends_in_the_midst_is_a_status(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "ccx"
    file.write_text("#!/bin/sh\nexit 201\n", encoding="utf-8")
    file.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    history = CALCULIX.simulate(SWING, {**CALCULIX.settings, "elements": 2}, 0.1, every=0.01)
    assert history.status is Status.DIVERGED and "exit status 201" in history.message
    assert np.isnan(history.balance).all() and len(history.time) == 1


def test_what_is_asked_of_a_motion_is_one_scene_and_a_shell(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("crosscheck", "one-edge-clamped", "two-edges-clamped", "--duration", "0.1") == 2
    assert "--duration: one scene, not 2" in one_line(capsys)
    assert run("crosscheck", "one-edge-clamped", "--duration", "0.1", "--shell", "") == 2
    assert "--shell: with --duration" in one_line(capsys)


@pytest.mark.parametrize(
    ("grids", "said"),
    [
        ("", "no motion to compare: calculix is left out"),
        ("3,4", "calculix is left out: CalculiX: left with exit status 201"),
    ],
)
def test_a_code_that_does_not_reach_the_end_is_said_and_is_three(
    grids: str, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "ccx"
    file.write_text("#!/bin/sh\necho This is Version 2.20\nexit 201\n", encoding="utf-8")
    file.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    asked = (*SMALL, "--lumped", grids, "--duration", "0.004", "--judges", "calculix", "--meshes", "1,2")
    assert run("crosscheck", "one-edge-clamped", *asked) == 3
    assert said in capsys.readouterr().err
