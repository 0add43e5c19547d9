"""What tables, a picture and lists of cells hold, where nothing else would notice another number."""

from inspect import signature
from types import SimpleNamespace

import numpy as np
import pytest
from matplotlib.pyplot import subplots

import fem_reference
import lumped
from comparisons.cli import modes
from comparisons.models.spec import Elements, spec_of
from comparisons.modes.spectra import spectra
from comparisons.modes.state_space import Linearisation
from comparisons.sweep.solved import Request
from comparisons.tradeoff import figure as tradeoff_figure
from comparisons.tradeoff import trials
from comparisons.tradeoff.answer import DynamicTradeoff, Tradeoff
from comparisons.tradeoff.row import TradeoffRow
from lumped.calibration.tables import moduli
from sheetbench import scenes


def shown(table):
    """The first row as people read it, by column."""
    return dict(zip((column.name for column in table.columns), table.shown_rows()[0], strict=True))


def test_a_modulus_is_off_its_target_by_the_difference():
    modulus = {"name": "D11", "asked": 2.0, "got": 1.5}
    calibration = {"moduli": [modulus], "springs": {}, "grid": [3, 3, 2]}
    row = shown(moduli(calibration))
    assert float(row["off target by"].replace("−", "-")) == -25.0


def test_a_terminal_shows_of_a_tradeoff_what_is_read_off_its_front():
    scene = scenes.load("two-edges-clamped")
    row = TradeoffRow(Request(scene, Elements("shell", 2)), "converged")
    table, _ = Tradeoff(scene, (), row, None, None).tables()
    assert [column.name for column in table.columns if not column.detail] == [
        "row", "model", "size", "unknowns", "solve", "memory", "error", "field error", "front",
    ]  # fmt: skip


def test_time_is_predicted_by_the_models_own_family():
    def lattice(masses):
        return spec_of("lumped", {"grid": [masses, masses, 2]})

    shell, plate = (spec_of(model, {"elements": [8, 8]}) for model in ("shell", "plate"))
    took = ((lattice(5), 0.001), (shell, 0.1), (lattice(9), 0.008))
    rows = {one: SimpleNamespace(request=SimpleNamespace(spec=one), seconds=seconds) for one, seconds in took}
    models = (shell, lattice(17), shell.but(count=(16, 16)), plate)
    found = [trials.TrialSolves.predicted_seconds(SimpleNamespace(rows=rows), one) for one in models]
    # as measured; 8 times as long for 4 times the cells; by the usual power of one; by the unknowns alone
    assert found == pytest.approx([0.1, 0.064, 0.1 * 4**trials.EXPONENT, trials.unknowns(plate) * 1e-5])


def test_a_tradeoffs_axis_holds_its_errors_and_the_bar_in_percent():
    rows = [SimpleNamespace(error=error) for error in (0.002, 0.3, 0.0)]
    _, axis = subplots()
    tradeoff_figure.floor(axis, SimpleNamespace(rows=rows, uncertainty=0.01), "bar")
    assert axis.get_ylim() == pytest.approx((0.6 * 0.2, 1.6 * 30.0))


def test_a_front_without_a_bar_has_every_row_that_errs_less_for_more_time():
    rows = [SimpleNamespace(error=e, cost=t) for e, t in ((0.2, 1.0), (0.1, 2.0), (0.1, 3.0))]
    for bar, front in ((None, [0, 1]), (0.5, [0])):
        found = SimpleNamespace(rows=rows, uncertainty=bar)
        assert DynamicTradeoff.front.fget(found) == front


def test_unless_told_otherwise_functions_and_commands_ask_for_as_many_modes():
    calls = (spectra, lumped.modes, fem_reference.modes, modes.command)
    assert [signature(call).parameters["count"].default for call in calls] == [10] * 4


def test_a_pole_is_shown_in_hertz_and_its_damping_in_percent():
    found = SimpleNamespace(upper=np.array([-3.0 + 4.0j]), damping_ratios=np.array([0.6]))
    row = shown(Linearisation._poles(found))
    assert float(row["frequency"]) == pytest.approx(5.0 / (2.0 * np.pi), rel=1e-4)
    assert (float(row["damping ratio"]), float(row["imaginary"])) == (60.0, 4.0)


def test_grading_changes_no_rate_and_a_calibration_does():
    even, graded, other = (
        spec_of("lumped", {"grid": [9, 9], "calibration": name, **more})
        for name, more in (("consistent", {}), ("consistent", {"grading": 0.5}), ("uniform", {}))
    )
    assert trials._time_series(even) == trials._time_series(graded) != trials._time_series(other)
