"""Cases that are not flat at rest: the kept values beside closed forms, which their bars must cover."""

import numpy as np
import pytest

from comparisons.scoring.natural import RUBBER, STRIP, TURN, arc
from comparisons.scoring.reference import references


def test_quarter_turn_is_an_arc():
    known = references("natural")["quarter-turn"]
    off = np.abs(known.values - arc(known.scene.probe_points()))
    assert (off <= known.bars).all()
    end = arc(np.array([[STRIP.length_x, 0.0]]))[0]
    assert end[0] + STRIP.length_x == pytest.approx(end[2]) == pytest.approx(1.0 / TURN)


def test_bimetal_strip_has_timoshenkos_curvature():
    """Layers of one thickness, moduli of ratio n: k = 6 (α₁ − α₂) ΔT (1 + m)²/(h (3 (1 + m)² + (1 + m n)
    (m² + 1/(m n)))) with m = 1. The clamp keeps a length like the width from bending across, which turns all
    that follows by an angle: a lift that grows with x, where another curvature would lift with x²."""
    known = references("natural")["bimetal-strip"]
    lower, upper = known.scene.layers
    n = lower.young / upper.young
    thickness = known.scene.sheet.thickness
    heated = (lower.expansion - upper.expansion) * known.scene.temperature.change
    curvature = 24.0 * heated / (thickness * (12.0 + (1.0 + n) * (1.0 + 1.0 / n)))
    lifted = known.values - arc(known.scene.probe_points(), curvature)
    middle, end = lifted[[0, 2], 2]  # of the length
    assert 0.0 < end < 0.05 * known.values[2, 2]
    assert end / middle == pytest.approx(2.0, abs=0.25)


def test_band_lifts_its_end_against_the_weight():
    known = references("natural")["muscle-band"]
    middle, end = known.values[0, 2], known.values[2, 2]
    assert middle < 0.0 < end
    assert known.scene.material == RUBBER


def test_heated_plate_has_buckled():
    """Far over what its weight alone would bend it by: 0.00406 w a⁴/B of a hinged square plate."""
    known = references("natural")["heated-plate"]
    scene = known.scene
    thickness, young, poisson = scene.sheet.thickness, scene.material.young, scene.material.poisson
    stiffness = young * thickness**3 / 12.0 / (1.0 - poisson**2)
    by_weight = 0.00406 * scene.material.density * thickness * 9.81 * scene.sheet.length_x**4 / stiffness
    assert -known.values[0, 2] > 20.0 * by_weight
