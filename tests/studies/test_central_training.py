"""The training of the calibration `central`."""

import pytest

from lumped.calibration.central_table import ROWS
from sheetbench.errors import NoEquilibrium
from sheetbench.scenes import EdgeLoad, Held
from studies.central.training import HELD, _displacement, _scene, trained_to_bend


def test_the_table_is_what_its_scenes_ask_for():
    """Of one row: the numbers are as fine as the search, the errors flat about their least."""
    row = next(row for row in ROWS if row[0] == 0.45)
    a, b, worst, cauchy = trained_to_bend(0.45)
    assert (a, b) == pytest.approx(row[1:3], abs=2e-3)
    assert (worst, cauchy) == pytest.approx((row[4], row[6]), abs=1e-3)


def test_a_scene_without_a_stable_equilibrium_trains_nothing():
    pushed = EdgeLoad("x1", force_per_length=(-400.0, 0.0, 0.0))
    held = (*HELD["one edge clamped"], Held("x1", ("y", "z")))
    with pytest.raises(NoEquilibrium, match=r"shell.*unstable"):
        _displacement(_scene(held, None, (pushed,)), "shell")
