"""Narrow strips of oblique fibres, clamped at an end, under a small weight: lattice against shell."""

import numpy as np
import pytest
from cases import relative, sheet

from sheetbench.answers.solution import Status
from sheetbench.face import solve
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


ROWS = [(row, n, said) for row, percent in STRIPS.items() for n, said in zip(MASSES, percent, strict=True)]


@pytest.mark.sweep(8)
@pytest.mark.parametrize(("constants", "masses", "percent"), ROWS, ids=str)
def test_a_narrow_strip_of_oblique_fibres_is_as_near_as_others(constants, masses, percent):
    """None above what is said of it, 0.55 % on 17 masses; they were 21 and 17 % off, and unstable on 17."""
    scene = strip(*constants)
    points = scene.probe_points()
    shell, found = solve(scene, "shell", elements=16), solve(scene, grid=masses)
    assert found.status is Status.CONVERGED
    assert 100.0 * relative(found.displacement(points), shell.displacement(points)) < percent + 0.01
