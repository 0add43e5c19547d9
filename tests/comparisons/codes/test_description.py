"""What is written of a lattice besides its springs: the dampers of its motion, the states to check by."""

import numpy as np
from cases import CLAMP, RUBBER, SHEET

import lumped
from sheetbench.scenes import Hinged, Scene
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


def test_the_rolled_state_is_an_arc_of_two_radians(tmp_path):
    """Of the sheet's length at mid-surface, its layers along the radius."""
    free = Scene(name="free", sheet=SHEET, material=RUBBER, support=(Hinged(edge="x0"),))
    found = lumped.describe(free, spring_set(free, 5))
    rolled = next(state for state in found.states if state.name == "rolled")
    places = found.positions + rolled.displacement
    order = np.lexsort(found.positions.T)
    at, there = (values[order].reshape(2, -1, 5, 3) for values in (found.positions, places))
    along = there.mean(axis=0)
    radius, turn = SHEET.length_x / 2.0, np.diff(at[0, :, :, 0], axis=1) * 2.0 / SHEET.length_x
    np.testing.assert_allclose(
        np.linalg.norm(np.diff(along, axis=1), axis=2), 2.0 * radius * np.sin(turn / 2.0), rtol=1e-9
    )
    through = there[1, :, -1] - there[0, :, -1]
    expected = np.array([-np.sin(2.0), 0.0, np.cos(2.0)])
    np.testing.assert_allclose(
        through / np.linalg.norm(through, axis=1)[:, None], np.tile(expected, (len(through), 1)), atol=1e-9
    )
