"""What an answer says of itself: facts in fields, a line for people, advice that can be followed."""

import re

from fake_solutions import solution

import fem_reference
from comparisons.cli.app import verb_group
from fem_reference.shell import statics
from fem_reference.shell.validity import STRETCHED
from sheetbench import scenes
from sheetbench.answers.solution import Status


def test_the_message_is_fallback_snaps_and_notes_in_a_line():
    scene = scenes.load("one-edge-clamped")
    assert solution(scene).message == ""
    found = solution(scene, snaps=(0.25, 0.56789), fallback="divided evenly", remarks=("seen", "heard"))
    assert found.message == (
        "divided evenly; snapped at load factor 0.25; snapped at load factor 0.5679; seen; heard"
    )


def test_advice_names_options_that_compare_has():
    known = {
        option
        for command in verb_group().commands.values()
        if command.name == "compare"
        for parameter in command.params
        for option in parameter.opts
    }
    named = {option for status in Status for option in re.findall(r"--[a-z-]+", status.advice)}
    assert named == {"--lumped", "--elements", "--branch"} and named <= known
    assert not any("steps" in status.advice for status in (Status.DIVERGED, Status.INVERTED))


def test_a_sheet_divided_evenly_after_all_says_so_in_a_field(monkeypatch):
    scene = scenes.load("one-edge-clamped")
    even = statics.solve(scene, elements=4, graded=False)
    monkeypatch.setattr(statics, "stretched", lambda path: STRETCHED)
    found = fem_reference.solve(scene, model="shell", elements=4)
    assert found.fallback == found.message == "divided evenly, for it bends much" and not even.fallback
    assert found.settings == even.settings and found.status is Status.CONVERGED
    assert found.iterations > even.iterations and len(found.history) > len(even.history)
    assert (found.displacement([scene.probes["P4"]]) == even.displacement([scene.probes["P4"]])).all()
