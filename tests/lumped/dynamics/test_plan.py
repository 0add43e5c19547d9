"""How a run in time is sampled: a hundred times a period by default, frames evenly over it."""

import pytest
from dynamic_cases import make_scene, springs, system

import lumped
from lumped.dynamics.runs.plan import StepPlan, plan_run


@pytest.mark.parametrize("periods", [0.1, 3.0])
def test_the_lowest_period_has_a_hundred_samples(periods):
    scene = make_scene()
    calibration = springs(scene, 3)
    period = 1.0 / lumped.modes(scene, calibration, 1, calibration.masses).frequencies[0]
    equations, _ = system(scene, 3)
    plan = plan_run(equations, calibration, None, periods * period, None, "esdirk", None)
    assert plan.samples == plan.first == round(100 * periods)
    assert plan.every == pytest.approx(period / 100, rel=1e-9)


def test_frames_are_the_first_and_the_last_sample_and_evenly_between():
    """A run that is made longer goes on with them at their distance, to its own last sample at most."""
    plan = StepPlan(samples=10, every=1e-3, steps=1, adapts=False, first=10)
    assert plan.shown(0) == [] and plan.shown(1) == [0] and plan.shown(2) == [0, 10]
    assert plan.shown(3) == [0, 5, 10] and plan.longer(0.02).shown(3) == [0, 5, 10, 15, 20]
    assert plan.shown(4) == [0, 3, 7, 10] and plan.longer(0.0125).shown(4) == [0, 3, 7, 10]
