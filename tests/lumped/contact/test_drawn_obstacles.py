"""Drawn sheets over drawn obstacles: no tracebacks, and none is walked through, by the geometry
afterwards."""

import pytest
from drawn_obstacles import judged


@pytest.mark.parametrize("number", range(8))
def test_drawn_sheet_is_not_walked_through(number):
    assert judged(number)[1] == ""


@pytest.mark.nightly
def test_a_thousand_drawn_sheets():
    faults = {number: found[1] for number in range(8, 1000) if (found := judged(number))[1]}
    assert not faults
