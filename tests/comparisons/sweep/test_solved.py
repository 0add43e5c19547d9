"""One table of solves: every question's bar, errors and pairs from the same rows."""

import numpy as np
import pytest
from campaigns import Here

from comparisons.comparison.comparison import compare
from comparisons.comparison.crosscheck import crosscheck
from comparisons.models.spec import Elements, Lattice
from comparisons.sweep import columns
from comparisons.sweep.differences import error
from comparisons.sweep.limits import Limit, limit, pairs
from comparisons.sweep.solved import Ask, sweep
from comparisons.tradeoff.statics import tradeoff
from comparisons.tradeoff.trials import TrialSolves
from sheetbench.scenes import load

SEED = load("two-edges-clamped")
MESHES = [Elements("shell", n) for n in (8, 6, 4)]


def test_questions_are_readings_of_the_same_rows(store):
    """Bar, error and pair to the last digit, whoever wants them."""
    lattices = [Lattice(n, "consistent") for n in (3, 5)]
    rows = sweep([Ask(SEED, spec) for spec in (*MESHES, *lattices)], store, pool=Here)
    shells, own = rows[:3], rows[3:]
    bar = limit(shells)
    assert bar is not None
    compared = compare(SEED, lattices[1], elements=8, companion=False)
    assert compared.bar is not None and compared.bar.error == bar.error
    assert compared.error(compared.solutions[0]) == error(own[1].u, shells[0].u)
    traded = tradeoff(SEED, lattices, store, reference=MESHES[0], repeats=1, pool=Here)
    assert traded.uncertainty == bar.error
    assert [row.error for row in traded.rows] == [error(row.u, shells[0].u) for row in own]
    trials = TrialSolves(SEED)
    assert all(trials.refine() for _ in MESHES)
    assert trials.uncertainty == pytest.approx(bar.error, rel=1e-12)  # of (8, 8) elements, not 8
    checked = crosscheck([SEED], store, models={"lumped": lattices, "shell": MESHES}, pool=Here)
    assert checked.pairs == pairs([Limit.of("lumped", own), Limit.of("shell", shells)])


def test_a_column_is_a_function_of_scene_and_answer(store, monkeypatch):
    monkeypatch.setitem(columns.COLUMNS, "strain energy", lambda scene, answer: answer.energies)
    (row,) = sweep([Ask(SEED, Elements("plate", 2), columns=("strain energy",))], store, pool=Here)
    assert row.row["columns"]["strain energy"] == row.document["energies"]


def test_tags_and_labels_make_no_other_row():
    """A model, its settings, a column, times and a program's version do."""
    same = Ask(SEED, Lattice(3), tags={"factor": 2.0}, label="other")
    more = ({}, {"repeats": 1}, {"columns": ("bar",)}, {"version": "2"}, {"duration": 1.0, "every": 0.1})
    tasks = [Ask(SEED, Lattice(3), **one).task for one in more] + [Ask(SEED, Lattice(4)).task]
    assert same.task.key == tasks[0].key and len({one.key for one in tasks}) == len(tasks)
    assert [one.timed for one in tasks] == [False, True, False, False, False, False]


def test_a_motion_is_a_row_with_a_history(store):
    scene = load("two-edges-settling")
    run = {"integrator": "midpoint", "step": 1e-3}
    (row,) = sweep([Ask(scene, Lattice(3), duration=4e-3, every=2e-3, run=run)], store, pool=Here)
    assert row.usable and row.history is not None and row.row["unknowns"] > 0
    np.testing.assert_allclose(row.history.time, [0.0, 2e-3, 4e-3])
    assert row.u.shape == (3 * len(scene.probes), 3) and row.row["cost"]["peak_memory_bytes"] >= 0
