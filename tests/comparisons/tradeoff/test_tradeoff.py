"""Trade-offs: the front, the orders, what is measured against what, and the command from end to end."""

import csv
import json

import numpy as np
import pytest
from campaigns import Serial
from commands import run
from verbs import run_here

from comparisons.models.spec import Elements, External, Lattice, lattices, parse, references
from comparisons.sweep import load
from comparisons.sweep.peak_memory import with_peak_memory
from comparisons.sweep.solved import Solved
from comparisons.tradeoff import statics
from comparisons.tradeoff.motion import dynamic_tradeoff
from sheetbench import scenes
from sheetbench.answers.files import to_json
from sheetbench.errors import BadInput

SMALL = [
    *("tradeoff", "two-edges-clamped", "--lumped", "3,5", "--calibration", "consistent,uniform"),
    *("--plate", "", "--shell", "2,4", "--solid", "", "--elements", "8", "--repeats", "2"),
]


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """The folder of a small trade-off."""
    folder = tmp_path_factory.mktemp("tradeoff")
    with pytest.MonkeyPatch.context() as patch:
        run_here(patch)
        assert run(*SMALL, "--out", str(folder)) == 0
    return folder


def test_lists_of_sizes_become_rows_with_near_square_cells():
    scene = scenes.load("one-edge-clamped").replace(length_x=0.1, length_y=0.2, thickness=0.001)
    found = lattices(scene, ["5", "3x4x3"], ["consistent", "uniform"])
    assert [c.settings["grid"] for c in found] == [[5, 9, 2], [3, 4, 3]] * 2
    assert found[3].series == "lumped uniform 3 layers"
    assert Elements("shell", 4).series == "shell"
    own = External("mine", {"grid": 9, "fast": True, "slow": False, "kind": "a"})
    assert own.series == "mine fast kind a"
    assert parse("mine:grid=9,soft=true,kind=a") == External("mine", {"grid": 9, "soft": True, "kind": "a"})
    for text in ("mine:grid", "mine:=3,x"):
        with pytest.raises(BadInput, match="--model"):
            parse(text)
    with pytest.raises(BadInput, match="--shell = 'x'"):
        references("shell", ["x"])


def test_memory_is_that_of_the_run():
    _, memory = with_peak_memory(lambda: np.ones(8_000_000).sum())
    assert memory == pytest.approx(64e6, rel=0.1)


@pytest.mark.parametrize(("finest", "known"), [("converged", True), ("diverged", False)])
def test_a_reference_has_a_bar_where_its_finest_answer_can_be_used(monkeypatch, finest, known):
    def row(ask, status):
        u = [0.0, 0.0, 1.0 + ask.spec.count**-2]
        known = {"probes": {"P": u}, "columns": {"field": [u]}, "load_factor": 1.0}
        return Solved(ask, status, row=known | {"settings": ask.spec.settings})

    def solved(requests, *_, **__):
        return [row(ask, "converged" if n else finest) for n, ask in enumerate(requests)]

    monkeypatch.setattr(statics, "sweep", solved)
    found = statics.tradeoff(
        scenes.load("two-edges-clamped"), [Elements("shell", 3)], None, reference=Elements("shell", 8)
    )
    assert (found.uncertainty is not None) == (found.rows[0].error is not None) == known


def test_a_tradeoff_has_all_its_rows(finished):
    document = json.loads((finished / "tradeoff.json").read_text(encoding="utf-8"))
    rows = document["rows"]
    assert [row["model"] for row in rows] == ["lumped"] * 4 + ["shell"] * 2
    for row in rows:
        assert row["status"] == "converged" and 0.0 < row["error"] < row["field_error"] < 0.2
        samples = row["solve_seconds"]["samples"]
        assert len(samples) >= 2 and row["solve_seconds"]["median"] == pytest.approx(np.median(samples))
        assert min(samples) > 0.0 and row["peak_memory_bytes"] >= 0
        assert {"python", "processor", "cpu_count"} <= set(row["machine"])
        assert {"sheetbench", "numpy", "scipy"} <= set(row["versions"])
    assert rows[1]["error"] < rows[3]["error"]  # consistent and uniform
    assert 0.0 < document["reference"]["uncertainty"] < 0.01
    errors = [rows[i]["error"] for i in document["front"]]
    assert errors == sorted(errors, reverse=True)
    series = {entry["series"] for entry in document["orders"]}
    assert series == {"lumped consistent", "lumped uniform", "shell"}
    with (finished / "tradeoff.csv").open(encoding="utf-8") as file:
        assert len(list(csv.DictReader(file))) == 6


@pytest.mark.nightly
def test_the_trade_of_a_motion_finds_the_order_of_its_integrators(store):
    found = dynamic_tradeoff(
        scenes.load("two-edges-settling"), 0.6, store,
        lattices=[Lattice(grid=(3, 3, 2))], others=[Elements("shell", 1), Elements("plate", 1)],
        reference=Elements("shell", 2), integrators=("generalised-alpha", "midpoint"),
        divisions=(40, 80, 160), fine=800, pool=Serial,
    )  # fmt: skip
    of_lattice, others = found.rows[:6], found.rows[6:]
    assert [row.model for row in others] == 2 * ["shell"] + 2 * ["plate"]
    assert all(row.status == "converged" and row.cost > 0.0 for row in found.rows)
    assert found.uncertainty is not None and found.step_uncertainty < 1e-4
    assert list(found.orders.values()) == pytest.approx([2.0, 2.0], abs=0.15)
    assert all(row.step_error < 1e-3 for row in of_lattice if row.step < found.lowest_period / 150)
    assert all(row.step_error is None and row.error > 0.0 for row in others)
    assert found.reference.error == 0.0
    assert of_lattice[0].damping == pytest.approx(of_lattice[-1].damping, rel=0.1)
    assert found.front and json.loads(to_json(found.document()))["rows"]


def test_times_under_load_and_samples_that_scatter_are_told(monkeypatch):
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    costs = [{"load_average": average, "machine": {"cpu_count": 4}} for average in (3.0, None, 20.0)]
    assert load.warnings([{"load_average": 2.0}, {}, *costs[:2]], [(1.0, 1.9), (1.0,)]) == []
    busy, wide = load.warnings(costs[::2], [(1.0, 3.0), (1.0, 1.1)])
    assert busy.startswith("1 of 2 times are not reliable: other programs were running (load 20 on 4 ")
    assert wide.startswith("1 of 2 timings vary by more than a factor of 2, by up to 3")
