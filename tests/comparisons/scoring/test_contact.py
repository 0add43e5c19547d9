"""Cases of contact: the kept values beside closed forms and shooting, which their bars must cover."""

import numpy as np
import pytest
from contact_cases import CYLINDER_TIP, laid_shape

from comparisons.scoring.reference import references

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
