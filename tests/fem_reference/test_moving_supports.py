"""Supports that move, in statics: every model puts them where their motion ends."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

import fem_reference
import lumped
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, Gravity, Held, Hinged, Material, Scene, Sheet
from sheetbench.scenes.objects.supports import Motion

SHEET = Sheet(length_x=0.1, length_y=0.04, thickness=0.002)
RUBBER = Material(young=1e6, poisson=0.3, density=1100.0)
WEIGHT = Gravity(acceleration=(0.0, 0.0, -9.81))
LIFT = (0.0, 0.0, 0.004)
POINTS = np.array([(0.05, 0.02), (0.1, 0.0), (0.02, 0.04)])
MODELS = ["lumped", "plate", "shell", "solid"]


def make_scene(*supports, actuators=(), gravity=WEIGHT):
    return Scene(
        name="moved", sheet=SHEET, material=RUBBER, gravity=gravity, supports=supports, actuators=actuators
    )


def solve(scene, model):
    if model == "lumped":
        springs = lumped.calibrate(SHEET, RUBBER, grid=(11, 5), method="consistent")
        found = lumped.solve(scene, springs)
    else:
        found = fem_reference.solve(scene, model=model, elements=2)
    assert found.status is Status.CONVERGED, found.message
    return found


@pytest.mark.parametrize("model", MODELS)
def test_sheets_and_all_their_supports_move_as_one(model):
    """The held edge moves in z alone, which is all that it holds: a translation strains nothing."""
    along = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.003, 0.0, 0.004)))
    free_along = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.5, 0.5, 0.004)))
    supports = (Hinged(edge="x0", motion=along), Held(edge="x1", components=("z",), motion=free_along))
    light = Gravity(acceleration=(0.0, 0.0, -0.981))  # the plate's slopes stay below 1
    still = solve(make_scene(Hinged(edge="x0"), Held(edge="x1", components=("z",)), gravity=light), model)
    moved = solve(make_scene(*supports, gravity=light), model)
    expected = still.displacement(POINTS) + np.array([0.003, 0.0, 0.004])
    assert_allclose(moved.displacement(POINTS), expected, atol=1e-8)


def test_a_run_that_settles_ends_where_statics_are():
    """The hinge's corner masses, held by a clamp that moves alike, are moved once."""
    rise = Motion(time=(0.0, 0.05), displacement=((0.0, 0.0, 0.0), LIFT))
    damped = RUBBER.replace(damping_time=0.02)
    scene = make_scene(Clamped(edge="x0", motion=rise), Hinged(edge="y0", motion=rise)).replace(
        material=damped
    )
    scene = scene.replace(probes={"P": (0.1, 0.04), "corner": (0.0, 0.0)})
    springs = lumped.calibrate(SHEET, damped, grid=(7, 3), method="consistent")
    run = lumped.simulate(scene, springs, 1.5, every=0.5, integrator="esdirk")
    assert_allclose(run.probes["corner"][-1], LIFT, atol=1e-12)
    rest = lumped.solve(scene, springs).displacement([(0.1, 0.04)])[0]
    assert_allclose(run.probes["P"][-1], rest, atol=1e-4 * np.abs(rest).max())
