"""Elastic rods on the linear plate: the limit of small deflections."""

import numpy as np
import pytest
from rod_cases import CHAINS, chain, driven

import fem_reference
from sheetbench.scenes import Chain, Gravity


def small(scene, factor=1e-3):
    """The scene's weight and intrinsic curvature scaled down."""
    (one,) = scene.actuators
    curved = np.multiply(one.curvature, factor).tolist()
    weight = Gravity(acceleration=(0.0, 0.0, -9.81 * factor))
    scaled = Chain(**{**one.model_dump(), "curvature": curved})
    return scene.model_copy(update={"gravity": weight, "actuators": (scaled,)})


@pytest.mark.sweep
@pytest.mark.parametrize("base", ["free", "middle"])
@pytest.mark.parametrize("name", CHAINS)
def test_the_plate_is_the_limit_of_small_deflections(name, base):
    settings = dict(CHAINS[name])
    if base == "middle" and name == "list":
        settings["curvature"] = (*settings["curvature"], 2.0)
    scene = small(driven(chain(**settings, base=base)))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    plate = fem_reference.solve(scene, model="plate", elements=12)
    expected = fem_reference.solve(scene, model="shell", elements=12)
    truth = expected.displacement(points)
    assert np.abs(plate.displacement(points) - truth).max() < 3e-3 * np.abs(truth).max()
    assert plate.energies["rod"] == pytest.approx(expected.energies["rod"], rel=3e-3)
    own = 0.05 * 0.188 * 9.81e-3
    sheet = 1678.0 * 0.003 * 0.188**2 * 9.81e-3
    total = plate.actuators["x1"].sum(axis=0)[:3]
    held = sum(plate.reactions.values())
    np.testing.assert_allclose(held, [0.0, 0.0, sheet + own], atol=1e-5 * sheet)
    np.testing.assert_allclose(total + plate.reactions["x0"], [0.0, 0.0, sheet], atol=1e-5 * sheet)
    assert np.all(plate.mesh.point_data["actuator_line_force"][plate.mesh.points[:, 0] < 0.187] == 0.0)
