"""Narrow strips of oblique fibres, clamped at an end, under a small weight: lattice against shell."""

import numpy as np
import pytest
from cases import sheet

import fem_reference
from comparisons.comparison.comparison import error
from comparisons.models.expected_error import expected_error
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from sheetbench.answers.solution import Status
from sheetbench.scenes import Material

# E1, E2, G12 [MPa], degrees, length and width [mm] of a sheet 1 mm thick; errors in percent with 5, 9 and 17
# masses across, against a shell of 16 elements across
STRIPS = {
    (100, 2, 1.0, 20, 100, 20): (1.45, 0.98, 0.33),
    (100, 2, 1.0, 30, 100, 20): (3.08, 1.48, 0.51),
    (100, 2, 1.0, 10, 100, 10): (0.13, 0.01, 0.09),
    (20, 2, 1.2, 20, 120, 20): (0.28, 0.14, 0.05),
    (20, 2, 1.2, 45, 120, 20): (0.78, 0.30, 0.11),
    (20, 2, 1.2, 20, 100, 10): (0.23, 0.08, 0.01),
    (20, 2, 1.2, 30, 100, 10): (0.49, 0.17, 0.05),
    (20, 2, 1.2, 20, 100, 50): (0.17, 0.12, 0.09),
    (20, 2, 1.2, 20, 100, 100): (2.87, 0.53, 0.05),
}
MASSES = (5, 9, 17)


def strip(young_1, young_2, shear, angle, length, width):
    x, y = 1e-3 * length, 1e-3 * width
    moduli = {"young_1": 1e6 * young_1, "young_2": 1e6 * young_2, "shear_12": 1e6 * shear, "poisson_12": 0.3}
    material = Material(kind="orthotropic", density=1.0, angle=float(np.radians(angle)), **moduli)
    probes = {"A": (x, 0.0), "B": (x, y / 2), "C": (x, y), "D": (x / 2, y / 2)}
    return sheet(x, y, 1e-3, material=material, weight=9.81, probes=probes)


def measured(scene, masses, elements=16):
    """Of each grid the status, the error and the expected one, shares of the largest displacement."""
    points = scene.probe_points()
    shell = fem_reference.solve(scene, "shell", elements=elements).displacement(points)
    rows = []
    for n in masses:
        lattice = resolve(scene, Lattice(n))
        found = solve(lattice)
        expected = expected_error(scene, lattice.spec, found, lambda other: solve(resolve(scene, other)))
        value = getattr(expected, "value", None)
        rows.append((found.status, error(found.displacement(points), shell), value))
    return rows


def test_a_narrow_strip_of_strong_fibres_is_as_near_as_others():
    """On 5 and 9 masses it was 21 and 17 % off, and unstable on 17."""
    rows = measured(strip(100, 2, 1.0, 20, 100, 20), (5, 9), elements=8)
    assert [row[0] for row in rows] == [Status.CONVERGED] * 2
    assert rows[0][1] < 0.016 and rows[1][1] < 0.011


@pytest.mark.nightly
def test_the_table_of_strips():
    """None above what is said of it, 0.55 % on 17 masses; the error that is expected, where one is, within a
    factor of two in four of five."""
    ratios = []
    for constants, percent in STRIPS.items():
        for (status, found, expected), said in zip(measured(strip(*constants), MASSES), percent, strict=True):
            assert status == Status.CONVERGED
            assert 100 * found < said + 0.01, (constants, found)
            if expected is not None:
                ratios.append(found / expected)
        assert 100 * found < 0.55
    within = [0.5 < ratio < 2.0 for ratio in ratios]
    assert len(within) >= 20 and np.mean(within) >= 0.8
