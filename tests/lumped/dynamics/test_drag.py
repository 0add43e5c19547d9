"""Drag of the air on the lattice: closed forms, energy, tangent (of references: test_moving_drag.py)."""

import numpy as np
import pytest
from drag_cases import FALL, SHEET, fallen, falling
from dynamic_cases import springs, system
from lattice_cases import derivative

import lumped
from lumped.dynamics import INTEGRATORS, drag
from sheetbench.scenes import Air, BadInput

STEPS = {"generalised-alpha": FALL / 400, "esdirk": FALL / 10, "verlet": FALL / 800, "midpoint": FALL / 200}


@pytest.mark.parametrize("name", INTEGRATORS)
def test_a_sheet_falls_flat_as_in_closed_form(name):
    """To the order of the integrator, and with its energy in balance; of esdirk rounding is left."""
    misses = []
    for step in (STEPS[name], STEPS[name] / 2):
        history = lumped.simulate(
            falling(), springs(falling(), 3), FALL, integrator=name, step=step, every=FALL / 10
        )
        misses.append(np.abs(history.probes["P4"][:, 2] - fallen(history.time)).max() / -fallen(FALL))
    assert misses[-1] < 1e-5 and np.ptp(history.balance) < 2e-5 * np.ptp(history.energies["potential"])
    assert history.energies["dissipated"][-1] > 0.25 * np.ptp(history.energies["potential"])
    assert name == "esdirk" or np.log2(misses[0] / misses[1]) == pytest.approx(2.0, abs=0.15)


def test_drag_is_normal_to_the_current_surface_and_its_tangent_a_derivative():
    equations, _ = system(SHEET.replace(supports=(), air=Air(drag=2.0)), 3)
    positions, air = equations.assembly.lattice.positions, equations.damping.drag
    turned = positions[:, [2, 1, 0]] * [-1.0, 1.0, 1.0]  # it stands, its normal along −x

    def force(u, v):
        out = np.zeros_like(u)
        return drag.add_drag(air, u, v, out), out

    power, across = force(turned - positions, np.tile([0.3, 0.0, 0.0], (len(positions), 1)))
    assert across.sum(axis=0) == pytest.approx([1.2 * 0.3**2 * 0.188**2, 0.0, 0.0], abs=1e-15)
    assert power == pytest.approx(0.3 * across[:, 0].sum(), rel=1e-12)
    _, along = force(turned - positions, np.tile([0.0, 0.3, 0.4], (len(positions), 1)))
    assert not along.any()
    u, v = (0.02 * np.random.default_rng(seed).standard_normal(positions.shape) for seed in (0, 1))
    blocks = np.zeros((len(u), 3, len(u), 3))
    blocks[np.arange(len(u)), :, np.arange(len(u))] = drag.velocity_tangent(air, u, v)
    numeric = derivative(lambda w: force(u, w)[1], v)
    assert np.allclose(blocks.reshape(numeric.shape), numeric, atol=1e-6 * np.abs(numeric).max())


def test_an_export_refuses_air_by_name():
    with pytest.raises(BadInput, match=r"air: an exported lattice has no drag; leave \[air\] out"):
        lumped.describe(SHEET.replace(air=Air(drag=1.0)), springs(SHEET, 3))
