"""Runs of references in a folder: gone on with after a kill to the last bit, and steps that fail halved."""

import shutil

import numpy as np
import pytest

import fem_reference
from fem_reference.motion.generalised_alpha import ConstrainedAlpha
from sheetbench.answers.solution import Status
from sheetbench.numerics.time.method import StepFailed
from sheetbench.scenes import Air, BadInput, load
from sheetbench.scenes.objects.tables import FactorTable

BENT = FactorTable(time=(0.0, 0.013, 0.05), factor=(0.0, 1.0, 0.5))


@pytest.mark.sweep(2)
@pytest.mark.parametrize("options", [{}, {"step": 1e-3}])
def test_a_killed_run_goes_on_to_the_last_bit(tmp_path, options):
    """From a copy of its folder between two samples, which is what kill -9 leaves there; with a bend of a
    load's history before the checkpoint and one after."""
    scene = load("two-edges-settling")
    scene = scene.replace(gravity=scene.gravity.replace(history=BENT), air=Air(drag=1.2))
    whole, killed, after = tmp_path / "whole", tmp_path / "killed", []

    def kill(time):
        after.extend([time] if (whole / "checkpoint.npz").exists() else [])
        if len(after) == 3:
            shutil.copytree(whole, killed)

    def run(folder, duration=0.07, progress=None):
        return fem_reference.simulate(
            scene,
            "shell",
            duration,
            elements=2,
            every=1e-3,
            frames=15,
            store=folder,
            progress=progress,
            **options,
        )

    at_once, resumed = run(whole, progress=kill), run(killed)
    for name in ("samples.bin", "frames.bin"):
        assert (killed / name).read_bytes() == (whole / name).read_bytes()
    assert (resumed.steps, resumed.status) == (at_once.steps, Status.CONVERGED)
    assert 0.0 < resumed.resumed_from < 0.07 and at_once.resumed_from == 0.0
    assert np.array_equal(resumed.extra["frames"], at_once.extra["frames"])
    assert len(run(killed, duration=0.08).time) == 81
    with pytest.raises(BadInput, match="another run"):
        fem_reference.simulate(scene, "plate", 0.07, elements=2, store=killed)


def test_a_fixed_step_that_fails_is_halved_and_said(monkeypatch):
    once = ConstrainedAlpha._advanced

    def failing(self, motion, h):
        if h > 0.9e-3 and 4e-3 < motion.time < 5.5e-3:
            raise StepFailed("on request")
        return once(self, motion, h)

    scene = load("two-edges-settling")
    plain = fem_reference.simulate(scene, "shell", 0.01, elements=2, step=1e-3, every=2e-3)
    monkeypatch.setattr(ConstrainedAlpha, "_advanced", failing)
    halved = fem_reference.simulate(scene, "shell", 0.01, elements=2, step=1e-3, every=2e-3)
    assert halved.status is Status.CONVERGED and halved.settings["failed_steps"] >= 1
    assert "failed_steps" not in plain.settings
    for probe, u in plain.probes.items():
        assert np.abs(halved.probes[probe] - u).max() < 2e-3 * np.abs(plain.probes["P4"]).max()
