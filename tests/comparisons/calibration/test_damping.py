"""Damping from what is known of a material: the relation, the modes that have it, measured moduli."""

import numpy as np
import pytest

from comparisons.calibration.calibrate import subject
from comparisons.calibration.damping import keys
from sheetbench.errors import BadInput
from sheetbench.scenes import Branches, load


def test_a_pole_is_that_of_the_equation_of_motion():
    """One branch is a third-order system: its characteristic polynomial, in closed form."""
    a, tau, omega = 0.4, 0.03, 40.0
    roots = np.roots([tau, 1.0, omega**2 * tau * (1.0 + a), omega**2])
    swinging = roots[np.argmax(roots.imag)]
    assert Branches((a,), (tau,)).pole(omega) == pytest.approx(swinging, rel=1e-9)


TRUE = Branches((0.3, 0.2), (0.01, 0.5))


def test_moduli_of_a_dynamic_test_and_of_a_relaxation_become_branches(tmp_path):
    """Within 2 %: two branches a decade cannot sit on the true times."""
    at = np.geomspace(0.05, 100.0, 40)
    storage, loss = TRUE.storage_and_loss(at)
    lines = [f"{f},{0.3 * s},{0.3 * v}" for f, s, v in zip(at, storage, loss, strict=True)]
    dma, relaxed = tmp_path / "dma.csv", tmp_path / "relaxed.csv"
    dma.write_text("\n".join(["Frequency [Hz],Storage (MPa),Loss (MPa)", *lines]), encoding="utf-8")
    time = np.geomspace(1e-3, 10.0, 60)
    moduli = 0.3 * (1.0 + np.exp(-time[:, None] / TRUE.times) @ TRUE.stiffness)
    lines = [f"{t},{e}" for t, e in zip(time, moduli, strict=True)]
    relaxed.write_text("\n".join(["time [s],modulus [MPa]", *lines]), encoding="utf-8")
    for file in (dma, relaxed):
        material = subject("one-edge-clamped", keys(prony=file)).material
        assert material.young == pytest.approx(0.3e6, rel=0.02)
        found, lost = material.branches.storage_and_loss(at)
        assert material.young * found == pytest.approx(0.3e6 * storage, rel=0.03)
        peak = loss > 0.3 * loss.max()
        assert lost[peak] == pytest.approx(loss[peak], rel=0.12)


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("frequency,storage,loss\n1,1e6,1e5\n2,1e6,1e5\n2,1e6,1e5\n4,1e6,1e5\n", "line 4: frequency = '2'"),
        ("time,modulus\n1,1e6\n2,1e6\n3,-1e6\n4,1e6\n", "greater than 0"),
        ("time,force\n1,1\n", "needed are frequency, storage"),
        ("time,modulus [mm]\n1,1e6\n", "is a length"),
    ],
)
def test_tables_of_moduli_that_are_none_are_refused(tmp_path, text, named):
    file = tmp_path / "moduli.csv"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(BadInput, match=named):
        keys(prony=file)


def test_the_scenes_own_damping_gives_way():
    damped = load("one-edge-clamped").replace(damping_time=1e-3)
    assert subject(damped, keys(loss_factor=0.1, at=5.0)).material.damping_time == 0.0
