"""Drag of the air on plate, shell and solid: the fall in closed form, and the lattice's swing."""

import numpy as np
import pytest
from drag_cases import DENSE, FALL, SHEET, fallen, falling
from dynamic_cases import springs

import fem_reference
import lumped
from fem_reference.discrete.items import Drag
from fem_reference.sheets import shell
from sheetbench.scenes import Air, Gravity

MODELS = ("plate", "shell", "solid")


@pytest.mark.sweep
@pytest.mark.parametrize("model", MODELS)
def test_a_sheet_falls_flat_as_in_closed_form(model):
    """To second order in the step, and so is what its balance lacks."""
    misses = []
    for count in (50, 100):
        history = fem_reference.simulate(
            falling(), model, FALL, step=FALL / count, every=FALL / 10, elements=1
        )
        misses.append(np.abs(history.probes["P4"][:, 2] - fallen(history.time)).max() / -fallen(FALL))
    assert misses[-1] < 5e-5 and np.log2(misses[0] / misses[1]) == pytest.approx(2.0, abs=0.15)
    spread = np.ptp(history.balance) / np.ptp(history.energies["potential"])
    assert spread < 3e-5
    assert history.energies["dissipated"][-1] > 0.25 * np.ptp(history.energies["potential"])


SWING = SHEET.replace(gravity=Gravity(acceleration=(0.0, 0.0, -0.1)), air=Air(drag=2.0, density=6e4))


@pytest.fixture(scope="module")
def lattice():
    return lumped.simulate(SWING, springs(SWING, 9), 0.2, every=0.01)


@pytest.mark.sweep
@pytest.mark.parametrize(("model", "elements"), [("plate", 3), ("solid", 2), ("shell", 3)])
def test_a_swing_in_air_is_that_of_the_lattice(lattice, model, elements):
    """Within 1 %, nearly linear, in dense air that takes a third of the weight's work in half a swing."""
    ours = fem_reference.simulate(SWING, model, 0.2, elements=elements, every=0.01, error=1e-4)
    height = ours.probes["P4"][:, 2]
    assert np.abs(lattice.probes["P4"][:, 2] - height).max() < 0.01 * np.abs(height).max()
    for history in (ours, lattice):
        taken = history.energies["dissipated"]
        assert taken[-1] > 0.3 * np.abs(history.energies["potential"]).max() and np.diff(taken).min() >= 0.0
        assert np.ptp(history.balance) < 1e-3 * taken[-1]


def test_its_damping_is_the_derivative_by_velocity():
    model = shell(SHEET.replace(air=DENSE), (2, 1), moving=True)
    q, v, step = 0.01 * np.random.default_rng(0).standard_normal((3, model.size))
    drag = Drag(0.6)
    on, damping = drag.damping(model.shape(q, 0.0, v))
    along = np.einsum("eicjd,ejd->eic", damping, model.surface_change(step))
    ends = [drag.force(model.shape(q, 0.0, v + sign * 1e-6 * step)) for sign in (1.0, -1.0)]
    moved = (ends[0] - ends[1]) / 2e-6
    assert model.of_surface(on, along) == pytest.approx(moved, abs=1e-6 * np.abs(moved).max())
