"""Sheets whose cells differ, by a table set from Python."""

import numpy as np
import pytest

import lumped
from sheetbench.errors import BadInput
from sheetbench.scenes import Cells, Material, Scene, Sheet, load

LENGTH, WIDTH, THICK, THIN, YOUNG, DENSITY = 0.2, 0.02, 3e-3, 1e-3, 5e6, 1000.0
SHEET, MATERIAL = Sheet(LENGTH, WIDTH, THICK), Material(YOUNG, 0.0, DENSITY)


def cantilever(**others):
    clamped = [{"edge": "x0", "kind": "clamped"}]
    return Scene(name="taper", sheet=SHEET, material=MATERIAL, supports=clamped, **others)


def tapered(grid):
    """A strip from 3 to 1 mm: of every cell the thickness in its middle."""
    middles = (np.arange(grid[0] - 1) + 0.5) / (grid[0] - 1)
    thickness = np.tile(THICK + (THIN - THICK) * middles, (grid[1] - 1, 1))
    return Cells.of(SHEET, MATERIAL).replace(thickness=thickness)


def test_masses_and_weight_are_the_cells():
    grid = (9, 3)
    springs = lumped.calibrate(SHEET, MATERIAL, grid=grid, cells=tapered(grid))
    scene = cantilever(gravity={"acceleration": [0.0, 0.0, -9.81]})
    problem = lumped.build_problem(scene, springs)
    weight = -problem.loads.dead[:, 2]
    whole = DENSITY * WIDTH * LENGTH * (THICK + THIN) / 2.0
    assert weight.sum() == pytest.approx(9.81 * whole, rel=1e-12)
    centre = weight @ problem.assembly.lattice.positions[:, 0] / weight.sum()
    # of cells with the thickness of their middle: (t₁ + 2 t₂)/3(t₁ + t₂) L less a rest of second order
    assert centre == pytest.approx(LENGTH * (THICK + 2.0 * THIN) / (3.0 * (THICK + THIN)), rel=5e-3)
    assert lumped.System(scene, problem).lattice_mass.sum() == pytest.approx(whole, rel=1e-12)
    assert lumped.modes(scene, springs, 2).frequencies[0] > 0.0


@pytest.mark.parametrize("method", ["consistent", "consistent-membrane", "consistent-oblique"])
def test_cells_that_are_all_the_same_are_the_sheet(method):
    scene = load("two-edges-clamped")
    cells = Cells.of(scene.sheet, scene.material)
    table = cells.replace(thickness=np.full((4, 4), cells.thickness), young=np.full((4, 4), cells.young))
    plain, listed = (
        lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, 5, method, cells=each))
        for each in (None, table)
    )
    moved = [each.mesh.point_data["displacement"] for each in (plain, listed)]
    assert np.allclose(*moved, rtol=0.0, atol=1e-9 * np.abs(moved[0]).max())


def test_tables_of_other_grids_and_methods_without_cells_are_refused():
    with pytest.raises(BadInput, match=r"cells\.thickness: 2 × 8 values; 5x3 masses have 2 rows of 4 cells"):
        lumped.calibrate(SHEET, MATERIAL, grid=(5, 3), cells=tapered((9, 3)))
    with pytest.raises(BadInput, match="calibration 'uniform' takes no cells; cells goes with 'consistent'"):
        lumped.calibrate(SHEET, MATERIAL, grid=(9, 3), method="uniform", cells=tapered((9, 3)))
