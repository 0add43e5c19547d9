"""--quiet leaves results, warnings and errors; that every verb takes it: test_every_verb.py."""

import logging

import pytest
from commands import run

from comparisons.cli import console
from comparisons.cli import lines as cli_lines
from comparisons.cli.verb import as_verb
from comparisons.pictures import work
from comparisons.sweep.campaign import Progress

SMALL = ("compare", "one-edge-clamped", "--lumped", "3", "--elements", "2", "--no-uncertainty", "--json")


@pytest.fixture
def chatty(monkeypatch):
    """A command that says all that there is to say."""
    monkeypatch.setattr(cli_lines, "QUIET", 0.0)
    monkeypatch.setattr(work, "LONG", 0.0)

    def command():
        with console.progress() as show:
            show(Progress(1, 2, "a run", "converged", None))
        console.tell("kernels are compiled first")
        console.note("the result")
        console.warn("a warning")

    return as_verb("any", command)


@pytest.mark.parametrize("quiet", [False, True])
def test_quiet_leaves_results_and_warnings(chatty, quiet, capsys):
    chatty(quiet=quiet, verbose=False, no_pictures=False)
    printed = capsys.readouterr()
    assert printed.out == "the result\n"
    progress = [] if quiet else ["1/2 a run: converged", "kernels are compiled first"]
    assert printed.err.splitlines() == [*progress, "a warning"]


def test_quiet_is_quiet_of_what_the_packages_log(capsys):
    from comparisons.cli import messages

    with messages.in_lines(), console.speaking(quiet=True):
        logging.getLogger("sheetbench").info("compiling")
    assert capsys.readouterr().err == ""


def test_a_comparison_says_in_a_pipe_what_lasts_and_nothing_where_it_is_quiet(monkeypatch, capsys):
    monkeypatch.setattr(cli_lines, "QUIET", 3600.0)  # however slow this machine is today
    assert run(*SMALL) == 0 and capsys.readouterr().err == ""
    monkeypatch.setattr(work, "LONG", 0.0)
    assert run(*SMALL, "--quiet") == 0
    quiet = capsys.readouterr()
    assert quiet.err == "" and quiet.out.startswith("{")
    assert run(*SMALL) == 0  # it is over with the command
    assert "solving shell, 2 × 2 elements (125 unknowns, about 0 s) …" in capsys.readouterr().err.splitlines()
