"""What holds of every reference in motion."""

from itertools import pairwise

import numpy as np
import pytest

import fem_reference
from fem_reference.motion.generalised_alpha import ConstrainedAlpha
from fem_reference.sheets import SHEETS
from fem_reference.verification import strips
from sheetbench.answers.history import History
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.numerics import direct
from sheetbench.numerics.time.method import StepFailed
from sheetbench.scenes import EdgeMotion, Gravity, Pressure, load
from sheetbench.scenes.objects.supports import Clamped, Curved, Motion
from sheetbench.scenes.objects.tables import FactorTable

MODELS = ("plate", "shell", pytest.param("solid", marks=pytest.mark.nightly))


@pytest.fixture(scope="module")
def strip():
    """A hundredth of its weight, which leaves it nearly linear."""
    return strips.settling_scene().replace(gravity=Gravity(acceleration=(0.0, 0.0, -0.1)))


@pytest.mark.parametrize("model", ["plate", "solid"])
def test_a_slight_motion_is_that_of_the_shell(strip, model):
    """Rotations of some hundredths: but for their squares and the solid's thickness, the motion is one."""
    ours, shell = (
        fem_reference.simulate(strip, m, 0.15, elements=(2, 1), every=0.01) for m in (model, "shell")
    )
    height = shell.probes["tip"][:, 2]
    assert np.abs(ours.probes["tip"][:, 2] - height).max() < 5e-3 * np.abs(height).max()
    assert np.ptp(ours.balance) < 1e-3 * max(float(np.abs(e).max()) for e in ours.energies.values())


def test_a_mass_is_not_read_as_if_it_had_a_tangents_entries(monkeypatch):
    """It has fewer: its data ended in whatever lies behind, and some starts were refused for it."""
    made, over = direct.signed_factors, []

    def watched(data, fronts):
        over.append(fronts.source.max() - len(data) + 1)
        return made(data, fronts)

    monkeypatch.setattr(direct, "signed_factors", watched)
    fem_reference.simulate(load("one-edge-clamped"), "shell", 0.002, elements=1)
    assert over and not any(over)


def order(scene, model, step):
    """The observed order of the tip's error in steps of a length, its half and a quarter of it."""
    ends = [
        fem_reference.simulate(scene, model, 0.05, elements=(2, 1), step=step / n, every=0.05, error=1e-8)
        for n in (1, 2, 4)
    ]
    coarse, fine = (np.abs(a.probes["tip"][-1] - b.probes["tip"][-1]).max() for a, b in pairwise(ends))
    return np.log2(coarse / fine)


@pytest.mark.parametrize("model", MODELS)
def test_steps_of_a_half_have_a_quarter_of_the_error(strip, model):
    """Of the shell far from flat."""
    strip = strips.settling_scene() if model == "shell" else strip
    assert order(strip, model, 4e-3) == pytest.approx(2.0, abs=0.15)


@pytest.mark.parametrize("model", MODELS)
def test_a_damped_sheet_comes_to_rest_where_statics_have_it(strip, model):
    """Under a pressure that comes on over time, from the shape of a bent clamp."""
    ramp = FactorTable(time=(0.0, 0.1), factor=(0.0, 1.0))
    bent = strip.replace(
        gravity=None,
        damping_rate=12.0,
        supports=(Curved(edge="x0", curvature=2.0),),
        loads=(Pressure(value=0.3, history=ramp),),
    )
    motion = fem_reference.simulate(bent, model, 1.5, elements=(2, 1), every=0.1)
    still = fem_reference.solve(
        bent, model, elements=(2, 1), **({"graded": True} if model == "plate" else {})
    )
    truth = still.displacement(strip.probe_points())
    assert motion.probes["tip"][-1] == pytest.approx(truth[0], abs=2e-3 * np.abs(truth).max())
    assert motion.reactions["x0"][-1] == pytest.approx(still.reactions["x0"], abs=1e-3 * 0.3 * 0.18 * 0.09)


@pytest.mark.parametrize("model", MODELS)
def test_a_clamp_that_rises_carries_its_edge_along(strip, model):
    """From one moment to the next it moves, and stops; dampers take no more than there is to take."""
    raised = Motion(time=(0.0, 0.1), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.02)))
    scene = strip.replace(
        gravity=None, supports=(Clamped(edge="x0", motion=raised),), probes={"E": (0.0, 0.045)}
    )
    motion = fem_reference.simulate(scene, model, 0.15, elements=(1, 1), every=0.01)
    assert motion.status == Status.CONVERGED
    assert motion.probes["E"][[0, 5, 10, 15], 2] == pytest.approx([0.0, 0.01, 0.02, 0.02], abs=1e-9)
    largest = max(float(np.abs(e).max()) for e in motion.energies.values())
    assert np.abs(motion.numerical).max() < 0.015 * largest  # taken, of the short waves of two jumps
    in_steps = np.diff(motion.energies["dissipated"])
    assert in_steps.min() > 0.0
    assert (
        in_steps[10] < motion.energies["kinetic"][10]
    )  # that of the stop, where no work is done on the sheet


@pytest.mark.parametrize("model", ["plate", "shell"])
def test_halves_of_fixed_steps_have_a_quarter_of_the_error_behind_a_jump(strip, model):
    """Two steps of first order leave the second order of all."""
    started = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.2)))
    scene = strip.replace(gravity=None, supports=(Clamped(edge="x0", motion=started),))
    assert order(scene, model, 5e-4) == pytest.approx(2.0, abs=0.3)


@pytest.mark.parametrize("model", ["plate", "solid"])
def test_edges_that_actuators_move_are_left_to_the_shell(strip, model):
    moved = EdgeMotion(kind="motion", edge="x1", time=(0.0, 1.0), displacement=((0, 0, 0), (0, 0, 0.01)))
    with pytest.raises(BadInput, match="x1"):
        fem_reference.simulate(strip.replace(actuators=(moved,)), model, 0.1, elements=2)


def test_a_fixed_step_that_fails_is_made_again_shorter(monkeypatch):
    once = ConstrainedAlpha._advanced

    def failing(self, motion, h, step):
        if h > 0.9e-3 and 4e-3 < motion.time < 5.5e-3:
            raise StepFailed("on request")
        return once(self, motion, h, step)

    scene = load("two-edges-settling")
    plain = fem_reference.simulate(scene, "shell", 0.01, elements=2, step=1e-3, every=2e-3)
    monkeypatch.setattr(ConstrainedAlpha, "_advanced", failing)
    shorter = fem_reference.simulate(scene, "shell", 0.01, elements=2, step=1e-3, every=2e-3)
    assert shorter.status is Status.CONVERGED and shorter.steps > plain.steps
    for probe, u in plain.probes.items():
        assert np.abs(shorter.probes[probe] - u).max() < 2e-3 * np.abs(plain.probes["P4"]).max()


@pytest.fixture(scope="module")
def settling():
    return strips.settling_scene()


def test_work_of_loads_and_supports_balances_the_energy(settling):
    ramp = FactorTable(time=(0.0, 0.05), factor=(0.0, 1.0))
    raised = Motion(time=(0.0, 0.1), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.02)))
    scene = settling.replace(
        damping_time=1e-3,
        gravity=Gravity(acceleration=(0.0, 0.0, -9.81), history=ramp),
        supports=(Clamped(edge="x0", motion=raised),),
    )
    motion = fem_reference.simulate(scene, "shell", 0.2, elements=(4, 1), error=1e-6)
    largest = max(float(np.abs(energy).max()) for energy in motion.energies.values())
    assert motion.energies["work"].max() > 0.1 * largest
    assert np.ptp(motion.balance) < 1e-3 * largest


def test_what_does_not_move_is_refused(settling):
    with pytest.raises(BadInput, match="duration"):
        fem_reference.simulate(settling, "shell", -1.0)
    for refused in (fem_reference.simulate, fem_reference.modes):
        with pytest.raises(BadInput, match="beam"):
            refused(settling, "beam", 1)
    with pytest.raises(BadInput, match="count = 0"):
        fem_reference.modes(settling, "plate", 2, count=0)


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


def test_a_push_that_ends_between_fixed_steps_has_its_own_impulse():
    """The step between both ends of the jump set the acceleration of the next one: 55 % too far."""
    h = 1e-3
    end, until = 10.5 * h, 20 * h
    push = FactorTable(time=(0.0, end, end + 1e-3 * h), factor=(1.0, 1.0, 0.0))
    along = Gravity(acceleration=(1.0, 0.0, 0.0), history=push)
    scene = load("two-edges-clamped").replace(supports=(), gravity=along)
    pushed = fem_reference.simulate(scene, "shell", until, elements=2, every=until, step=h)
    assert pushed.probes["P1"][-1, 0] == pytest.approx(0.5 * end**2 + end * (until - end), rel=1e-4)
