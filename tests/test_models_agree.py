"""The two solvers, which share nothing, against each other on the seed's curved edge and on softer sheets."""

import numpy as np
import pytest

import fem_reference
import lumped
from sheetbench import scenes

CURVED = ("curved-edge", "curved-edge-down")


@pytest.fixture(scope="module")
def references():
    return {name: fem_reference.solve(scenes.load(name), model="shell", elements=16) for name in CURVED}


def largest_displacement(solution, scene):
    side = np.linspace(0.0, 1.0, 33)
    points = np.array([[x * scene.sheet.length_x, y * scene.sheet.length_y] for x in side for y in side])
    return np.abs(solution.displacement(points)).max()


@pytest.mark.parametrize("name", CURVED)
@pytest.mark.parametrize(("masses", "within"), [(9, 0.07), (17, 0.02), (65, 0.005)])
def test_curved_edge(references, name, masses, within):
    """As a share of the sheet's largest displacement and, more strictly, of the largest at the probes."""
    scene = scenes.load(name)
    coarse = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, (masses, masses)))
    points = scene.probe_points()
    truth = references[name].displacement(points)
    gap = np.abs(coarse.displacement(points) - truth).max()
    assert gap < within * largest_displacement(references[name], scene)
    assert gap < within * np.abs(truth).max()
