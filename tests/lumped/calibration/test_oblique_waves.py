"""Waves oblique to the grid: the interior's error in l², in closed form, and the orders that it explains."""

import math

import numpy as np
import pytest

import lumped
from lumped.assembly import Assembly
from sheetbench.scenes import Clamped, load

SEED = load("two-edges-clamped")
# uz [m] at the centre of Habibi et al.'s sheet with four edges clamped, linear, by a Mindlin plate of 48
# graded elements (fem_reference, model="plate"; 36 are within 0.0003 %).
CENTRE = -0.00049324826


def rigidities(sheet, material):
    """D [N·m] and κGh [N/m] of the sheet."""
    bending = material.young * sheet.thickness**3 / 12.0 / (1.0 - material.poisson**2)
    return bending, 5.0 / 6.0 * material.young / 2.0 / (1.0 + material.poisson) * sheet.thickness


def softness(sheet, material, cell):
    """3ν − 1 + 2 S*/κGh: the stiffness against a wave at the angle θ to the grid is too small by this times
    sin² 2θ (q l)²/48 (docs/theory.md)."""
    bending, sheared = rigidities(sheet, material)
    return 3.0 * material.poisson - 1.0 + 2.0 / (1.0 + sheared * cell**2 / (12.0 * bending))


def stiffness_of_wave(sheet, springs, wave):
    """Load over deflection [N/m³] of a wave [1/m] that a boundless lattice of these springs carries."""
    masses = springs.grid[0]
    assembly = Assembly(sheet, springs, twisting=frozenset())
    at, pattern = assembly.lattice.positions, assembly.pattern
    blocks = assembly.tangent(np.zeros_like(at))
    middle = masses // 2 * (masses + 1)  # a column of two masses inside
    matrix = np.zeros((2, 3, 2, 3), complex)
    for layer in range(2):
        own = 2 * middle + layer
        for slot in range(pattern.indptr[own], pattern.indptr[own + 1]):
            other = pattern.indices[slot]
            phase = np.exp(1j * float((at[other] - at[own])[:2] @ wave))
            matrix[layer, :, other % 2] += blocks[slot] * phase
    load = np.array([0.0, 0.0, 0.5, 0.0, 0.0, 0.5])
    cell = sheet.length_x / (masses - 1)
    return float(1.0 / (load @ np.linalg.solve(matrix.reshape(6, 6), load)).real / cell**2)


@pytest.mark.parametrize("poisson", [0.1, 0.48])
@pytest.mark.parametrize("thickness", [0.0005, 0.003, 0.03])
def test_error_of_an_oblique_wave(thickness, poisson):
    """At q l = 0.1 the next term, in (q l)⁴, and rounding are 1e-6. Along an axis there is no error in l²."""
    sheet = SEED.sheet.model_copy(update={"thickness": thickness})
    material = SEED.material.model_copy(update={"poisson": poisson})
    cell, across = sheet.length_x / 4, 0.1
    bending, sheared = rigidities(sheet, material)
    number = across / cell
    exact = 1.0 / (1.0 / (bending * number**4) + 1.0 / (sheared * number**2))
    for method, bracket in (("consistent", softness(sheet, material, cell)), ("consistent-oblique", 0.0)):
        springs = lumped.calibrate(sheet, material, 5, method)
        for angle in (0.0, math.pi / 8, math.pi / 4):
            wave = number * np.array([math.cos(angle), math.sin(angle)])
            error = stiffness_of_wave(sheet, springs, wave) / exact - 1.0
            expected = -bracket * math.sin(2.0 * angle) ** 2 * across**2 / 48.0
            assert error == pytest.approx(expected, rel=0.01, abs=2e-6)


@pytest.mark.parametrize(("masses", "held"), [(9, 2e-3), (17, 1.5e-4), (33, 2.5e-5)])
def test_consistent_oblique_removes_the_error_of_the_interior(masses, held):
    """Habibi et al.'s sheet with four edges clamped, linear, by `consistent-oblique`: its centre sags 0.172,
    0.0126, 0.0018 % too much at 9, 17 and 33 masses a side."""
    scene = SEED.replace(supports=tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1")))
    springs = lumped.calibrate(scene.sheet, scene.material, masses, "consistent-oblique")
    answer = lumped.solve(scene, springs, linear=True)
    assert float(answer.displacement(np.array([[0.094, 0.094]]))[0, 2]) == pytest.approx(CENTRE, rel=held)
