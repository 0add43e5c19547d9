"""The study of drawn sheets: lattices against the shell, errors and orders as docs/limits.md has them."""

import numpy as np
import pytest

from studies.drawn.scenes import CATALOGUE, OBLIQUE, scenes
from studies.drawn.study import Row, measure, table

SCENES = {scene.name: scene for scene in scenes()}


def test_ten_are_drawn_and_five_of_the_catalogue():
    assert len(SCENES) == 15 and set(CATALOGUE) | OBLIQUE <= set(SCENES)


def test_orders_follow_from_the_errors():
    row = Row("a", False, {9: 0.08, 17: 0.02, 33: 0.01}, 0.001)
    assert (row.order(9, 17), row.order(17, 33)) == pytest.approx((2.0, 1.0)) and row.misses == ""
    assert Row("a", False, {9: 0.08, 17: 0.03, 33: 0.02}, 0.001).misses == "error, order"
    assert "| a | aligned | 8.00 | 2.00 | 1.00 | 2.0 | 1.0 | 1.5 | 0.10 |  |" in table([row])


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_lattices_are_as_near_as_asked(name):
    row = measure(SCENES[name])
    assert row.errors[17] <= row.allowed and np.isfinite(row.overall_order)
    assert row.bar < 0.3 * row.allowed
