"""Drag of the air: a sheet that falls flat in closed form, its energy, and tangents.

Falling from rest, m dv/dt = m g − ½ ρ c_d A v² gives v = V tanh(g t/V) with V² = 2 m g/(ρ c_d A), and the
sheet has fallen by V²/g ln cosh(g t/V).
"""

import numpy as np
import pytest
from dynamic_cases import springs, system
from lattice_cases import derivative

import fem_reference
import lumped
from fem_reference.discrete.items import Drag
from fem_reference.sheets import shell
from lumped.dynamics import INTEGRATORS, drag
from sheetbench.scenes import Air, Gravity, load

G = 9.81
SHEET = load("one-edge-clamped")
DENSE = Air(drag=1.2, density=500.0)
TERMINAL = float(np.sqrt(SHEET.material.density * SHEET.sheet.thickness * G / DENSE.coefficient))
FALL = 2.0 * TERMINAL / G  # s, in which it reaches 96 % of that
STEPS = {"generalised-alpha": 400, "esdirk": 10, "verlet": 800, "midpoint": 200}
REFERENCES = ("plate", "shell", "solid")


@pytest.mark.sweep
@pytest.mark.parametrize("name", [*INTEGRATORS, *REFERENCES])
def test_a_sheet_falls_flat_as_in_closed_form(name):
    """To the order of the integrator, and with its energy in balance; of esdirk rounding is left."""
    scene, misses = SHEET.replace(supports=(), air=DENSE), []
    for finer in (1, 2):
        options = {"step": FALL / (STEPS.get(name, 50) * finer), "every": FALL / 10}
        if name in REFERENCES:
            history = fem_reference.simulate(scene, name, FALL, elements=1, **options)
        else:
            history = lumped.simulate(scene, springs(scene, 3), FALL, integrator=name, **options)
        fallen = TERMINAL**2 / G * np.log(np.cosh(G * history.time / TERMINAL))
        misses.append(np.abs(history.probes["P4"][:, 2] + fallen).max() / fallen[-1])
    weight = np.ptp(history.energies["potential"])
    assert misses[-1] < (5e-5 if name in REFERENCES else 1e-5) and np.ptp(history.balance) < 3e-5 * weight
    assert history.energies["dissipated"][-1] > 0.25 * weight
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
