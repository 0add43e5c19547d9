"""What is written of a lattice besides its springs: the dampers of its motion, the states to check by."""

import numpy as np
from cases import CLAMP, RUBBER, SHEET

import lumped
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grid import grid_of
from sheetbench.scenes.objects.springs import DamperSet


def spring_set(scene, grid, **settings):
    cells = lumped.sections_of(scene, grid_of(scene.sheet, grid))
    own = {} if cells is None else {"cells": cells}
    return lumped.calibrate(scene.sheet, scene.material, grid=grid, **own, **settings)


def test_dampers_are_those_of_the_motion():
    material = RUBBER.model_copy(update={"damping_time": 4e-3, "damping_rate": 2.0})
    scene = Scene(name="damped", sheet=SHEET, material=material, support=(CLAMP,))
    found = lumped.describe(scene, spring_set(scene, 3))
    np.testing.assert_allclose(found.links.damping, 4e-3 * found.links.stiffness)
    for cells in found.cells:
        np.testing.assert_allclose(cells.damping, 4e-3 * cells.stiffness)
    assert found.damping_rate == 2.0
    own = scene.model_copy(update={"dampers": DamperSet(axial=3.0, vertical=5.0)})
    found = lumped.describe(own, spring_set(scene, 3))
    ends = found.links.masses[found.links.damping > 0.0]
    assert set(found.links.family[found.links.damping > 0.0]) == {"axial", "vertical"}
    assert len({tuple(pair) for pair in found.links.masses.tolist()}) == len(found.links.masses)
    assert len(ends) == 24 + 9 and not any(cells.damping.any() for cells in found.cells)
