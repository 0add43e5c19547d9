"""The linear plate beyond its range: what it says, and from which share of the load on."""

import numpy as np
import pytest
from cases import sheet

import fem_reference
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, EdgeLoad
from sheetbench.scenes.objects.supports import Motion

STIFFNESS = 5e6 * 0.001**3 / 12.0  # N·m, per width


def solve(*loads, elements=2, **more):
    scene = sheet(0.2, 0.05, 0.001, 5e6, 0.0, 1100.0, loads=loads, **more)
    return fem_reference.solve(scene, model="plate", elements=elements)


def press(force, across=0.0):
    return EdgeLoad(edge="x1", force_per_length=(-force, 0.0, across))


CRITICAL = np.pi**2 * STIFFNESS / (4.0 * 0.2**2)  # N/m, Euler's of a column held at one end


@pytest.mark.parametrize("share", [0.95, 1.05])
def test_in_plane_forces_buckle_it_at_eulers_load(share):
    found = solve(press(share * CRITICAL, across=1e-4))
    assert found.status is (Status.CONVERGED if share < 1.0 else Status.UNSTABLE)
    if share > 1.0:
        said = float(found.message.split(" at ")[1].split(" %")[0])
        assert said == pytest.approx(100.0 / share, rel=2e-3)  # shear deformation and three digits


def test_pulled_it_does_not_buckle():
    assert solve(press(-20.0 * CRITICAL, across=1e-4)).status is Status.CONVERGED


def test_supports_that_close_up_buckle_it():
    """Both ends clamped, ν = 0: 4 π² D/a² at a strain of 4 π² D/(a² E h)."""
    strain = 4.0 * np.pi**2 * STIFFNESS / (0.2**2 * 5e6 * 0.001)
    closing = Motion(time=(0.0,), displacement=((-2.0 * strain * 0.2, 0.0, 0.0),))
    found = solve(supports=(Clamped(edge="x0"), Clamped(edge="x1", motion=closing)), elements=4)
    assert found.status is Status.UNSTABLE
    assert "50 % of the load" in found.message or "49.9 % of the load" in found.message, found.message


def test_turns_beyond_a_directors_length_are_no_turns():
    """A strip under its weight q: its end turns by q a³/6D, linear in the load."""
    turn = 1100.0 * 0.001 * 0.2**3 / (6.0 * STIFFNESS)  # per m/s²
    assert solve(weight=0.9 / turn).status is Status.CONVERGED
    found = solve(weight=4.0 / turn)
    assert found.status is Status.STRAIN_OUTSIDE_MODEL
    assert "linear theory ends at 25 % of the load" in found.message, found.message


def test_a_large_turn_in_the_plane_is_outside_the_model():
    """A force P along the free edge turns the end of the strip, b wide, by 6 P a²/(E h b³)."""
    force = 1.5 * 5e6 * 0.001 * 0.05**3 / (6.0 * 0.2**2)  # N
    found = solve(EdgeLoad(edge="x1", force_per_length=(0.0, force / 0.05, 0.0)))
    assert found.status is Status.STRAIN_OUTSIDE_MODEL
    assert "slopes, turns" in found.message, found.message
