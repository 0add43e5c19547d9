"""Which rows are worth having, and orders."""

import pytest

from comparisons.sweep.front import front, grouped, order


def test_front_has_the_rows_that_no_other_dominates():
    errors = [0.1, 0.05, 0.2, None, 0.01, float("nan"), 0.04]
    seconds = [1.0, 2.0, 3.0, 0.1, 4.0, 0.1, 2.0]
    assert front(errors, seconds) == [0, 6, 4]
    assert front(errors, seconds, floor=0.04) == [0, 6]  # below the floor nothing can be distinguished
    assert front([None], [1.0]) == []


def test_order_is_the_slope_of_the_logarithms():
    h = [0.1, 0.05, 0.025]
    assert order(h, [3.0 * x**2 for x in h]) == pytest.approx(2.0)
    assert order([0.1, 0.1], [1.0, 2.0]) is None
    assert grouped(["b", "a", "b"]) == {"b": [0, 2], "a": [1]}
