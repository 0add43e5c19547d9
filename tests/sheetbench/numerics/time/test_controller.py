"""Steps by their error: repeated, lengthened, kept within a band, counted at the shortest length."""

from itertools import pairwise

import pytest

from sheetbench.numerics.time.controller import Controller
from sheetbench.numerics.time.method import StepFailed


def controller(step=1.0):
    return Controller(order=3, growth=2.0, band=(1.0, 1.25), step=step)


def test_a_step_settles_where_its_error_is_the_one_allowed():
    """Error h³: the length stays where 0.9/h lies within the band."""
    control, taken = controller(step=0.01), []
    for _ in range(20):
        taken.append(control.take(lambda h: ("", h**3, 1.0), 100.0, 1e-9, fewer=4)[1])
    assert max(b / a for a, b in pairwise(taken)) <= 2.0 + 1e-12
    assert 0.9 / 1.25 <= taken[-1] <= 0.9 and control.rejected == 0
    assert control.notes() == ""


def test_steps_divide_a_time_evenly():
    assert controller(0.4).dividing(1.0) == pytest.approx(1.0 / 3.0)
    assert controller(0.1).dividing(1.05, fewer=4) == 0.1


def test_a_step_at_the_shortest_length_counts_and_is_told():
    control = controller()
    found, h = control.take(lambda h: (h, 1.0, 1e-6), 1.0, 0.3)
    assert found == h and h <= 0.3 and control.rejected >= 1 and control.floored == 1
    assert control.notes().startswith("1 step of the shortest length ")
    again = controller()
    again.recall(control.memory())
    assert again == control


def test_a_step_without_a_solution_is_quartered_to_the_shortest():
    tried = []

    def fails(h):
        tried.append(h)
        raise StepFailed("no solution")

    with pytest.raises(StepFailed, match="no solution in a step of"):
        controller().take(fails, 1.0, 0.1)
    assert tried == [1.0, 0.25, 0.0625]
