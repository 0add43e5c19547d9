"""Drag of the air on plate, shell and solid: the fall in closed form, and the lattice's swing."""

import numpy as np
import pytest
from drag_cases import FALL, SHEET, fallen, falling
from dynamic_cases import springs

import fem_reference
import lumped
from fem_reference.motion.drag import Drag
from sheetbench.scenes import Air, Gravity

MODELS = ("plate", "shell", "solid")


@pytest.mark.parametrize("integrator", ["generalised-alpha", "energy-momentum"])
@pytest.mark.parametrize("model", MODELS)
def test_a_sheet_falls_flat_as_in_closed_form(model, integrator):
    """To second order in the step; the rule that conserves has what is taken in its balance, to rounding."""
    misses = []
    for count in (50, 100):
        history = fem_reference.simulate(
            falling(), model, FALL, integrator=integrator, step=FALL / count, every=FALL / 10, elements=1
        )
        misses.append(np.abs(history.probes["P4"][:, 2] - fallen(history.time)).max() / -fallen(FALL))
    assert misses[-1] < 5e-5 and np.log2(misses[0] / misses[1]) == pytest.approx(2.0, abs=0.15)
    spread = np.ptp(history.balance) / np.ptp(history.energies["potential"])
    assert spread < (1e-10 if integrator == "energy-momentum" else 3e-5)
    assert history.energies["dissipated"][-1] > 0.25 * np.ptp(history.energies["potential"])


@pytest.mark.parametrize(("model", "elements"), [("plate", 3), ("shell", 3), ("solid", 2)])
def test_a_swing_in_air_is_that_of_the_lattice(model, elements):
    """Within 1 %, nearly linear, in dense air that takes a third of the weight's work in half a swing."""
    scene = SHEET.replace(gravity=Gravity(acceleration=(0.0, 0.0, -0.1)), air=Air(drag=2.0, density=6e4))
    ours = fem_reference.simulate(scene, model, 0.2, elements=elements, every=0.01, error=1e-4)
    lattice = lumped.simulate(scene, springs(scene, 9), 0.2, every=0.01)
    height = ours.probes["P4"][:, 2]
    assert np.abs(lattice.probes["P4"][:, 2] - height).max() < 0.01 * np.abs(height).max()
    for history in (ours, lattice):
        taken = history.energies["dissipated"]
        assert taken[-1] > 0.3 * np.abs(history.energies["potential"]).max() and np.diff(taken).min() >= 0.0
        assert np.ptp(history.balance) < 1e-3 * taken[-1]


def test_its_tangent_is_the_derivative_by_velocity():
    vectors, velocities = (np.random.default_rng(n).standard_normal((1, 18, 3)) for n in (0, 1))
    tangent = Drag(0.6, velocities[:, :9], 3.0).tangent(vectors)
    step = 1e-6 * np.random.default_rng(2).standard_normal((1, 9, 3))
    ends = [Drag(0.6, velocities[:, :9] + sign * step, 0.0).force(vectors) for sign in (1.0, -1.0)]
    moved = 3.0 * 0.5 * (ends[0] - ends[1])
    assert np.einsum("eicjd,ejd->eic", tangent[..., :9, :], step) == pytest.approx(
        moved, abs=1e-6 * np.abs(moved).max()
    )
