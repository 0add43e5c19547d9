"""The compiled equations of a lattice against those that its springs and loads make call by call."""

import numpy as np
import pytest

import lumped
from sheetbench.scenes import load
from sheetbench.scenes.loads import Pressure
from sheetbench.scenes.supports import Clamped, Hinged

SCENE = load("two-edges-clamped")
CASES = {
    "dead loads": SCENE,
    "a hinge, pressure": SCENE.replace(
        supports=(Hinged(edge="x0"), Clamped(edge="y0")), loads=(Pressure(value=40.0),)
    ),
    "a rod that bends": load("curved-edge"),
}


@pytest.mark.parametrize("scene", CASES.values(), ids=CASES)
def test_compiled_equations_are_the_general_ones(scene):
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 4))
    one, other = (lumped.build_problem(scene, springs) for _ in range(2))
    assert one.equations is not None
    other.equations = None
    drawn = 1e-4 * np.random.default_rng(0).standard_normal((2, *one.loads.dead.shape))
    u, step = drawn[0], one.expand(one.constraints.nearest(drawn[1]))
    found, expected = (problem.advance(u, step, 0.7, True) for problem in (one, other))
    assert np.array_equal(found.u, expected.u) and found.length == expected.length
    assert found.residual.reduced == pytest.approx(expected.residual.reduced, rel=1e-12, abs=1e-13)
    assert found.residual.relative == pytest.approx(expected.residual.relative, rel=1e-12)
    blocks, general = (problem.linearise(u, 0.7, found.stresses).blocks for problem in (one, other))
    assert blocks == pytest.approx(general, rel=1e-12, abs=1e-14 * np.abs(general).max())
