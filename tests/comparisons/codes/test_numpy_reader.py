"""The reader in NumPy: its tangent from few forces, and the lattices that it is too small for."""

import runpy
from pathlib import Path

import numpy as np
import pytest
from cases import CLAMP, GRAVITY

import lumped
from comparisons.codes.arrays import arrays
from sheetbench.scenes import Material, Scene, Sheet

PLACE = Path(__file__).parents[3] / "comparisons" / "codes" / "scripts" / "read_lattice.py"
NUMPY = runpy.run_path(str(PLACE))


def test_the_numpy_reader_finds_all_of_a_tangent_from_few_forces():
    scene = Scene("strip", Sheet(0.12, 0.08, 0.003), Material(1.5e6, 0.45, 1100.0), GRAVITY, (CLAMP,))
    lattice = arrays(lumped.describe(scene, lumped.calibrate(scene.sheet, scene.material, grid=6)))
    along, rest = NUMPY["differences"](lattice), lattice["positions"]
    near, groups = NUMPY["neighbours"](along)
    assert sorted(mass for group in groups for mass in group) == list(range(len(rest))) and len(
        groups
    ) <= 18 < len(rest)
    gradient, h = NUMPY["gradient"], 1e-8
    force = gradient(lattice, along, np.zeros_like(rest))[1]
    found = NUMPY["stiffness"](lattice, along, (near, groups), np.zeros_like(rest), force, h)
    for column in (0, 50, 3 * len(rest) - 1):
        moved = np.zeros(rest.size)
        moved[column] = h
        alone = (gradient(lattice, along, moved.reshape(-1, 3))[1] - force).ravel() / h
        np.testing.assert_allclose(found[:, column], alone, atol=1e-9 * np.abs(alone).max())


def test_the_numpy_reader_says_what_it_is_too_small_for():
    many = {"positions": np.zeros((5000, 3))}
    with pytest.raises(SystemExit, match="for 1500 masses at most: write a lattice of a smaller --grid"):
        NUMPY["equilibrium"](many, {})
