"""A scene's motion by the lattice and by a reference, side by side: what is measured, shown and written."""

import re
from dataclasses import replace

import meshio
import numpy as np
import pytest
from fake_solutions import history

import sheetbench as sb
from comparisons.comparison.measures import difference, extrema, matching_measures
from comparisons.comparison.motion import compare_motion
from comparisons.comparison.motion_answer import MotionComparison
from comparisons.models.spec import Lattice
from comparisons.pages.stage import stage
from comparisons.pages.studies import read
from sheetbench.scenes import load


def swing(frequency, damping, size=1.0):
    """A history whose only probe goes like 1 − e^(−ζωt) cos ω_d t."""
    time = np.linspace(0.0, 1.0, 1001)
    turn = 2.0 * np.pi * frequency
    own = turn / np.sqrt(1.0 - damping**2)
    height = -size * (1.0 - np.exp(-damping * own * time) * np.cos(turn * time))
    probes = {"P": np.column_stack([0.0 * time, 0.0 * time, height])}
    return history(time, probes)


def test_period_and_decay_of_a_damped_swing_are_its_own():
    """Extrema of 1 − e^(−at) cos ωt lie half a period apart; parabolas place them to 1e-4 of it."""
    measured, _ = matching_measures(swing(5.0, 0.05), swing(5.0, 0.05))
    assert measured.period == pytest.approx(0.2, rel=1e-4)
    assert measured.decay == pytest.approx(2.0 * np.pi * 0.05 / np.sqrt(1.0 - 0.05**2), rel=1e-3)
    assert measured.damping == pytest.approx(0.05, rel=1e-3)
    first = -(1.0 + np.exp(-np.pi * 0.05))
    assert measured.peak == pytest.approx(first, rel=2e-3)


def test_what_two_motions_differ_by_is_what_was_changed():
    slower = difference(swing(4.95, 0.05, 1.02), swing(5.0, 0.05))
    assert slower["period"] == pytest.approx(0.01 / 0.99, rel=2e-2)
    assert slower["peak"] == pytest.approx(-0.02, rel=2e-2)
    assert slower["rms"] < slower["largest"] < 0.4
    alike = difference(swing(5.0, 0.05), swing(5.0, 0.05))
    assert (alike["largest"], alike["rms"], alike["period"], alike["decay"]) == (0.0, 0.0, 0.0, 0.0)


def test_the_references_row_is_of_the_extrema_that_the_other_row_is_of():
    """A swing of 5 Hz beside one that gets slower: after the third extremum they do not pair."""
    still, (one, other) = np.linspace(0.0, 1.0, 1001), (swing(5.0, 0.05), swing(5.0, 0.05))
    late = np.interp(still - 0.5 * np.clip(still - 0.25, 0.0, None), other.time, one.probes["P"][:, 2])
    one.probes["P"][:, 2] = late
    mine, truth = matching_measures(one, other)
    assert None not in (mine.period, truth.period)
    assert abs(mine.last - truth.last) < 0.05  # half the way from one to the next
    assert difference(one, other)["period"] == pytest.approx(mine.period / truth.period - 1.0, rel=1e-9)
    both = MotionComparison(load("two-edges-settling"), {"lumped": one, "shell": other})
    rows = both.document()["motion"]["measures"]
    assert rows == {"lumped": mine.as_dict(), "shell": truth.as_dict()}
    assert truth.last < extrema(other.time, other.probes["P"][:, 2])[-1, 0]


def test_the_reference_has_a_bar_by_mesh_and_by_step():
    both = sb.compare("two-edges-settling", duration=0.05, grid=5, elements=2)
    assert 0.0 < both.uncertainty["step"] < both.uncertainty["mesh"] < 0.2
    assert both.lattice is both["lumped"] is not both["shell"]
    sentence, *notes = both.report().notes
    assert re.match(r"The lattice is up to [\d.]+ % off the shell in motion, and the shell within", sentence)
    assert "% by runs on larger elements" in notes[0] and "% by runs in longer steps" in notes[0]

    def barred(mesh, step):
        return replace(both, uncertainty={"mesh": mesh, "step": step})

    good, poor = barred(1e-6, 1e-6), barred(0.5, 0.01)
    for one, within in ((good, False), (poor, True)):
        report = one.report()
        table = next(table for table in report.tables if table.name == "differences")
        bar = pytest.approx(report.document["motion"]["bar"])
        assert table.rows[-1][-2:] == (bar, "yes" if within else "no")
        assert ("lumped: within the shell's own error." in report.notes) == within
        assert one.differences[0]["distinguishable"] == (not within)
    assert poor.report().lead.startswith("The shell itself is uncertain by 51 % of its largest displacement")
    assert good.report().lead.startswith("motion over")
    near, unknown = barred(0.5 * both.differences[0]["largest"], 0.0), barred(None, 1e-6)
    assert near.doubt and near.differences[0]["distinguishable"]
    assert unknown.bar is None and unknown.differences[0]["distinguishable"] is None and not unknown.doubt
    (said,) = unknown.complaints()
    assert said.startswith("shell: its error bar is not known") and "a run on larger elements failed" in said
    assert not good.complaints() and not replace(both, uncertainty={}).complaints()


@pytest.mark.nightly
def test_the_bar_of_a_motion_holds_and_is_not_wide():
    """It was the whole change on elements twice as large, five times the error."""
    coarse, fine = (sb.compare("two-edges-settling", duration=0.2, grid=5, elements=n) for n in (8, 12))
    moved = [np.stack([*both["shell"].probes.values()]) for both in (coarse, fine)]
    times = [both["shell"].time for both in (coarse, fine)]
    assert np.array_equal(*times)
    off = np.abs(moved[0] - moved[1]).max() / np.abs(moved[1]).max()
    assert off < coarse.uncertainty["mesh"] < 3.0 * off


def test_the_command_prints_and_writes_a_motion(kept):
    found = kept("compare motion")
    folder, motion, printed = found.folder, found.document["motion"], found.shown(80)
    assert all(word in printed for word in ("first peak", "rms", "generalised-alpha"))
    assert "[s]   [s]" in printed and max(map(len, printed.splitlines())) <= 80
    assert motion["time"][0] == 0.0 and motion["time"][-1] == pytest.approx(0.004)
    assert set(motion["probes"]) == {"lumped", "shell"}
    assert len(motion["probes"]["shell"]["P4"]) == len(motion["time"])
    assert {"of", "against", "largest", "rms", "peak", "period", "decay"} <= set(motion["differences"][0])
    last = meshio.read(sorted((folder / "shell").glob("*.vtu"))[-1])
    corner = np.argmax(np.sum(last.points[:, :2], axis=1))
    expected = motion["probes"]["shell"]["P4"][-1]
    assert last.point_data["displacement"][corner] == pytest.approx(expected, abs=1e-12)
    assert (folder / "shell.pvd").exists() and (folder / "lumped.pvd").exists()
    shown = stage(read(folder).studies[0])
    assert [view["label"] for view in shown["views"]] == ["lumped and shell", "lumped", "shell"]
    assert shown["views"][0]["sheets"] == [sheet["name"] for sheet in shown["sheets"]]
    assert all(len(sheet["frames"]) > 1 for sheet in shown["sheets"])


def test_runs_of_a_comparison_are_gone_on_with(tmp_path):
    """A second time every run goes on from its last checkpoint, to the same answer to the last bit."""
    settling, how = load("two-edges-settling"), {"every": 2e-4, "elements": 2, "store": tmp_path}
    first, second = (compare_motion(settling, 0.02, Lattice(5), **how) for _ in range(2))
    assert all(history.resumed_from > 0.0 for history in second.histories.values())
    assert any("went on from" in note for note in second.report().notes)
    for name, one in first.histories.items():
        for probe, u in one.probes.items():
            assert np.array_equal(second.histories[name].probes[probe], u)
    assert len(list(tmp_path.iterdir())) == 4  # the lattice, the shell, and its two for the bars
