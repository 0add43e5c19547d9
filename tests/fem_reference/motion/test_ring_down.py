"""Modes of the moving shell let go one by one: each rings down with the material's damping."""

import numpy as np
import pytest
from ring_down import damping_ratio
from scipy.linalg import eigh

from fem_reference.motion.generalised_alpha import ConstrainedAlpha
from fem_reference.sheets import shell, start
from sheetbench.scenes import load

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
        motion = method.begin(0.0, model.moved(flat, 1e-6 * shape / np.abs(shape).max()), still)
        swing = []
        for _ in range(100):
            swing.append(shape @ model.mass @ (motion.q - flat))
            motion = method.advance(motion, step)
        ratio = -pole.real / abs(pole)
        assert damping_ratio(np.array(swing), PER_PERIOD) == pytest.approx(ratio, rel=0.01)
        if "band" in damped and abs(pole.imag) < 2.0 * np.pi * damped["band"][1]:
            assert ratio == pytest.approx(0.06, rel=0.1)
