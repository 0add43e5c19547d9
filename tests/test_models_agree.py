"""The two solvers, which share nothing, against each other on Habibi et al.'s curved edge and on softer
sheets."""

import pytest
from cases import sheet

import fem_reference
import lumped
from sheetbench import scenes


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
    rubber = scenes.Material(1e6, 0.49, 1000.0, law="neo-hookean")
    loads = [{"kind": "pressure", "value": 0.5}]
    scene = sheet(side, side, thickness, material=rubber, supports=supports, loads=loads)

    def deflection(solution):
        return 1e3 * solution.displacement([[side / 2.0, side / 2.0]])[0, 2]

    def lattice(**options):
        springs = lumped.calibrate(scene.sheet, scene.material, 17, "hyperelastic", **options)
        return deflection(lumped.solve(scene, springs))

    assert deflection(fem_reference.solve(scene, elements=6)) == pytest.approx(0.9088, rel=4e-3)
    assert lattice(layer_distance=thickness / (3.0 * stretch) ** 0.5) == pytest.approx(0.9088, rel=6e-3)
    assert lattice() * stretch == pytest.approx(0.9088, rel=1e-2)
