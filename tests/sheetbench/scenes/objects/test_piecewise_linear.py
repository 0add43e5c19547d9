"""Slopes of a table are of its own span's scale."""

import pytest

from sheetbench.scenes.objects.tables import PiecewiseLinear


@pytest.mark.parametrize("span", [1e-9, 1.0, 1e6])
def test_a_slope_does_not_depend_on_the_unit_of_time(span):
    """A table of nanoseconds had the next piece's slope half a piece early."""
    table = PiecewiseLinear([0.0, 0.5 * span, span], [0.0, 1.0, 0.0])
    assert table.slope(0.25 * span) == pytest.approx(2.0 / span)
    assert table.slope(0.5 * span * (1.0 - 1e-12)) == pytest.approx(-2.0 / span)  # a sum of steps
