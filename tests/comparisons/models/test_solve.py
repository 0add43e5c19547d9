"""What an answer remembers of how its model was chosen."""

from dataclasses import replace

import pytest

import lumped
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice
from sheetbench.errors import BadInput
from sheetbench.scenes import load
from sheetbench.scenes.meaning.parameters import put


def test_a_gradient_finds_springs_again_by_the_same_choices():
    scene = load("one-edge-clamped")
    fixed = solve(resolve(scene, Lattice((5, 5, 2), k=550.0))).gradient(of="P4.uz", by=["young", "density"])
    assert fixed["young"] == 0.0 > fixed["density"]  # of springs that do not depend on E
    settings = {"layer_distance": 0.004}
    found = solve(resolve(scene, Lattice((5, 5, 2), **settings))).gradient(of="P4.uz", by=["sheet.thickness"])
    ends = [
        solve(resolve(put(scene, "thickness", h), Lattice((5, 5, 2), **settings))).probes["P4"][2]
        for h in (0.00300003, 0.00299997)
    ]
    assert found["sheet.thickness"] == pytest.approx((ends[0] - ends[1]) / 6e-8, rel=1e-5)
    fitted = replace(lumped.calibrate(scene.sheet, scene.material, 3), method="fit-static")
    with pytest.raises(BadInput, match="calibration 'fit-static' do not follow"):
        lumped.solve(scene, fitted).gradient(of=[[0.0, 0.0, 1.0]], at=[[0.1, 0.1]], by=["young"])


def test_lattice_and_shell_have_the_same_gradients():
    """Each of its own mechanics, both to about what their displacements differ by."""
    scene, by = load("one-edge-clamped"), ["material.young", "sheet.thickness", "density", "gravity.z"]
    lattice, shell = (
        solve(resolve(scene, spec)).gradient(of="P4.uz", by=by)
        for spec in (Lattice((9, 9, 2)), Elements("shell", 6))
    )
    for name in by:
        assert lattice[name] == pytest.approx(shell[name], rel=0.01), name
