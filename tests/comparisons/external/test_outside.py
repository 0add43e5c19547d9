"""Models from outside, plug-ins and programs: the docs' examples in our tables, faulty ones in a row."""

import json
import os
import shutil
import signal
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from campaigns import alive, wait_for
from commands import json_of, one_line, run

from comparisons.external import plugins
from comparisons.external.answer import ExternalCode
from comparisons.models import solve as solvers
from comparisons.models.spec import parse
from comparisons.sweep import task
from comparisons.sweep.solved import Request
from sheetbench import face, scenes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, EdgeLoad

SCENE = scenes.load("one-edge-clamped")
DOCS = Path(__file__).parents[3] / "docs"
COMPARE = ("compare", "one-edge-clamped", "--lumped", "3", "--elements", "2", "--no-uncertainty")
PLUG_INS = DOCS.parent / "examples" / "plug-ins"
ENTRY = "[sheetbench.models]\nstrip = plugin:MODEL\nabsent = no_such_module:MODEL\nhalf = plugin:np\n"


def tip_of_the_beam():
    """The deflection [m] of the strip's tip under its weight, of a cantilever that is free to narrow."""
    sheet, material = SCENE.sheet, SCENE.material
    rigidity = material.young * sheet.thickness**3 / 12
    return -material.density * sheet.thickness * 9.81 * sheet.length_x**4 / (8 * rigidity)


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """docs/plugin.py as an installed package would offer it, beside two that are broken."""
    metadata = tmp_path / "outside-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: outside\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRY)
    monkeypatch.setattr(sys, "path", [str(tmp_path), str(DOCS), *sys.path])
    plugins._entry_points.cache_clear()
    solvers.warm.cache_clear()
    yield
    plugins._entry_points.cache_clear()
    solvers.warm.cache_clear()


def test_the_plug_in_of_the_docs_answers_like_a_beam(installed):
    solution = face.solve(SCENE, "strip", plane_strain=True)
    assert (solution.model, solution.settings) == ("strip", {"plane_strain": True})
    wide = tip_of_the_beam() * (1 - SCENE.material.poisson**2)
    assert solution.displacement(SCENE.probe_points())[3, 2] == pytest.approx(wide)
    assert face.solve(SCENE, "strip").settings == {"plane_strain": False}


@pytest.mark.usefixtures("in_process")
def test_a_plugin_stands_in_the_same_table_and_on_the_same_front(installed, capsys):
    arguments = ("--lumped", "5", "--calibration", "consistent", "--plate", "", "--shell", "2", "--solid", "")
    options = ("--model", "strip", "--model", "strip:plane_strain=true", "--elements", "4", "--repeats", "1")
    document = json_of(capsys, "tradeoff", "one-edge-clamped", *arguments, *options)
    rows = {row["series"]: row for row in document["rows"]}
    assert set(rows) == {"lumped consistent", "shell", "strip", "strip plane_strain"}
    assert rows["strip"]["error"] == pytest.approx(0.32, abs=0.02)  # it is linear
    assert rows["lumped consistent"]["error"] < rows["strip"]["error"]
    quickest = document["rows"][document["front"][0]]
    assert quickest["model"] == "strip"


def test_what_is_wrong_with_a_plugin_is_said_in_a_line(installed, capsys):
    assert plugins.names()[:1] == ["absent"]
    for name, said in (
        ("absent", "cannot be loaded.*no_such_module"),
        ("half", "lacks a name"),
        ("none", "unknown, choose one of lumped, .*plate, shell, solid, absent, .*half"),
    ):
        with pytest.raises(BadInput, match=f"model = '{name}': .*{said}"):
            face.solve(SCENE, name)
    with pytest.raises(BadInput, match="no setting 'grid'; it has plane_strain"):
        face.solve(SCENE, "strip", grid=9)
    assert run("tradeoff", "one-edge-clamped", "--model", "strip:grid=9") == 2
    assert "no setting 'grid'" in one_line(capsys)


@pytest.mark.parametrize("where", ["when it is loaded", "when it solves"])
def test_one_that_ends_the_program_is_refused(tmp_path, capsys, where):
    """The exit status was 0, and nothing was said."""
    file, text = tmp_path / f"{where[-5:].strip()}.py", "raise SystemExit(0)\n"
    if where == "when it solves":
        example = (DOCS / "plugin.py").read_text()
        text = f"{example}\n\nclass Ends(Strip):\n    def solve(self, *_):\n        {text}"
    file.write_text(text)
    assert run(*COMPARE, "--model", f"{file}:Ends") == 2
    assert "plug-in" in (said := capsys.readouterr().err) and "Traceback" not in said


def test_a_row_is_of_the_plug_in_as_it_is_and_of_what_it_imports_beside_it(tmp_path):
    """Rows of an edited plug-in were read as if nothing had changed; a folder of modules without
    `__init__.py` was a fault of the program."""
    file, beside, part = tmp_path / "own.py", tmp_path / "constants.py", tmp_path / "parts" / "unit.py"
    example = (DOCS / "plugin.py").read_text()
    file.write_text(f"from constants import UNIT\n{example}")
    beside.write_text("import parts.unit\nUNIT = 1\n")
    part.parent.mkdir()
    part.write_text("x = 1\n")
    (tmp_path / "elsewhere.py").write_text("x = 1\n")
    name = f"{file}:Strip"

    def key():
        return Request(SCENE, parse(name)).task.key

    first = key()
    (tmp_path / "elsewhere.py").write_text("x = 2\n")
    assert key() == first
    part.write_text("x = 2\n")
    others = {first, key()}
    beside.write_text("UNIT = 2\n")
    second = key()
    file.write_text(f"from constants import UNIT\n{example}\n")
    assert len(others | {second, key()}) == 4
    with pytest.raises(RuntimeError, match="changed since this run was requested"):
        task.solve(SCENE.document(), name, {}, digest=plugins.digest("lumped"))


@pytest.fixture
def shipped(monkeypatch):
    """The plug-ins of examples/plug-ins, by the entry points that their package has."""
    known = tomllib.loads((PLUG_INS / "pyproject.toml").read_text(encoding="utf-8"))["project"][
        "entry-points"
    ]
    monkeypatch.setattr(plugins, "OURS", {**plugins.OURS, **known[plugins.GROUP]})
    plugins._entry_points.cache_clear()
    yield known[plugins.GROUP]
    plugins._entry_points.cache_clear()


def test_the_plug_ins_of_the_examples_are_models_by_their_names(shipped):
    assert shipped.keys() == {"felupe", "mujoco"} <= set(plugins.names())
    for name in shipped:
        assert plugins.plugin(name).name == name
        file = f"{PLUG_INS}/sheetbench_{name}.py:MODEL"
        assert plugins.plugin(file).settings == plugins.plugin(name).settings
        assert plugins._load(file) is plugins._load(file)
    assert isinstance(plugins.plugin("felupe"), ExternalCode)


def test_mujoco_refuses_what_it_does_not_have(shipped):
    pulled = SCENE.replace(loads=(EdgeLoad(edge="x1", force_per_length=(1.0, 0.0, 0.0)),))
    tilted = SCENE.replace(supports=(Clamped(edge="x0", tilt=0.1),))
    for scene in (scenes.load("curved-edge"), pulled, tilted):
        solution = face.solve(scene, "mujoco")
        assert solution.status is Status.REFUSED and solution.message
    for name, value in (("elastic2d", "none"), ("grid", 2)):
        with pytest.raises(BadInput, match=f"{name} = "):
            face.solve(SCENE, "mujoco", **{name: value})


# ---- programs
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
def test_the_program_of_the_docs_answers_like_a_beam(capsys):
    program = DOCS / "strip.sh"
    assert len(program.read_text(encoding="utf-8").splitlines()) <= 10
    solution = face.solve(SCENE, f"exec:{program}")
    assert (solution.model, solution.status) == ("strip", Status.CONVERGED)
    assert solution.displacement(SCENE.probe_points())[3] == pytest.approx([0.0, 0.0, tip_of_the_beam()])
    assert np.isnan(solution.displacement([[0.01, 0.01]])).all()  # it is requested the probes alone
    arguments = ["two-edges-clamped", "--lumped", "3", "--elements", "2", "--model", f"exec:{program}"]
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
def test_an_invalid_answer_of_a_program_fails_with_its_reason(program, lines, said):
    solution = face.solve(SCENE, program("mine", *lines), memory_mb=800)
    assert (solution.status, solution.load_factor) == (Status.FAILED, 0.0)
    assert not solution.comparable
    assert said in solution.message


def test_a_comparison_goes_on_without_it(program, capsys):
    assert run(*COMPARE, "--json", "--model", program("crash", "exit 9")) == 0
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
