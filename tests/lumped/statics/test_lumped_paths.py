"""Buckling, stable branches and paths through limit points."""

import re
from pathlib import Path

import numpy as np

import lumped
from sheetbench import scenes
from sheetbench.scenes import EdgeLoad, Held, Material, Pressure, Scene, Sheet, Status

SIDE, THICKNESS, YOUNG, POISSON = 0.2, 0.001, 1e7, 0.3
RIGIDITY = YOUNG * THICKNESS**3 / 12 / (1 - POISSON**2)
CRITICAL = 4 * np.pi**2 * RIGIDITY / SIDE**2  # simply supported square plate, Timoshenko & Gere 9.2 [N/m]
CENTRE = [[SIDE / 2, SIDE / 2]]


def compressed(times_critical):
    return Scene(
        name="compressed",
        sheet=Sheet(length_x=SIDE, length_y=SIDE, thickness=THICKNESS),
        material=Material(young=YOUNG, poisson=POISSON, density=1000.0),
        supports=(
            Held(edge="x0", components=("x", "z")),
            Held(edge="x1", components=("z",)),
            Held(edge="y0", components=("y", "z")),
            Held(edge="y1", components=("z",)),
        ),
        loads=(EdgeLoad(edge="x1", force_per_length=(-times_critical * CRITICAL, 0, 0)),),
    )


def springs(masses):
    scene = compressed(1.0)
    return lumped.calibrate(scene.sheet, scene.material, (masses, masses))


def test_flat_is_stable_below_and_unstable_above_the_buckling_load():
    flat = lumped.solve(compressed(0.95), springs(17))
    assert flat.status is Status.CONVERGED
    unstable = lumped.solve(compressed(1.3), springs(17))
    assert unstable.status is Status.UNSTABLE and abs(unstable.displacement(CENTRE)[0, 2]) < 1e-9


def test_the_buckled_state_is_stable():
    buckled = lumped.solve(compressed(1.3), springs(17), branch="stable")
    assert buckled.status is Status.CONVERGED
    assert abs(buckled.displacement(CENTRE)[0, 2]) > THICKNESS


def test_factors_at_hand_polish():
    """From the second correction on a polished equilibrium costs no factors."""
    scene = scenes.load("two-edges-clamped")
    solution = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=(3, 3)))
    assert solution.history[-1].residual < 1e-11 and solution.iterations == 5
    assert len(solution.history) == 6 and solution.status is Status.CONVERGED


def test_a_rubber_balloon_stops_at_its_limit_point_and_says_so():
    """Blown up neo-Hooke gives way from p = 1.2 E h/a on; the path by arc length passes the maximum that the
    message brackets."""
    scene = scenes.load(Path(__file__).parents[3] / "examples" / "rubber" / "inflated-square.toml")
    scene = scene.replace(loads=(Pressure(value=30e3),))
    calibration = lumped.calibrate(scene.sheet, scene.material, 13, "hyperelastic")
    found = lumped.solve(scene, calibration)
    low, high = map(float, re.search(r"between load factors ([\d.]+) and ([\d.]+)", found.message).groups())
    assert found.status is Status.STEP_LIMIT and high - low < 2e-3 * high
