"""The command line: exit statuses, one line for bad input, one JSON document, and quick help."""

import gc
import json
import os
import subprocess
import sys
from pathlib import Path

import fake_solutions
import numpy as np
import pytest
from commands import one_line, run
from terminals import Terminal

from comparisons.cli import interruption, startup, study
from comparisons.sweep import in_process as table
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.choices import VERBS
from studies import STUDIES

pytestmark = pytest.mark.smoke

PROGRAM = (sys.executable, "-m", "sheetbench")
HEAVY = ("numpy", "scipy", "pydantic", "matplotlib", "pyvista", "vtkmodules", "numba", "skfem", "meshio")


OURS = ("sheetbench", "comparisons", "lumped", "fem_reference", "studies")
HELPED = {"sheetbench", "sheetbench.choices", "sheetbench.clock", "sheetbench.heap"}
HELPED |= {
    f"comparisons{name}" for name in ("", ".sweep", ".sweep.interrupts", ".tradeoff", ".tradeoff.usual")
}
IMPORTED = """
import sys
from comparisons.cli import main
try:
    main(sys.argv[1].split())
finally:
    print("imported", *sys.modules)
"""


@pytest.mark.parametrize("arguments", ["--help", "--version", "identify --help"])
def test_help_and_version_import_no_scenes_and_nothing_heavy(arguments):
    """`--help` imports every verb's module; of a verb's own help typer itself imports pydantic."""
    program = [sys.executable, "-c", IMPORTED, arguments]
    done = subprocess.run(program, capture_output=True, text=True, check=True)
    found = set(done.stdout.rpartition("imported ")[2].split())
    of_command_line = {name for name in found if name.startswith("comparisons.cli")}
    assert {name for name in found if name.partition(".")[0] in OURS} - of_command_line <= HELPED
    assert found & {*HEAVY} <= ({"pydantic"} if arguments.endswith(" --help") else set())
    assert arguments != "--version" or not {f"comparisons.cli.{verb}" for verb in VERBS} & found


UNUSED = ("matplotlib", "pyvista", "vtkmodules", "meshio", "pandas", "fem_reference.solid", "lumped.dynamics")
UNUSED += ("scipy.optimize", "scipy.interpolate", "scipy.spatial", "scipy.stats")
UNUSED += ("multiprocessing", "sqlite3", "shapely")
COMPARE = """
import sys
from comparisons.cli import main
try:
    main(["compare", "one-edge-clamped", "--lumped", "3", "--elements", "2", "--no-uncertainty"])
finally:
    print([name for name in sys.argv[1:] if name in sys.modules])
"""


def test_a_comparison_imports_nothing_that_it_does_not_use_and_is_without_colours_where_none_are_wanted():
    """On a real terminal."""
    terminal = Terminal(f"import os; os.environ['NO_COLOR'] = '1'; {COMPARE}", *UNUSED)
    assert terminal.end() == 0
    assert terminal.shown.splitlines()[-1] == "[]"
    assert "converged" in terminal.shown and "\x1b[3" not in terminal.raw


def test_without_arguments_it_prints_its_help(capsys):
    assert run() == run("--help") == 0
    first, second = capsys.readouterr().out.split("Usage:")[1:]
    assert first.split() == second.split()


def test_a_shell_can_complete_the_verbs(monkeypatch, capsys):
    monkeypatch.setenv("_SHEETBENCH_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", "sheetbench s")
    monkeypatch.setenv("COMP_CWORD", "1")
    run()
    assert {"simulate", "stability", "study"} <= set(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    "fault", [ValueError("of ours"), TypeError("of ours"), np.linalg.LinAlgError("of ours")]
)
def test_a_fault_of_ours_is_not_passed_off_as_bad_input(fault, monkeypatch, capsys):
    def stumble(*_, **__):
        raise fault

    monkeypatch.setattr(table, "solve", stumble)
    assert run("compare", "two-edges-clamped") == 1
    *trace, request = capsys.readouterr().err.splitlines()
    assert any("in stumble" in line for line in trace)
    assert trace[-1].endswith(f"{type(fault).__name__}: of ours")
    assert "please report it" in request


def test_what_takes_more_memory_than_there_is_is_said_in_a_line(monkeypatch, capsys):
    def fill(*_, **__):
        raise MemoryError("Unable to allocate 9 GiB")

    monkeypatch.setattr(table, "solve", fill)
    assert run("compare", "two-edges-clamped", "--quiet") == 2
    assert one_line(capsys).startswith("sheetbench: not enough memory: Unable to allocate 9 GiB; take fewer")


@pytest.mark.usefixtures("undrawn")
def test_a_solver_that_does_not_converge_leaves_with_3_and_keeps_its_answer(quick, tmp_path, capsys):
    scene = scenes.load("two-edges-clamped")
    quick["lumped"] = fake_solutions.solution(scene, status=Status.DIVERGED, load_factor=0.4)
    assert run("compare", "two-edges-clamped", "--calibration", "uniform", "--out", str(tmp_path)) == 3
    printed = capsys.readouterr()
    assert "diverged" in printed.out
    assert "diverged at 40 % of the load" in printed.err
    assert Status.DIVERGED.advice in " ".join(printed.err.split())
    document = json.loads((tmp_path / "comparison.json").read_text(encoding="utf-8"))
    assert document["solutions"][0]["status"] == "diverged"
    assert document["solutions"][0]["load_factor"] == 0.4
    assert (tmp_path / "lumped.vtu").exists()


def test_what_is_finished_is_kept_when_a_later_model_fails(monkeypatch, tmp_path, capsys):
    def answer(model, name="", near=None):
        if model.spec.model == "shell":
            raise KeyboardInterrupt
        return fake_solutions.solution(model.scene, name)

    monkeypatch.setattr(table, "solve", answer)
    assert run("compare", "two-edges-clamped", "--out", str(tmp_path)) == interruption.STATUS
    assert f"files written so far are in {tmp_path}" in capsys.readouterr().err
    assert {path.name for path in tmp_path.iterdir()} == {"lumped.vtu", "manifest.json"}
    (record,) = json.loads((tmp_path / "manifest.json").read_text(encoding="utf-8"))["runs"].values()
    assert record["files"] == ["lumped.vtu"] and not record["finished"]


def test_an_interrupt_within_compiled_code_is_an_interrupt(monkeypatch, capsys):
    def answer(*_, **__):
        raise SystemError("returned a result with an exception set") from KeyboardInterrupt()

    monkeypatch.setattr(table, "solve", answer)
    assert run("compare", "two-edges-clamped") == interruption.STATUS
    assert capsys.readouterr().err.strip().endswith("interrupted; nothing was kept")


@pytest.mark.sweep(2)
@pytest.mark.parametrize("line", ["check --schema", "score --json", "compare --help"])
def test_an_output_that_nobody_reads_on_is_no_fault(line):
    """As `| head` leaves it: quiet, with the status of a program that SIGPIPE ends."""
    with subprocess.Popen(
        [*PROGRAM, *line.split()], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        process.stdout.close()
        said = process.stderr.read()
    assert (process.returncode, said) == (141, b"")


@pytest.mark.sweep(2)
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
@pytest.mark.parametrize("arguments", [("check",), ("check", "--json"), ("--help",), ("--version",)], ids=str)
def test_an_output_that_cannot_be_written_is_said_in_a_line(arguments):
    with open("/dev/full", "wb") as full:
        done = subprocess.run([*PROGRAM, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 2
    assert done.stderr == "sheetbench: the output cannot be written: no space left on device\n"


def test_a_size_of_the_terminal_that_cannot_be_counts_for_nothing():
    plain = {name: value for name, value in os.environ.items() if name != "COLUMNS"}
    usual, *odd = (
        subprocess.run([*PROGRAM, "--help"], env=plain | given, capture_output=True, text=True)
        for given in ({}, {"COLUMNS": "0", "LINES": "²"}, {"COLUMNS": "9" * 12, "LINES": "0"})
    )
    for one in odd:
        assert (one.returncode, one.stdout, one.stderr) == (0, usual.stdout, "")


def test_collections_are_fewest_while_a_verb_imports():
    startup.begin()
    try:
        assert gc.get_threshold()[0] == startup.IMPORT_THRESHOLD
        assert run("check", "two-edges-clamped") == 0
        assert startup.DEFAULTS[0] < gc.get_threshold()[0] == startup.WORKING < startup.IMPORT_THRESHOLD
    finally:
        gc.unfreeze()
        gc.set_threshold(*startup.DEFAULTS)


# ---- studies: refused without a checkout
ROOT = Path(__file__).parents[3]


def test_studies_are_listed_and_each_has_a_help_page(capsys):
    assert run("study") == 0
    listed = capsys.readouterr().out
    for name in STUDIES:
        assert f"\n{name} " in listed
        assert run("study", name, "--help") == 0
        assert f"sheetbench study {name}" in capsys.readouterr().out


def test_every_study_is_in_the_documentation_and_has_a_make_target():
    page = (ROOT / "docs" / "studies.md").read_text(encoding="utf-8")
    targets = (ROOT / "studies" / "Makefile").read_text(encoding="utf-8")
    for name in STUDIES:
        assert f"| `{name}` |" in page and f"sheetbench study {name}" in targets


@pytest.mark.parametrize("name", [(), ("promises",)])
def test_an_installed_package_names_the_way_to_the_studies(name, tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(study, "CHECKOUT", tmp_path)
    assert run("study", *name) == 2
    assert "study: studies are not installed; in a clone of the repository run" in one_line(capsys)
    assert run("study", "--help") == 0
