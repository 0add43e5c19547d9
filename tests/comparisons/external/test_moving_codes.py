"""The motion of a sheet by CalculiX and Kratos."""

import json

import pytest
from commands import run

from comparisons.comparison.motion import compare_motion
from comparisons.external.calculix.model import MODEL as CALCULIX
from comparisons.external.kratos.model import MODEL as KRATOS
from sheetbench.scenes import Air, BadInput, EdgeMotion, FactorTable, Gravity, Relaxation, load

SWING = load("one-edge-clamped")
UP = ((0.0, 0.0, 0.0), (0.0, 0.0, 0.01))
DRIVEN = EdgeMotion(edge="x0", kind="motion", time=(0.0, 1.0), displacement=UP)


@pytest.mark.parametrize(("code", "elements"), [(CALCULIX, 2), (KRATOS, 4)])
def test_another_code_swings_as_the_shell(code, elements, tmp_path):
    """On few elements a side: the difference is that of the elements, and falls with them."""
    if code.version() is None:
        pytest.skip(f"needs {code.needs}")
    arguments = ("one-edge-clamped", "--duration", "0.02", "--lumped", "4", "--elements", "2")
    model = f"{code.name}:elements={elements}"
    assert run("compare", *arguments, "--model", model, "--out", str(tmp_path), "--no-pictures") == 0
    found = json.loads((tmp_path / "motion.json").read_text())
    assert [one["model"] for one in found["solutions"]] == ["lumped", code.name, "shell"]
    of = {one["of"]: one for one in found["motion"]["differences"]}
    assert of[code.name]["largest"] < 0.1 * found["motion"]["uncertainty"]["mesh"]  # the elements of both
    assert of[code.name]["energies"] == {}
    rows = (tmp_path / f"{code.name}.csv").read_text().splitlines()
    assert "kinetic" not in rows[0] and len(rows) == len(found["motion"]["time"]) + 1


def test_a_model_that_refuses_is_said_before_anything_moves(tmp_path):
    file = tmp_path / "still.py"
    file.write_text(
        "class Still:\n    name, settings, solve, simulate = 'still', {}, print, print\n"
        "    def refusal_of_motion(self, scene, settings): return 'nothing moves'\n"
    )
    with pytest.raises(BadInput, match="still: nothing moves"):
        compare_motion(SWING, 0.002, models=[f"{file}:Still"])


@pytest.mark.parametrize("code", [CALCULIX, KRATOS])
def test_a_motion_that_another_code_is_not_given_says_why(code):
    grown = FactorTable(time=(0.0, 1.0), factor=(0.0, 1.0))
    scenes = {
        "no dampers": SWING.replace(damping_rate=1.0),
        "relaxation out": SWING.replace(relaxation=(Relaxation(0.2, 0.1),)),
        r"\[air\] out": SWING.replace(air=Air(drag=1.0)),
        "with a history": SWING.replace(gravity=Gravity((0.0, 0.0, -9.81), history=grown)),
        "bent or turned": load("curved-edge"),
        r"\[\[mass\]\]": SWING.replace(masses=({"at": (0.1, 0.1), "mass": 0.1},)),
        "driven": SWING.replace(supports=(), actuators=(DRIVEN,)),
    }
    for why, scene in scenes.items():
        with pytest.raises(BadInput, match=f"{code.name}: .*{why}"):
            code.simulate(scene, code.settings, 0.1, every=0.01)


def test_a_code_that_does_not_reach_the_end_is_said_and_is_three(tmp_path, monkeypatch, capsys):
    file = tmp_path / "ccx"
    file.write_text("#!/bin/sh\necho This is Version 2.20\nexit 201\n", encoding="utf-8")
    file.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/usr/bin:/bin")
    arguments = ("--lumped", "3", "--elements", "1", "--duration", "0.004", "--model", "calculix:elements=1")
    assert run("compare", "one-edge-clamped", *arguments) == 3
    assert "calculix: diverged: CalculiX: exit status 201" in capsys.readouterr().err
