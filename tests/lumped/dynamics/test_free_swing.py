"""A sheet let go at rest, held along one edge: the lattice's masses are what makes its motion right.

P4 of `one-edge-clamped` [mm], by `fem_reference.simulate` with 16 × 16 elements and an error of 1e-6 a step;
8 × 8 elements are 0.14 % of the peak off it.
"""

import numpy as np
import pytest

import lumped
from sheetbench.scenes import load

TIMES = np.arange(0.05, 0.401, 0.05)
P4 = np.array(
    [
        [-0.954, 0.002, -17.733],
        [-9.942, 0.009, -56.457],
        [-24.093, 0.009, -85.729],
        [-24.319, 0.002, -85.798],
        [-9.269, 0.007, -54.322],
        [-0.668, -0.008, -14.902],
        [-0.010, -0.007, 0.943],
        [-0.996, -0.002, -18.523],
    ]
)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("masses, held", [(9, 0.007), (17, 0.005)])
@pytest.mark.parametrize("integrator", ["esdirk", "verlet"])
def test_a_free_swing_is_the_shells(masses, held, integrator):
    """With tributary masses 3.2 and 0.65 % off; of second order in the cells."""
    scene = load("one-edge-clamped")
    springs = lumped.calibrate(scene.sheet, scene.material, masses)
    history = lumped.simulate(scene, springs, 0.4, every=0.05, integrator=integrator)
    off = np.abs(1e3 * history.probes["P4"][1:] - P4).max() / np.abs(P4).max()
    assert np.allclose(history.time[1:], TIMES) and off < held
