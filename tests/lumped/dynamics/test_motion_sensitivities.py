"""Derivatives along a run against differences of runs of the same steps."""

import numpy as np
import pytest

import lumped
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeLoad, load
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.natural import Natural

SCENE = load("one-edge-clamped").replace(
    loss_factor=0.12, frequency=3.0, natural=Natural(curvature=(2.0, 0.0, 0.0))
)


def run(scene, **options):
    springs = lumped.calibrate(scene.sheet, scene.material, (4, 4, 2))
    return lumped.simulate(scene, springs, 0.04, every=4e-3, **options)


def test_derivatives_by_e_loss_and_curvature_are_those_of_differences():
    """Within 1e-5; the run is the one without them, adaptive or not."""
    names = ["young", "loss_factor", "natural.kxx"]
    found = run(SCENE, step=1e-3, sensitivities=names)
    for name in names:
        value = parameter(SCENE, name).value

        def slope(h, name=name, value=value):
            up, down = (run(put(SCENE, name, value + end), step=1e-3).probes["P4"] for end in (h, -h))
            return (up - down) / (2.0 * h)

        h = 5e-3 * value
        expected = (4.0 * slope(0.5 * h) - slope(h)) / 3.0
        off = np.abs(found.extra["sensitivities"][name]["P4"] - expected).max()
        assert off < 1e-5 * np.abs(expected).max(), name
    adaptive = run(SCENE, sensitivities=["young"])
    assert np.array_equal(adaptive.probes["P4"], run(SCENE).probes["P4"])
    slope, fixed = (one.extra["sensitivities"]["young"]["P4"] for one in (adaptive, found))
    assert np.abs(slope - fixed).max() < 1e-2 * np.abs(fixed).max()


def test_runs_that_cannot_have_derivatives_say_so():
    for options, said in (
        ({"integrator": "verlet"}, "need integrator = 'esdirk'"),
        ({"store": "run"}, "leave the store out"),
        ({"names": ["young"] * 21}, "20 at most"),
        ({"names": ["tilt_x0"]}, "not by positions of supports"),
        ({"names": ["nothing"]}, "not a parameter"),
    ):
        with pytest.raises(BadInput, match=said):
            run(SCENE, sensitivities=options.pop("names", ["young"]), **options)
    with pytest.raises(BadInput, match="has derivatives by up to 20"):
        run(SCENE.replace(loads=(EdgeLoad(edge="x1", force_per_length=(0, 0, 1.0)),))).gradient("P4.uz")
