"""Which rows are worth having, orders, and norms over the sheet."""

import pytest

from comparisons.sweep.columns import field_points
from comparisons.sweep.front import front, grouped, order
from sheetbench import scenes


def test_front_holds_what_nothing_beats():
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


def test_field_points_integrate_over_the_sheet():
    scene = scenes.load("two-edges-clamped")
    points, weights = field_points(scene)
    assert weights.sum() == pytest.approx(1.0)
    lx, ly = scene.sheet.lengths
    assert weights @ (points[:, 0] ** 3 * points[:, 1]) == pytest.approx(lx**3 * ly / 8)
    half = scene.replace(sheet=scene.sheet.replace(outline=[(0.0, 0.0), (lx, 0.0), (0.0, ly)]))
    points, weights = field_points(half)  # which had points where there is no sheet
    assert weights.sum() == pytest.approx(1.0) and weights @ points == pytest.approx(
        [lx / 3, ly / 3], rel=0.02
    )
