"""Solves in threads beside each other: the answers of one after the other, to the last bit."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np

import lumped
from sheetbench.scenes import load

SCENE = load("two-edges-clamped")
SPRINGS = lumped.calibrate(SCENE.sheet, SCENE.material, grid=(5, 5))


def test_threads_do_not_disturb_each_other():
    several = [SPRINGS.with_constant("diagonal", k) for k in np.linspace(2000.0, 9000.0, 12)]
    with ThreadPoolExecutor(3) as pool:
        answers = list(pool.map(lambda springs: lumped.solve(SCENE, springs), several))
    for many, springs in zip(answers, several, strict=True):
        single = lumped.solve(SCENE, springs)
        assert (many.status, many.iterations) == (single.status, single.iterations)
        np.testing.assert_array_equal(many.mesh.point_data["reaction"], single.mesh.point_data["reaction"])
