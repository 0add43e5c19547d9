"""Generalised-α's coefficients: spectral radius, local error."""

from itertools import pairwise

import numpy as np
import pytest

from sheetbench.errors import BadInput
from sheetbench.numerics.time.controller import Controller
from sheetbench.numerics.time.method import StepFailed
from sheetbench.numerics.time.rule import BACKWARD_EULER, generalised, step_of


def stepped(rule, turn, state):
    """(u, h v, h² a, h² a') after a step of turn = ω h."""
    am, af, gamma, beta, old, *_ = rule
    u, v, a, algorithm = state
    after = [[1, 0, 0, -beta], [0, 1, 0, -gamma], [turn**2, 0, 1, 0], [0, 0, af - 1, 1 - am]]
    before = [u + v + old * algorithm, v + (1 - gamma) * algorithm, 0, af * a - am * algorithm]
    return np.linalg.solve(after, before)


@pytest.mark.parametrize("radius", [0.0, 0.3, 0.9, 1.0])
def test_fast_oscillations_shrink_by_the_radius_and_none_grow(radius):
    rule = generalised(radius)

    def largest_root(turn):
        columns = [stepped(rule, turn, unit) for unit in np.eye(4)]
        return np.abs(np.linalg.eigvals(np.transpose(columns))).max()

    assert largest_root(1e4) == pytest.approx(radius, abs=1e-2)  # a threefold root is off by (ω h)^(-2/3)
    assert max(map(largest_root, np.geomspace(1e-2, 1e4, 60))) < 1.0 + 1e-7


@pytest.mark.parametrize("rule", [generalised(0.3), generalised(0.8), generalised(0.9), BACKWARD_EULER])
def test_the_local_error_of_an_oscillator_is_the_estimated_one(rule):
    """u = −sin ω t from 0, where its third derivative is largest, a' the acceleration (αm − αf) h later; with
    |β − 1/6| for the constant the estimate was 31 and 65 % too large for radii of 0.9 and 0.8."""
    turn, shift = 1e-3, rule.am - rule.af
    start, exact = [0.0, -turn, 0.0, turn**2 * np.sin(shift * turn)], -np.sin(turn)
    if rule is BACKWARD_EULER:
        start, exact = [1.0, 0.0, -(turn**2), -(turn**2)], np.cos(turn)
    u, _, a, algorithm = stepped(rule, turn, start)
    jump = a if rule is BACKWARD_EULER else algorithm - start[3]
    assert abs(u - exact) == pytest.approx(rule.error * abs(jump), rel=0.02)


@pytest.mark.parametrize("rule", [generalised(0.0), generalised(0.8), BACKWARD_EULER])
def test_a_step_in_its_last_displacement_is_the_rule(rule):
    """The equation that solvers have, c₂ (u − û) + ω² u = 0, against the rule's four equations."""
    h, turn, state = 0.02, 0.7, np.array([0.3, -0.2, 0.5, 0.1])
    start, v, a, algorithm = state / [1.0, h, h**2, h**2]
    step = step_of(rule, h, start, v, a, algorithm)
    stiffness = (turn / h) ** 2
    u = step.by_a * step.base_u / (step.by_a + stiffness)
    a = step.acceleration(u)
    found = [u, h * step.velocity(u), h**2 * a, h**2 * step.algorithm(a)]
    assert found == pytest.approx(stepped(rule, turn, state), abs=1e-14)
    assert step.algorithm(step.acceleration(step.guess)) == pytest.approx(algorithm)


def test_a_radius_that_is_none_is_refused():
    with pytest.raises(BadInput, match=r"radius = 1\.1: the spectral radius .* lies in \[0, 1\]"):
        generalised(1.1)


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
    again.restore(control.memory())
    assert again == control


def test_a_step_without_a_solution_is_quartered_to_the_shortest():
    tried = []

    def fails(h):
        tried.append(h)
        raise StepFailed("no solution")

    with pytest.raises(StepFailed, match="no solution in a step of"):
        controller().take(fails, 1.0, 0.1)
    assert tried == [1.0, 0.25, 0.0625]
