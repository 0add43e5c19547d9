"""Cases that are not flat at rest, and of contact: the kept values beside closed forms and shooting, which
their bars must cover."""

import numpy as np
import pytest
from contact_cases import CYLINDER_TIP, laid_shape

from comparisons.scoring.reference import references


def arc(points, curvature):
    """Displacements (n, 3) [m] of plan points (n, 2) [m] of a strip bent to an arc [1/m] of zero energy."""
    along, angle = points[:, 0], curvature * points[:, 0]
    return np.column_stack(
        [np.sin(angle) / curvature - along, 0.0 * along, (1.0 - np.cos(angle)) / curvature]
    )


def test_quarter_turn_is_an_arc():
    known = references("natural")["quarter-turn"]
    length, turn = known.scene.sheet.length_x, known.scene.natural.curvature[0]
    assert turn * length == pytest.approx(np.pi / 2.0)
    off = np.abs(known.values - arc(known.scene.probe_points(), turn))
    assert (off <= known.bars).all()
    end = arc(np.array([[length, 0.0]]), turn)[0]
    assert end[0] + length == pytest.approx(end[2]) == pytest.approx(1.0 / turn)


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


def test_heated_plate_has_buckled():
    """Far over what its weight alone would bend it by: 0.00406 w a⁴/B of a hinged square plate."""
    known = references("natural")["heated-plate"]
    scene = known.scene
    thickness, young, poisson = scene.sheet.thickness, scene.material.young, scene.material.poisson
    stiffness = young * thickness**3 / 12.0 / (1.0 - poisson**2)
    by_weight = 0.00406 * scene.material.density * thickness * 9.81 * scene.sheet.length_x**4 / stiffness
    assert -known.values[0, 2] > 20.0 * by_weight


PROBES = references("contact")["pressed"].scene.probes


@pytest.mark.parametrize("drop", [0.05, 0.2])
def test_laid_strips_are_the_heavy_elastica(drop):
    known = references("contact")[f"laid-{drop:g}"]
    exact = laid_shape(drop, [x for x, _ in PROBES.values()])
    off = np.abs(known.values[:, [0, 2]] - exact).max()
    assert off < known.bar * np.abs(exact).max()
    lying = exact[:, 1] == -drop
    assert lying.any()
    assert known.values[lying, 2] == pytest.approx(-drop, rel=1e-6)


def test_strip_over_a_cylinder_is_the_elastica():
    known = references("contact")["over-cylinder"]
    tip = list(PROBES).index("P4")
    assert abs(known.values[tip, 2] - CYLINDER_TIP) < known.bars[tip, 2]


def test_pressed_strip_touches_the_plate_where_it_came_to():
    known = references("contact")["pressed"]
    plate = known.scene.obstacles[0]
    surface = plate.position[2] + plate.displacement(1.0)[2] - known.scene.sheet.thickness / 2.0
    assert surface == pytest.approx(0.15)
    heights = known.values[:, 2]
    assert heights[-1] == pytest.approx(surface, rel=1e-6)
    assert (heights[:-1] < surface).all()


def test_the_lattice_agrees_within_half_a_percent():
    """17 masses across: an independent model, whose own errors are as large."""
    for suite in ("natural", "contact"):
        for known in references(suite).values():
            (lattice,) = [one for one in known.judges if one["model"] == "lumped"]
            assert lattice["error"] < 5e-3, known.name
