"""Derivatives of frequencies of the lattice against differences of whole solutions."""

import pytest
from cases import calibrated, sheet

import lumped
from sheetbench import scenes
from sheetbench.errors import Impossible
from sheetbench.scenes import Clamped
from sheetbench.scenes.meaning.parameters import parameter, put


@pytest.mark.parametrize("about", ["flat", "deformed"])
def test_derivatives_of_a_frequency_are_those_of_differences(about):
    tilted = (Clamped(edge="x0", tilt=0.1),)  # which moves nothing about the flat sheet
    scene = sheet(0.2, 0.13, 0.003, 5e6, 0.35, 1100.0, weight=9.81, supports=tilted)

    def modes(scene):
        return lumped.modes(scene, calibrated(scene, (7, 7)), 3, about=about)

    found = modes(scene).sensitivity(2)
    loaded = ("gravity.z",) if about == "deformed" else ()
    for name in ("young", "poisson", "density", "thickness", "tilt_x0", *loaded):
        value = parameter(scene, name).value
        h = 5e-4 * (abs(value) or 1.0)  # residuals of two solves are below 1e-5 of the difference
        up, down = (modes(put(scene, name, at)).frequencies[1] for at in (value + h, value - h))
        assert found[name] == pytest.approx((up - down) / (2.0 * h), rel=1e-5), name
    assert found["cells.young"].sum() == pytest.approx(found["young"], rel=1e-6)
    assert "cells.curvature" in [*found] and "cells.density" not in [*found]
    clamped = tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1"))
    square = scenes.load("one-edge-clamped").replace(supports=clamped)
    with pytest.raises(Impossible, match="modes 2 and 3 coincide"):
        lumped.modes(square, calibrated(square, 5), 4).sensitivity(2)
    with pytest.raises(Impossible, match="need the next mode"):
        modes(scene).sensitivity(3)
