"""The rule that keeps energy and momenta: to rounding, on every reference."""

import numpy as np
import pytest

import fem_reference
from fem_reference.discrete.energies import energies
from fem_reference.motion.energy_momentum import EnergyMomentum
from fem_reference.sheets import SHEETS, start
from fem_reference.verification import settling_strip
from sheetbench.errors import BadInput

STRIP = settling_strip.scene()
SPIN, DRIFT = np.array([3.0, -20.0, 5.0]), np.array([1.0, 0.5, -2.0])


def drift(model, damping_time, elements, **steps):
    """The spread of the balance over the largest elastic energy."""
    scene = STRIP.replace(damping_time=damping_time, thickness=0.006)
    motion = fem_reference.simulate(
        scene, model, integrator="energy-momentum", elements=elements, every=0.01, **steps
    )
    assert motion.probes["tip"].min() < -0.01
    return float(np.ptp(motion.balance) / motion.energies["elastic"].max())


@pytest.mark.parametrize("damping_time", [0.0, 1e-3])
def test_the_shell_keeps_its_energy_to_rounding(damping_time):
    """Of a step 1e-13 of the displacement is left: times stiffness over energy, some 1e-11."""
    assert drift("shell", damping_time, (2, 1), duration=0.3, step=3e-3) < 1e-9


@pytest.mark.parametrize("model", ["plate", "solid"])
def test_plate_and_solid_keep_theirs(model):
    assert drift(model, 0.0, (1, 1), duration=0.1, step=1e-3) < 1e-8


@pytest.mark.nightly  # a minute
@pytest.mark.parametrize(("model", "elements"), [("plate", (2, 1)), ("shell", (2, 1)), ("solid", (1, 1))])
def test_a_hundred_periods_leave_the_energy_as_it_was(model, elements):
    """Over 0.32 s, to 1e-6 of the elastic energy."""
    assert drift(model, 0.0, elements, duration=32.1, step=1e-2) < 1e-8


@pytest.mark.parametrize("kind", ["shell", pytest.param("solid", marks=pytest.mark.nightly)])
def test_a_sheet_thrown_and_spinning_keeps_both_momenta_and_its_energy(kind):
    """To what corrections leave, 1e-10 of the displacement at most; the plate, linear, does not turn."""
    model = SHEETS[kind](STRIP.replace(supports=(), gravity=None, damping_time=0.0), (1, 1), moving=True)
    q = start(model)
    places = model.mesh(model.displacement(q)).points
    directors = np.tile([0.0, 0.0, 1.0], (len(q) // 3 - len(places), 1))  # of the shell
    rest = np.concatenate([places - [0.09, 0.045, 0.0], directors])
    thrown = np.cross(SPIN, rest)
    thrown[: len(places)] += DRIFT
    method = EnergyMomentum(model, 1e-3, 1e-6, 1e-3)
    motion = method.begin(0.0, q, thrown.ravel())

    def kept():
        momentum = (model.mass @ motion.v).reshape(-1, 3)
        angular = np.cross(rest + motion.q.reshape(-1, 3), momentum).sum(axis=0)
        energy = sum(energies(model, motion))
        return [momentum[: len(places)].sum(axis=0), angular, np.array(energy)]

    before = kept()
    for _ in range(30):
        motion = method.advance(motion, 1.0)
    for value, at_first in zip(kept(), before, strict=True):
        assert value == pytest.approx(at_first, rel=1e-9)
    assert np.abs(model.displacement(motion.q)).max() > 0.05


def test_laws_that_are_not_linear_in_greens_strain_are_refused():
    with pytest.raises(BadInput, match="st-venant"):
        fem_reference.simulate(
            STRIP, "shell", 0.1, elements=1, law="neo-hookean", integrator="energy-momentum"
        )
    with pytest.raises(BadInput, match="integrator"):
        fem_reference.simulate(STRIP, "shell", 0.1, elements=1, integrator="euler")
