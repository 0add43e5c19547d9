"""Garbage collections are few while a verb imports, and as usual once it works."""

import gc

from commands import run

from comparisons.cli import startup


def test_collections_are_as_usual_once_a_verb_works():
    startup.begin()
    assert gc.get_threshold()[0] == startup.ALLOCATIONS > startup.USUAL[0]
    assert run("check", "two-edges-clamped") == 0
    assert gc.get_threshold() == startup.USUAL


def test_the_list_of_verbs_is_whole_in_a_narrow_terminal(capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", "60")
    assert run("--help") == 0
    words = " ".join(capsys.readouterr().out.split())
    assert (
        "..." not in words.replace("[ARGS]...", "")
        and "Solve a scene with the lattice and a reference, side by side." in words
    )
