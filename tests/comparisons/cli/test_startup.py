"""Garbage collections are few while a verb imports, and as usual once it works."""

import gc

from commands import run

from comparisons.cli import startup


def test_collections_are_as_usual_once_a_verb_works():
    startup.begin()
    assert gc.get_threshold()[0] == startup.ALLOCATIONS > startup.USUAL[0]
    assert run("check", "two-edges-clamped") == 0
    assert gc.get_threshold() == startup.USUAL
