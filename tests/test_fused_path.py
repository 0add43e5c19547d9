"""The load path as one compiled call beside the same path in Python."""

import numpy as np
import pytest

import lumped
from lumped.statics.equilibrium import from_flat
from lumped.statics.problem import Problem
from sheetbench.scenes import Gravity, load


def heavier(name, times):
    scene = load(name)
    pull = tuple(times * part for part in scene.gravity.acceleration)
    return scene.replace(gravity=Gravity(acceleration=pull))


CASES = {
    "one step": (load("two-edges-clamped"), True),
    "several steps": (heavier("one-edge-clamped", 5.0), True),
    "supports that move": (load("curved-edge"), True),
    "goes on in Python": (heavier("curved-edge", 20.0), False),  # moving supports, and more than one step
}


@pytest.mark.parametrize("case", CASES)
def test_one_call_is_the_path_in_python(case, monkeypatch):
    scene, whole = CASES[case]
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 5))
    problem, plain = lumped.pose(scene, springs), lumped.pose(scene, springs)
    done, _ = lumped.pose(scene, springs).followed()
    assert (done.load_factor == 1.0) == whole
    found, why = from_flat(problem)
    monkeypatch.setattr(Problem, "followed", lambda self: None)
    expected, as_before = from_flat(plain)
    assert why == as_before == "" and found.load_factor == expected.load_factor == 1.0
    if case in ("one step", "supports that move"):
        assert len(problem.history) == len(plain.history)
        assert problem.factorisations == plain.factorisations
    # both end at residuals of 1e-11: the condition number of 1e4 to 1e6 is between them
    assert np.abs(found.u - expected.u).max() <= 1e-6 * np.abs(expected.u).max()
    assert found.negative == expected.negative == 0
    assert found.factor.solve(problem.reduce(problem.loads.dead)) == pytest.approx(
        expected.factor.solve(plain.reduce(plain.loads.dead)), rel=1e-4
    )


def test_factors_at_hand_polish():
    """From the second correction on a polished equilibrium costs no factors."""
    scene = load("two-edges-clamped")
    problem = lumped.pose(scene, lumped.calibrate(scene.sheet, scene.material, grid=(3, 3)))
    state, _ = from_flat(problem)
    assert problem.history[-1].residual < 1e-11 and problem.factorisations == 5
    assert len(problem.history) == 6 and state.negative == 0
