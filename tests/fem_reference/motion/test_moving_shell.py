"""The shell in motion against modes, closed forms and its own statics; published values: test_verify."""

import numpy as np
import pytest

import fem_reference
from fem_reference.sheets import SHEETS
from fem_reference.verification import settling_strip
from sheetbench.answers.history import History
from sheetbench.errors import BadInput
from sheetbench.scenes import Gravity, load
from sheetbench.scenes.objects.supports import Clamped, Motion
from sheetbench.scenes.objects.tables import FactorTable


@pytest.fixture(scope="module")
def strip():
    return settling_strip.scene()


def test_energy_is_kept_in_account(strip):
    """Weight that comes on over time does work; an edge that moves too."""
    ramp = FactorTable(time=(0.0, 0.05), factor=(0.0, 1.0))
    raised = Motion(time=(0.0, 0.1), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.02)))
    scene = strip.replace(
        damping_time=1e-3,
        gravity=Gravity(acceleration=(0.0, 0.0, -9.81), history=ramp),
        supports=(Clamped(edge="x0", motion=raised),),
    )
    motion = fem_reference.simulate(scene, "shell", 0.2, elements=(4, 1), error=1e-6)
    largest = max(float(np.abs(energy).max()) for energy in motion.energies.values())
    assert motion.energies["work"].max() > 0.1 * largest
    assert np.ptp(motion.balance) < 1e-3 * largest


def test_what_does_not_move_yet_is_refused(strip):
    with pytest.raises(BadInput, match="duration"):
        fem_reference.simulate(strip, "shell", -1.0)
    with pytest.raises(BadInput, match="beam"):
        fem_reference.simulate(strip, "beam", 0.1)


def test_a_run_keeps_the_frames_asked_for():
    motion: History = fem_reference.simulate(load("two-edges-settling"), "shell", 0.01, elements=2, frames=3)
    points = np.array([[0.188, 0.188]])
    last = motion.extra["sample"](motion.extra["frames"][-1], points)[0]
    assert motion.extra["frame_times"][-1] == motion.time[-1]
    assert last == pytest.approx(motion.probes["P4"][-1], abs=1e-15)


@pytest.mark.parametrize("model", ["plate", "shell"])
def test_a_mesh_of_the_sheets_own_is_not_graded(model):
    corners = [(0.0, 0.0), (0.188, 0.0), (0.188, 0.188), (0.0, 0.188)]
    own = load("one-edge-clamped").replace(mesh={"points": corners, "quads": [(0, 1, 2, 3)]})
    assert SHEETS[model](own, moving=True).settings["graded"] is False
