"""The two solvers, which share nothing, against each other on Habibi et al.'s curved edge and on softer
sheets."""

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
@pytest.mark.parametrize(
    ("masses", "within"), [(9, 0.07), (17, 0.02), pytest.param(65, 0.005, marks=pytest.mark.nightly)]
)
def test_curved_edge(references, name, masses, within):
    """As a share of the sheet's largest displacement and, more strictly, of the largest at the probes."""
    scene = scenes.load(name)
    coarse = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, (masses, masses)))
    points = scene.probe_points()
    truth = references[name].displacement(points)
    gap = np.abs(coarse.displacement(points) - truth).max()
    assert gap < within * largest_displacement(references[name], scene)
    assert gap < within * np.abs(truth).max()


def test_a_stretched_rubber_bends_as_what_it_has_thinned_to():
    """A square stretched along x to λ, then bent across by a small pressure between simply supported edges:
    solid of 6 elements 0.9088 mm at λ = 1.5 and 0.7917 at rest. The shell thins with it; a lattice's layers
    keep their distance and bend by t² = 1/λ of that, unless they are given the thinned sheet's."""
    stretch, thickness, side = 1.5, 2e-3, 0.1
    drawn = {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [(stretch - 1.0) * side, 0.0, 0.0]]}
    supports = [
        {"kind": "held", "edge": "x0", "components": ["x"]},
        {"kind": "held", "edge": "x1", "components": ["x"], "motion": drawn},
        {"kind": "held", "edge": "y0", "components": ["y", "z"]},
        {"kind": "held", "edge": "y1", "components": ["z"]},
    ]
    scene = scenes.Scene(
        name="stretched",
        sheet=scenes.Sheet(side, side, thickness),
        material=scenes.Material(1e6, 0.49, 1000.0, law="neo-hookean"),
        supports=supports,
        loads=[{"kind": "pressure", "value": 0.5}],
    )

    def deflection(solution):
        return 1e3 * solution.displacement([[side / 2.0, side / 2.0]])[0, 2]

    def lattice(**options):
        springs = lumped.calibrate(scene.sheet, scene.material, 17, "hyperelastic", **options)
        return deflection(lumped.solve(scene, springs))

    assert deflection(fem_reference.solve(scene, elements=6)) == pytest.approx(0.9088, rel=4e-3)
    assert lattice(layer_distance=thickness / (3.0 * stretch) ** 0.5) == pytest.approx(0.9088, rel=6e-3)
    assert lattice() * stretch == pytest.approx(0.9088, rel=1e-2)
