"""Maxwell branches in motion: relaxation under a held strain in every model; references' decay and energy."""

import numpy as np
import pytest
from ring_down import BRANCHES, damping_ratio, pulled
from scipy.linalg import eigh

import fem_reference
import lumped
from fem_reference.motion.generalised_alpha import ConstrainedAlpha
from fem_reference.sheets import shell, start
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.scenes import Material, load

RAMP, PULL = 0.01, 1e-9
LATTICE = ("generalised-alpha", "esdirk")


@pytest.mark.parametrize(
    "how", [*LATTICE, "plate", "shell", pytest.param("solid", marks=pytest.mark.nightly)]
)
def test_a_held_strain_relaxes_as_its_prony_series(how):
    """A strip of next to no mass, pulled in 10 ms and held: R = R∞ (1 + Σ a g e^(−(t−T)/τ)), g of the ramp.
    The update is exact for it; what is left is inertia, damped by the integrator (midpoint and verlet, held
    to esdirk in test_maxwell.py, never do)."""
    strip = pulled(Material(1e6, 0.0, 1e-3, relaxation=BRANCHES), PULL, RAMP)
    timed = {"duration": 0.2, "step": 1e-3, "every": 0.01}
    if how in LATTICE:
        springs = lumped.calibrate(strip.sheet, strip.material, (4, 3))
        run = lumped.simulate(strip, springs, integrator=how, **timed)
        at_rest = lumped.solve(strip, springs).reactions["x1"][0]
    else:
        run, at_rest = (
            fem_reference.simulate(strip, how, elements=1, **timed),
            1e6 * PULL / 0.1 * 0.04 * 0.002,
        )
    assert run.status is Status.CONVERGED
    branches, held = strip.material.branches, run.time > (4.5 if how in LATTICE else 2.0) * RAMP
    fading = [t / RAMP * -np.expm1(-RAMP / t) * np.exp(-(run.time - RAMP) / t) for t in branches.times]
    series = 1.0 + np.array(branches.stiffness) @ fading
    assert np.abs(run.reactions["x1"][held, 0]) == pytest.approx(at_rest * series[held], rel=1e-6)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["plate", "shell"])
def test_energy_is_kept_in_books_with_branches(model):
    """Within the step's error, as without branches; branches dissipate."""
    scene = scenes.load("one-edge-clamped").replace(relaxation=BRANCHES)
    run = fem_reference.simulate(scene, model, 0.1, elements=2)
    assert run.status is Status.CONVERGED
    kinetic, dissipated = run.energies["kinetic"].max(), run.energies["dissipated"]
    assert np.abs(run.balance - run.balance[0]).max() < 2e-3 * kinetic
    assert dissipated[-1] > 0.05 * kinetic and np.diff(dissipated).min() > -1e-6 * kinetic


PER_PERIOD = 40  # the integrator's error in a period is (2π/40)²/12, or 0.2 %


@pytest.mark.sweep(2)
@pytest.mark.parametrize("damped", [{"frequency": 6.0}, {"band": (1.0, 60.0)}])
def test_modes_ring_down_at_their_poles(damped):
    """The first three, within 1 % of ζ; with branches ζ itself is within 10 % of half the loss factor over
    the band."""
    scene = load("one-edge-clamped").replace(gravity=None, loss_factor=0.12, **damped)
    material = scene.material
    for number in range(3):
        model = shell(scene, elements=3, moving=True)
        flat = start(model)
        still, basis = np.zeros_like(flat), model.basis(flat)
        stiffness = model.tangent(model.shape(flat, 0.0, still), still, 0.0, 0.0).toarray()
        square, shapes = eigh(stiffness, (basis.T @ model.mass @ basis).toarray())
        shape = basis @ shapes[:, number]
        pole = material.branches.pole(np.sqrt(square[number]), material.dashpot_time, 0.0)
        step = 2.0 * np.pi / abs(pole.imag) / PER_PERIOD
        method = ConstrainedAlpha(model, step, 1e-9, step)
        motion = method.begin(0.0, model.moved(flat, 1e-6 * shape / np.abs(shape).max()), still).state
        swing = []
        for _ in range(100):
            swing.append(shape @ model.mass @ (motion.q - flat))
            motion = method.advance(motion, step)
        ratio = -pole.real / abs(pole)
        assert damping_ratio(np.array(swing), PER_PERIOD) == pytest.approx(ratio, rel=0.01)
        if "band" in damped and abs(pole.imag) < 2.0 * np.pi * damped["band"][1]:
            assert ratio == pytest.approx(0.06, rel=0.1)
