"""The settings of an answer on its page."""

import pytest

from comparisons.pages.page import _shorten


@pytest.mark.parametrize(
    ("key", "value", "shown"),
    [
        ("graded", True, "on"),
        ("layer_distance", 3e-3, "3 mm"),
        ("ratio", 0.123456, "0.1235"),
        ("grids", [5, 9], "5, 9"),
        ("grid", [5, 9], "5 × 9"),
        ("cells", [1] * 9, ""),
    ],
)
def test_settings_have_units_and_several_grids_are_not_the_sides_of_one(key, value, shown):
    assert _shorten(key, value) == shown
