"""One table of solves: bars, errors and pairs of every question from the same rows; models' limits."""

import numpy as np
import pytest
from campaigns import Serial

from comparisons.comparison.comparison import compare
from comparisons.comparison.crosscheck import crosscheck
from comparisons.models.spec import Elements, Lattice
from comparisons.sweep import columns
from comparisons.sweep.differences import error
from comparisons.sweep.limits import Limit, limit, motion_bar, pair, pairs, total_bar
from comparisons.sweep.solved import Request, Solved, sweep
from comparisons.tradeoff.statics import tradeoff
from comparisons.tradeoff.trials import TrialSolves
from sheetbench.scenes import load

SEED = load("two-edges-clamped")
MESHES = [Elements("shell", n) for n in (8, 6, 4)]


def test_questions_are_readings_of_the_same_rows(store):
    """Bar, error and pair to the last digit, whoever wants them."""
    lattices = [Lattice(n, "consistent") for n in (3, 5)]
    rows = sweep([Request(SEED, spec) for spec in (*MESHES, *lattices)], store, pool=Serial)
    shells, own = rows[:3], rows[3:]
    bar = limit(shells)
    assert bar is not None
    compared = compare(SEED, lattices[1], elements=8, companion=False)
    assert compared.bar is not None and compared.bar.error == bar.error
    assert compared.error(compared.solutions[0]) == error(own[1].u, shells[0].u)
    traded = tradeoff(SEED, lattices, store, reference=MESHES[0], repeats=1, pool=Serial)
    assert traded.uncertainty == bar.error
    assert [row.error for row in traded.rows] == [error(row.u, shells[0].u) for row in own]
    trials = TrialSolves(SEED)
    assert all(trials.refine() for _ in MESHES)
    assert trials.uncertainty == pytest.approx(bar.error, rel=1e-12)  # of (8, 8) elements, not 8
    checked = crosscheck([SEED], store, models={"lumped": lattices, "shell": MESHES}, pool=Serial)
    assert checked.pairs == pairs([Limit.of("lumped", own), Limit.of("shell", shells)])


def test_a_column_is_a_function_of_scene_and_answer(store, monkeypatch):
    monkeypatch.setitem(columns.COLUMNS, "strain energy", lambda scene, answer: answer.energies)
    (row,) = sweep([Request(SEED, Elements("plate", 2), columns=("strain energy",))], store, pool=Serial)
    assert row.row["columns"]["strain energy"] == row.document["energies"]


def test_keys_of_rows_ignore_tags_and_labels():
    """A model, its settings, a column, times and a program's version do."""
    same = Request(SEED, Lattice(3), tags={"factor": 2.0}, label="other")
    more = ({}, {"repeats": 1}, {"columns": ("bar",)}, {"version": "2"}, {"duration": 1.0, "every": 0.1})
    tasks = [Request(SEED, Lattice(3), **one).task for one in more] + [Request(SEED, Lattice(4)).task]
    assert same.task.key == tasks[0].key and len({one.key for one in tasks}) == len(tasks)
    assert [one.timed for one in tasks] == [False, True, False, False, False, False]


def test_a_motion_is_a_row_with_a_history(store):
    scene = load("two-edges-settling")
    run = {"integrator": "midpoint", "step": 1e-3}
    (row,) = sweep([Request(scene, Lattice(3), duration=4e-3, every=2e-3, run=run)], store, pool=Serial)
    assert row.usable and row.history is not None and row.row["unknowns"] > 0
    np.testing.assert_allclose(row.history.time, [0.0, 2e-3, 4e-3])
    assert row.u.shape == (3 * len(scene.probes), 3) and row.row["cost"]["peak_memory_bytes"] >= 0


def standing(name, limit, error, meshes=(4, 6, 8)):
    """A model whose every displacement is limit + error h² [m], its cells of size h = 1/n of a side."""

    def row(n):
        probes = dict.fromkeys(SEED.probes, np.full(3, limit + error / n**2))
        known = {"load_factor": 1.0, "settings": {"grid": [n + 1, n + 1, 2]}, "probes": probes}
        return Solved(Request(SEED, Lattice(n + 1)), "converged", row=known)

    return Limit.of(name, [row(n) for n in meshes])


@pytest.mark.parametrize(
    ("meshes", "shown", "bar"),
    [
        ((8,), "9", None),
        ((6, 8), "7, 9", 3.0),
        ((4, 6, 8), "5, 7, 9", 1.35),
        ((3, 4, 6, 8), "4, 5, 7, 9", 1.35),
    ],
)
def test_a_limit_has_the_bar_of_its_three_finest_meshes(meshes, shown, bar):
    """Two meshes have a cautious one, one has none."""
    one = standing("one", -0.01, 0.002, meshes)
    assert one.meshes == shown and one.finest is one.rows[-1] and (one.uncertainty is None) == (bar is None)
    if one.uncertainty is not None:
        np.testing.assert_allclose(one.uncertainty.extrapolated, -0.01, rtol=1e-9)
        np.testing.assert_allclose(one.uncertainty.bar, bar * 0.002 / 64, rtol=1e-6)
    else:
        assert pair(one, standing("two", -0.01, 0.002)) is None


def test_the_bar_of_a_motion_is_what_twice_the_mesh_and_twice_the_step_change():
    """Of second order, with a caution of 3: 3 |Δ|/(2² − 1), over the largest displacement."""

    def moved(count, u, status="converged"):
        ask = Request(SEED, Elements("shell", count), duration=1.0)
        return Solved(ask, status, row={"probes": {"P1": np.array([[0.0, 0.0, 0.0], [0.0, 0.0, u]])}})

    fine, longer = moved(8, 0.2), moved(8, 0.198)
    bars = motion_bar([fine, moved(4, 0.19)], longer)
    assert bars == pytest.approx({"mesh": 0.05, "step": 0.01}) and total_bar(bars) == pytest.approx(0.06)
    assert motion_bar([fine, moved(4, 0.19, "diverged")], longer) == {"mesh": None, "step": bars["step"]}
    three = [moved(n, 0.2 - 0.64 / n**3) for n in (8, 6, 4)]  # of order 3, of which 2 counts
    pairs = (8, 6), (8, 4), (6, 4)
    error = 0.64 * max((m**-3 - n**-3) / ((8 / m) ** 2 - (8 / n) ** 2) for n, m in pairs)
    assert motion_bar(three, longer)["mesh"] == pytest.approx(1.35 * error / three[0].u.max())
    assert total_bar({"mesh": None, "step": 0.01}) is None and total_bar({}) is None


@pytest.mark.parametrize("share", [0.9, 1.1])
def test_models_are_told_apart_by_more_than_both_bars_alone(share):
    error = 0.002
    bars = (1.0 + 3.0) * 1.35 * error / 64
    there = pair(standing("here", -0.01, error), standing("there", -0.01 - share * bars, 3.0 * error))
    assert there is not None
    assert there.distinguishable_at == (() if share < 1.0 else ("P1", "P2", "P3", "P4"))
    assert there.difference == pytest.approx(share * bars / 0.01, rel=1e-6)
    assert there.bars == pytest.approx(bars / 0.01, rel=1e-6)


def test_rounding_tells_nothing_apart():
    """Two answers that no mesh changes have no bar; what programs print ends somewhere."""
    here = standing("here", -0.01, 0.0)
    near, far = (standing("there", -0.01 * (1 + off), 0.0) for off in (4e-6, 4e-5))
    differ = [pair(here, there) for there in (near, far)]
    assert [bool(one and one.distinguishable_at) for one in differ] == [False, True]


def test_meshes_that_a_model_refuses_are_no_failures():
    rows = [Solved(Request(SEED, Lattice(5)), end, message="why") for end in ("refused", "diverged")]
    found = Limit.of("one", rows)
    assert found.failures == [rows[1].ending] and not found.refused
    assert Limit.of("one", rows[:1]).refused and not Limit.of("one", rows[:1]).failures
