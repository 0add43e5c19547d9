"""A model's limit with its bar, and which models are distinguishable."""

import numpy as np
import pytest

from comparisons.models.spec import Elements, Lattice
from comparisons.sweep.limits import Limit, in_all, motion_bar, pair
from comparisons.sweep.solved import Ask, Solved
from sheetbench.scenes import load

SEED = load("two-edges-clamped")


def standing(name, limit, error, meshes=(4, 6, 8)):
    """A model whose every displacement is limit + error h² [m], its cells of size h = 1/n of a side."""

    def row(n):
        probes = dict.fromkeys(SEED.probes, np.full(3, limit + error / n**2))
        known = {"load_factor": 1.0, "settings": {"grid": [n + 1, n + 1, 2]}, "probes": probes}
        return Solved(Ask(SEED, Lattice(n + 1)), "converged", row=known)

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
        ask = Ask(SEED, Elements("shell", count), duration=1.0)
        return Solved(ask, status, row={"probes": {"P1": np.array([[0.0, 0.0, 0.0], [0.0, 0.0, u]])}})

    fine, longer = moved(8, 0.2), moved(8, 0.198)
    bars = motion_bar([fine, moved(4, 0.19)], longer)
    assert bars == pytest.approx({"mesh": 0.05, "step": 0.01}) and in_all(bars) == pytest.approx(0.06)
    assert motion_bar([fine, moved(4, 0.19, "diverged")], longer) == {"mesh": None, "step": bars["step"]}
    assert in_all({"mesh": None, "step": 0.01}) is None and in_all({}) is None


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
    rows = [Solved(Ask(SEED, Lattice(5)), end, message="why") for end in ("refused", "diverged")]
    found = Limit.of("one", rows)
    assert found.failures == [rows[1].ending] and not found.refused
    assert Limit.of("one", rows[:1]).refused and not Limit.of("one", rows[:1]).failures
