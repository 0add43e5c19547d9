"""What is said while people wait, how far it has come; little in a pipe, nothing with --quiet."""

import io
import sys
from functools import partial
from typing import Any

import pytest
from commands import run
from rich.console import Console
from verbs import write_inputs

import fem_reference
import lumped
import sheetbench as sb
from comparisons.calibration.calibrate import calibrate
from comparisons.cli import console
from comparisons.cli.app import main
from comparisons.cli.verb import as_verb
from comparisons.models.context import running
from comparisons.models.spec import Lattice
from comparisons.models.training import training_scenes
from comparisons.pictures import work
from comparisons.pictures.work import Work
from comparisons.sweep.campaign import GOING, Progress
from sheetbench.answers.size import Size
from sheetbench.answers.solution import Iteration

SCENE = "two-edges-clamped"
QUICK, SLOW = Size(100, 1e6, 0.1), Size(1_234_567, 1e9, 300.0)


@pytest.fixture
def said(monkeypatch):
    """Progress without a terminal, and a clock that is set by hand."""
    screen, now = io.StringIO(), [100.0]
    monkeypatch.setattr(console, "err", Console(file=screen, width=100))
    monkeypatch.setattr(console, "monotonic", lambda: now[0])
    with console.progress() as say:
        yield say, screen, now


def test_long_work_is_reported_at_intervals(said):
    say, screen, now = said
    one = Work("solving shell", QUICK)
    say(one)
    now[0] += console.QUIET
    say(one)
    for step in range(10):
        now[0] += console.BETWEEN / 10
        say(one.at(0.1 * (step + 1)))
    assert screen.getvalue().splitlines() == ["solving shell …", "solving shell: 100 % of the load"]


def test_what_will_last_is_said_before_it_starts(said):
    say, screen, _ = said
    say(Work("solving solid", SLOW))
    say(Work("solving solid", SLOW).at(0.25))
    assert screen.getvalue() == "solving solid (1.23 million unknowns, about 5 min) …\n"
    assert str(Work("solving solid", SLOW).at(0.25)).endswith("about 5 min): 25 % of the load")
    assert str(Work("solving shell").at(51.35)) == "solving shell: following its path beyond the load"


@pytest.mark.parametrize("model", ["lumped", "shell", "solid"])
def test_every_iteration_is_told_with_its_load_factor(model):
    reports: list[Iteration] = []
    solve = lumped.solve if model == "lumped" else partial(fem_reference.solve, model=model, elements=2)
    solution = solve(SCENE, progress=reports.append)
    assert tuple(reports) == solution.history and reports[-1].load_factor == 1.0


def test_a_comparison_tells_what_it_solves_and_how_far_it_is():
    reports: list[Work] = []
    sb.compare(sb.load(SCENE), grid=3, elements=4, progress=reports.append)
    begun = [one.doing for one in reports if one.share is None]
    assert begun == [
        "solving lumped, 3 × 3 × 2 masses",
        "solving shell, 4 × 4 elements",
        "solving lumped-uniform, 3 × 3 × 2 masses",
        "solving lumped on a finer grid, 13 × 13 × 2 masses",
        "solving shell, 3 × 3 elements",
        "solving shell, 2 × 2 elements",
    ]
    assert {one.doing for one in reports if one.share == 1.0} == set(begun)
    assert all(one.size is not None and one.size.unknowns > 0 for one in reports)


def test_modes_and_identify_report_progress(tmp_path):
    reports: list[Any] = []
    sb.modes(SCENE, grid=3, elements=2, count=2, progress=reports.append)
    assert [one.doing for one in reports] == ["modes of lumped", "modes of shell"]
    write_inputs(tmp_path)
    sb.identify(SCENE, tmp_path / "measured.csv", model="shell", elements=2, progress=reports.append)
    assert any(isinstance(one, Work) and one.share == 1.0 for one in reports)
    assert any(isinstance(one, str) and one.startswith("young = ") for one in reports)


def test_a_fit_tells_what_it_is_trained_on():
    reports: list[Work] = []
    seed, spec = sb.load("two-edges-clamped"), Lattice(4, "fit-modal")
    scene = training_scenes(seed.sheet, seed.material)[0]
    with running(progress=reports.append):
        calibrate(scene, spec, named=False)
    assert [one.doing.split()[0] for one in reports] == ["training", "training", "fitting"]


@pytest.mark.parametrize("terminal", [True, False])
def test_a_campaign_shows_the_run_that_goes_on(monkeypatch, terminal):
    monkeypatch.setattr(console, "QUIET", 0.0)
    screen = io.StringIO()
    monkeypatch.setattr(console, "err", Console(file=screen, force_terminal=terminal, width=100))
    with console.progress() as progress:
        progress(Progress(0, 9, "solid 24", GOING, None, ("solid 24", "shell 32", "shell 16")))
        while "solid 24" not in screen.getvalue():
            pass
        progress(Progress(1, 9, "solid 24", "converged", 70.0, ("shell 32",)))
    assert "solid 24, and 2 more" in screen.getvalue()
    assert "1/9 done; solid 24: converged; running: shell 32" in screen.getvalue() or terminal
    assert "70 s left" in screen.getvalue()


SMALL = ("compare", "one-edge-clamped", "--lumped", "3", "--elements", "2", "--no-uncertainty", "--json")


@pytest.mark.parametrize("quiet", [False, True])
def test_quiet_leaves_results_and_warnings(monkeypatch, quiet, capsys):
    """Of a command that says all that there is to say."""
    monkeypatch.setattr(console, "QUIET", 0.0)

    def command():
        with console.progress() as show:
            show(Progress(1, 2, "a run", "converged", None))
        console.print_status("kernels are compiled first")
        console.note("the result")
        console.warn("a warning")

    as_verb("any", command)(quiet=quiet, verbose=False, no_pictures=False)
    printed = capsys.readouterr()
    assert printed.out == "the result\n"
    progress = [] if quiet else ["1/2 done; a run: converged", "kernels are compiled first"]
    assert printed.err.splitlines() == [*progress, "a warning"]


def test_a_comparison_says_in_a_pipe_what_lasts_and_nothing_where_it_is_quiet(monkeypatch, capsys):
    monkeypatch.setattr(console, "QUIET", 3600.0)  # however slow this machine is today
    assert run(*SMALL) == 0 and capsys.readouterr().err == ""
    monkeypatch.setattr(work, "LONG", 0.0)
    assert run(*SMALL, "--quiet") == 0
    quiet = capsys.readouterr()
    assert quiet.err == "" and quiet.out.startswith("{")
    assert run(*SMALL) == 0  # it is over with the command
    assert "solving shell, 2 × 2 elements (125 unknowns, about 0 s) …" in capsys.readouterr().err.splitlines()


def test_what_an_encoding_lacks_is_no_fault(monkeypatch):
    stream = io.TextIOWrapper(io.BytesIO(), encoding="latin-1")
    monkeypatch.setattr(sys, "stdout", stream)
    with pytest.raises(SystemExit) as left:
        main(["calibrate", SCENE, "--lumped", "3", "--quiet"])
    stream.flush()
    assert left.value.code == 0 and "?" in stream.buffer.getvalue().decode("latin-1")
