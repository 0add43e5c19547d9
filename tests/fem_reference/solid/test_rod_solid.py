"""Elastic rods on the solid: as on the shell, with columns that follow their directors."""

import numpy as np
import pytest
from rod_cases import CHAINS, chain, driven, shell

import fem_reference
from sheetbench.answers.solution import Status


def solid(scene, elements=8, layers=1):
    return fem_reference.solve(scene, model="solid", elements=elements, layers=layers)


@pytest.mark.sweep
@pytest.mark.parametrize("name", CHAINS)
def test_the_solid_agrees_with_the_shell(name):
    """Displacements within 0.2 %, the rod's energy within 1 %; forces balance."""
    scene = driven(chain(**CHAINS[name]))
    points = scene.probe_points()
    answer, expected = solid(scene), shell(scene)
    assert answer.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 2e-3 * np.abs(truth).max()
    assert answer.energies["rod"] == pytest.approx(expected.energies["rod"], rel=1e-2)
    sheet, own = 1678.0 * 0.003 * 0.188**2 * 9.81, 0.05 * 0.188 * 9.81
    np.testing.assert_allclose(answer.reactions["x0"], [0.0, 0.0, sheet + own], atol=1e-8)
    np.testing.assert_allclose(answer.actuators["x1"].sum(axis=0)[:3], [0.0, 0.0, -own], atol=1e-8)
    moment, agreed = (each.actuators["x1"][:, 3:] for each in (answer, expected))
    np.testing.assert_allclose(moment[8:16], agreed[8:16], atol=0.02 * np.abs(agreed).max())


@pytest.mark.sweep(2)
@pytest.mark.parametrize("edges", [("y1",), ("x1", "y1"), ("y0", "y1")])
def test_rods_that_meet_each_other_and_a_clamp(edges):
    """They end at corners whose column the clamp holds or the other rod turns too."""
    scene = driven(*(chain(edge=edge, curvature=-4.0, bending_stiffness=0.02) for edge in edges))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    answer, expected = solid(scene), shell(scene)
    assert answer.status is expected.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 2e-3 * np.abs(truth).max()


@pytest.mark.sweep
@pytest.mark.parametrize("base", ["start", "middle", "end"])
def test_a_base_holds_the_solid(base):
    scene = driven().model_copy(update={"supports": (), "actuators": (chain(edge="y0", base=base),)})
    answer, expected = solid(scene), shell(scene)
    assert answer.status is Status.CONVERGED
    points = scene.probe_points()
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 1e-3 * np.abs(truth).max()
    sheet, own = 1678.0 * 0.003 * 0.188**2 * 9.81, 0.05 * 0.188 * 9.81
    np.testing.assert_allclose(answer.reactions["y0 base"], [0.0, 0.0, sheet + own], atol=1e-7)
    np.testing.assert_allclose(answer.actuators["y0"].sum(axis=0)[:3], [0.0, 0.0, sheet], atol=1e-7)
