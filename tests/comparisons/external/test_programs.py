"""Models that are programs: their input and answer; one that ends badly costs its own row and no other."""

import json
import os
import shutil
import signal
import sys
from pathlib import Path

import numpy as np
import pytest
from campaigns import alive, wait_for
from commands import json_of, one_line, run

from comparisons.models.spec import parse
from sheetbench import face, scenes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput

STRIP = Path(__file__).parents[3] / "docs" / "strip.sh"
SCENE = scenes.load("one-edge-clamped")
ANSWER = {"status": "converged", "probes": {name: [0.0, 0.0, -0.04] for name in SCENE.probes}}


@pytest.fixture
def program(tmp_path):
    """Makes a shell script, and says how to ask for it."""

    def make(name, *lines):
        path = tmp_path / name
        path.write_text("\n".join(["#!/bin/sh", *lines, ""]), encoding="utf-8")
        path.chmod(0o755)
        return f"exec:{path}"

    return make


def says(answer):
    return f"cat <<'END'\n{json.dumps(answer)}\nEND"


@pytest.mark.skipif(shutil.which("jq") is None, reason="needs jq: install the Debian package jq")
def test_the_example_of_the_docs_answers_like_a_beam(capsys):
    assert len(STRIP.read_text(encoding="utf-8").splitlines()) <= 10
    solution = face.solve(SCENE, f"exec:{STRIP}")
    sheet, material = SCENE.sheet, SCENE.material
    rigidity = material.young * sheet.thickness**3 / 12
    tip = -material.density * sheet.thickness * 9.81 * sheet.length_x**4 / (8 * rigidity)
    assert (solution.model, solution.status) == ("strip", Status.CONVERGED)
    assert solution.displacement(SCENE.probe_points())[3] == pytest.approx([0.0, 0.0, tip])
    assert np.isnan(solution.displacement([[0.01, 0.01]])).all()  # it is requested the probes alone
    arguments = ["two-edges-clamped", "--lumped", "3", "--elements", "2", "--model", f"exec:{STRIP}"]
    assert run("compare", *arguments) == 2
    assert "strip: knows a sheet clamped at x0" in capsys.readouterr().err


def test_it_gets_the_scene_and_its_settings_and_may_tell_more(program, tmp_path):
    kept = tmp_path / "kept"
    more = {"solve_seconds": 1e-4, "unknowns": 7, "iterations": 3, "reactions": {"x0": [0, 0, 1.7]}}
    model = program("mine", f"cat > '{kept}'", f"echo \"$@\" > '{kept}.options'", says(ANSWER | more))
    spec = parse(f"{model}:seconds=5,n=9,grid=9x5,quick=true,name=a b")
    solution = face.solve(SCENE, spec)
    assert scenes.Scene.model_validate_json(kept.read_text()) == SCENE
    assert Path(f"{kept}.options").read_text() == "--n=9 --grid=9x5 --quick --name=a b\n"
    assert solution.settings == {"n": 9, "grid": [9, 5], "quick": True, "name": "a b"}
    assert (solution.unknowns, solution.iterations, solution.solve_seconds) == (7, 3, 1e-4)
    assert solution.setup_seconds > 0.0 and solution.reactions["x0"][2] == 1.7
    assert parse(str(spec)) == spec


def test_what_ends_badly_is_a_row_of_its_own_in_the_tradeoff(program, tmp_path, in_process, capsys):
    truth = face.solve(SCENE, "shell", elements=4).displacement(SCENE.probe_points())
    right, wrong = (dict(zip(SCENE.probes, (s * truth).tolist(), strict=True)) for s in (1, -1))
    models = [
        program("right", says({"probes": right})),
        program("wrong", says({"probes": wrong})),
        program("crash", "echo 'out of luck' >&2", "kill -SEGV $$"),
        program("hang", "sleep 600 &", f"echo $! > '{tmp_path / 'sleeper'}'", "wait") + ":seconds=0.3",
        program("garbage", "echo 'P4 = -0.04'"),
    ]
    arguments = [part for model in models for part in ("--model", model)]
    few = ["--lumped", "3", "--shell", "2", "--plate", "", "--solid", "", "--elements", "8", "--repeats", "1"]
    found = json_of(capsys, "tradeoff", "one-edge-clamped", *few, *arguments)
    rows = {row["model"]: row for row in found["rows"]}
    assert rows["right"]["error"] < 0.05 < 1.5 < rows["wrong"]["error"]
    assert rows["right"]["solve_seconds"]["median"] > 0.0 and rows["right"]["peak_memory_bytes"] is None
    assert {rows[name]["status"] for name in ("lumped", "shell", "right")} == {"converged"}
    front = [found["rows"][number]["model"] for number in found["front"]]
    for name, said in (
        ("crash", "ended by SIGSEGV: out of luck"),
        ("hang", "no answer within 0.3 s"),
        ("garbage", "its answer cannot be read: not one JSON document"),
    ):
        row = rows[name]
        assert (row["status"], row["error"], row["message"]) == ("failed", None, said) and name not in front
    sleeper = int((tmp_path / "sleeper").read_text())
    wait_for(lambda: not alive(sleeper), 10.0)  # killed with what it had started


@pytest.mark.parametrize(
    ("lines", "said"),
    [
        (["exit 7"], "exit status 7"),
        ([says({**ANSWER, "reactions": {"y9": [0, 0, 1]}})], "reactions: y9: the scene holds x0"),
        ([says({**ANSWER, "reactions": {"y9" * 999: [0, 0, 1]}})], "reactions: y9y9"),
        (["yes"], "more than 16 MB of answer"),
        ([says([1, 2])], "not a JSON object"),
        ([says({"probes": {"P1": [0, 0, 0]}})], "probes: P2, P3, P4 missing"),
        ([says({**ANSWER, "status": "fine"})], "status = 'fine': choose from"),
        ([says({**ANSWER, "probes": {**ANSWER["probes"], "P1": [0, None, 0]}})], "probes.P1 = "),
        ([says(ANSWER).replace("-0.04", "NaN", 1)], "three finite numbers"),
        ([says({**ANSWER, "unknowns": -3})], "unknowns = -3"),
        ([says({**ANSWER, "unknowns": 10**400})], "unknowns = 1000"),
        ([says({**ANSWER, "probes": {**ANSWER["probes"], "P1": [0, -(10**400), 0]}})], "at most 1e+15"),
        ([says(ANSWER).replace("-0.04", "9" * 5000, 1)], "not one JSON document"),
        ([f"exec '{sys.executable}' -c 'x = bytearray(2**30)'"], "exit status 1: MemoryError"),
    ],
)
def test_what_is_no_answer_is_told(program, lines, said):
    solution = face.solve(SCENE, program("mine", *lines), memory_mb=800)
    assert (solution.status, solution.load_factor) == (Status.FAILED, 0.0)
    assert not solution.comparable
    assert said in solution.message


def test_a_comparison_goes_on_without_it(program, capsys):
    few = ["--lumped", "3", "--elements", "2", "--no-uncertainty", "--json"]
    assert run("compare", "one-edge-clamped", *few, "--model", program("crash", "exit 9")) == 0
    printed = capsys.readouterr()
    assert "crash: failed at 0 % of the load: exit status 9" in " ".join(printed.err.split())
    assert json.loads(printed.out)["solutions"][3]["status"] == "failed"


def test_what_cannot_be_run_is_refused(program, tmp_path, capsys):
    plain, mine = tmp_path / "plain", program("mine", says(ANSWER))
    plain.write_text("#!/bin/sh\n")
    endless = ("seconds=1e20", "seconds=1" + 400 * "0", "memory_mb=1e999")
    for model, said in (
        (f"exec:{tmp_path / 'absent'}", "no such program"),
        (f"exec:{plain}", "not executable, see chmod +x"),
        (f"{mine}:seconds", "exec:PROGRAM:key=value"),
        *((f"{mine}:{limit}", "a number of at most 1e+15 is needed") for limit in endless),
    ):
        assert run("tradeoff", "one-edge-clamped", "--model", model) == 2
        assert said in one_line(capsys)
    with pytest.raises(BadInput, match="seconds = 0: a number above 0"):
        face.solve(SCENE, mine, seconds=0)
    assert face.solve(SCENE, mine, seconds=1e15, memory_mb=1e15).comparable


@pytest.mark.parametrize("leaves", ["", " >/dev/null"], ids=["holding its output", "holding its errors"])
def test_a_child_that_is_left_behind_holds_nothing_up(program, tmp_path, leaves):
    """It was waited for, beyond the time limit and at any length, and the answer lost."""
    left = f"setsid sh -c 'echo $$ > {tmp_path / 'left'}; exec sleep 60'{leaves} &"
    ready = f"while [ ! -s {tmp_path / 'left'} ]; do sleep 0.01; done"
    solution = face.solve(SCENE, program("mine", left, ready, says(ANSWER)), seconds=30)
    child = int((tmp_path / "left").read_text())
    assert alive(child)  # nothing but its end could have ended a wait for it
    os.kill(child, signal.SIGKILL)
    assert solution.comparable
