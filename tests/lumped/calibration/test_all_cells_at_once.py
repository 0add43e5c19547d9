"""The springs of unequal cells: all at once as each alone, and as before they were found all at once."""

from dataclasses import replace

import numpy as np
import pytest
from cases import calibrated, sheet

import lumped
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.closed_form import springs_of_cells
from lumped.spring_constants import Springs, require_cells
from sheetbench.scenes import (
    BadInput,
    Cells,
    Clamped,
    Hinged,
    Material,
    PointLoad,
    Scene,
    Sheet,
    SpringSet,
)
from sheetbench.scenes.objects.grading import Grading

SIZES = {"length_x": 0.1, "length_y": 0.08, "thickness": 0.003}
PLAIN = {"name": "pinned", "sheet": SIZES, "material": {"young": 5e6, "poisson": 0.35, "density": 1e3}}
MODULI = {"young_1": 20e6, "young_2": 2e6, "poisson_12": 0.3, "shear_12": 1.2e6}
FIBRES = {**PLAIN, "material": {"kind": "orthotropic", **MODULI, "density": 1e3, "angle": 0.5}}
HOLE = {"cutouts": [{"shape": {"circle": {"centre": [0.05, 0.045], "radius": 0.014}}}]}
PATCH = {"patches": [{"shape": {"rectangle": {"x": [0.02, 0.05], "y": [0.01, 0.04]}}, "thickness": 0.004}]}
PLIES = {"layers": [{"thickness": 0.75e-3, "angle": angle} for angle in (0.2, 1.0, 1.0, 0.2)]}
SHEETS = {
    "graded": (PLAIN, (6, 5, 2), 0.5, "consistent"),
    "fibres towards an edge": (FIBRES, (5, 6, 2), Grading(0.4, ("x0",)), "consistent"),
    "laminate with a hole": ({**FIBRES, **PLIES, **HOLE}, (9, 8, 2), 0.0, "consistent"),
    "patch and hole": ({**PLAIN, **PATCH, **HOLE}, (9, 8, 2), 0.3, "consistent-membrane"),
    "rubber": ({**PLAIN, **HOLE}, (8, 8, 3), 0.2, "hyperelastic"),
}


@pytest.mark.parametrize("gradients", [False, True])
def test_a_cells_springs_are_those_of_a_sheet_of_such_cells(gradients):
    """Whatever cells are beside it: no cell's fixed point, fibres or bounds reach another's."""
    scene = Scene.model_validate({**FIBRES, **PATCH})
    grid = (7, 6, 2)
    each = each_cell(scene.sheet, scene.material, grid, 0.7, lumped.sections_of(scene, grid, 0.7))
    springs = springs_of_cells(each, gradients=gradients)
    for row, column in ((0, 0), (1, 2), (2, 1), (4, 5)):
        at = slice(row, row + 1), slice(column, column + 1)
        section = each.section.map(lambda part, at=at: part[at])
        one = replace(each, sides=each.sides[at], section=section, covered=each.covered[at])
        alone = springs_of_cells(one, springs.layer_distance, gradients=gradients)
        for name, values in springs.of.items():
            for axis in (0, 1):
                mine, own = springs.along(name, axis)[row, column], alone.along(name, axis)[0, 0]
                assert mine == pytest.approx(own, rel=1e-12, abs=1e-12 * np.abs(values).max()), name


@pytest.mark.parametrize("name", SHEETS)
def test_a_table_is_read_as_it_was_written(name):
    document, *grids, method = SHEETS[name]
    found = calibrated(Scene.model_validate(document), *grids, method=method)
    table = SpringSet.model_validate(found.springs.model_dump())
    assert table == found.springs == Springs.read(table).table()
    require_cells(table, found.grid, "")
    with pytest.raises(BadInput, match="cells are needed on"):
        require_cells(table, (found.grid[0] + 1, *found.grid[1:]), "")


def test_an_even_sheet_is_calibrated_once():
    plan, material = Sheet(0.1, 0.1, 0.002), Material(1e6, 0.3, 1e3)
    first = lumped.calibrate(plan, material, 5)
    assert lumped.calibrate(plan, material, 5) is first
    assert lumped.calibrate(plan.replace(thickness=0.003), material, 5).springs != first.springs


def test_constructions_of_the_literature_say_what_they_miss_of_fibres_at_an_angle():
    """It ended in a KeyError: their lattices have no D16 to compare."""
    scene = Scene.model_validate(FIBRES)
    found = lumped.calibrate(scene.sheet, scene.material, (6, 6), "lloyd")
    assert {"D16", "A26"} <= {row["name"] for row in found.moduli} and "D16 by" in found.remarks[0]


LENGTH, WIDTH, THICK, THIN, YOUNG, DENSITY = 0.2, 0.02, 3e-3, 1e-3, 5e6, 1000.0
SHEET, MATERIAL = Sheet(LENGTH, WIDTH, THICK), Material(YOUNG, 0.0, DENSITY)


def tapered(grid):
    """A strip from 3 to 1 mm: of every cell the thickness in its middle."""
    middles = (np.arange(grid[0] - 1) + 0.5) / (grid[0] - 1)
    thickness = np.tile(THICK + (THIN - THICK) * middles, (grid[1] - 1, 1))
    return Cells.of(SHEET, MATERIAL).replace(thickness=thickness)


def test_masses_and_weight_are_the_cells():
    grid = (9, 3)
    springs = lumped.calibrate(SHEET, MATERIAL, grid=grid, cells=tapered(grid))
    scene = sheet(LENGTH, WIDTH, THICK, material=MATERIAL, weight=9.81)
    problem = lumped.build_problem(scene, springs)
    weight = -problem.loads.dead[:, 2]
    whole = DENSITY * WIDTH * LENGTH * (THICK + THIN) / 2.0
    assert weight.sum() == pytest.approx(9.81 * whole, rel=1e-12)
    centre = weight @ problem.assembly.lattice.positions[:, 0] / weight.sum()
    # of cells with the thickness of their middle: (t₁ + 2 t₂)/3(t₁ + t₂) L less a rest of second order
    assert centre == pytest.approx(LENGTH * (THICK + 2.0 * THIN) / (3.0 * (THICK + THIN)), rel=5e-3)
    assert lumped.System(scene, problem).lattice_mass.sum() == pytest.approx(whole, rel=1e-12)
    assert lumped.modes(scene, springs, 2).frequencies[0] > 0.0


SQUARE, FLAT = Sheet(0.188, 0.188, 3e-3), Sheet(0.1455, 0.0571, 1.06e-3)


@pytest.mark.parametrize(
    ("method", "sheet", "grading"),
    [
        ("consistent", SQUARE, 0.0),
        ("consistent-membrane", SQUARE, 0.0),
        ("consistent-oblique", SQUARE, 0.0),
        ("consistent", SQUARE, 0.5),  # the edges' strips were of cells like their first
        ("consistent", SQUARE, Grading(0.6, ("x0",))),
        # where no factor is enough it was the most, or one
        ("consistent", FLAT, 0.0),
    ],
)
def test_cells_that_are_all_the_same_are_the_sheet(method, sheet, grading):
    cells = Cells.of(sheet, MATERIAL)
    table = cells.replace(thickness=np.full((4, 4), cells.thickness), young=np.full((4, 4), cells.young))
    pull = PointLoad(at=sheet.lengths, force=(0.0, 0.0, 1e-5))
    scene = Scene("twisted", sheet, MATERIAL, supports=[Clamped("x0")], loads=[pull])
    one, each = (
        lumped.calibrate(sheet, MATERIAL, (5, 5), method, grading=grading, cells=of) for of in (None, table)
    )
    moved = [lumped.solve(scene, springs).mesh.point_data["displacement"] for springs in (one, each)]
    assert np.allclose(*moved, rtol=0.0, atol=1e-9 * np.abs(moved[0]).max())


def test_a_twisted_plate_of_long_cells_is_not_far_too_soft():
    """Two edges hinged, a force at the free corner: w = F a b/2D(1 − ν) of a thin plate. Where no factor
    makes free edges right they have the most that there is: 4 % off, and 28 % with none."""
    at, force, bending = (FLAT.length_x, FLAT.length_y), 1e-5, 5e6 * FLAT.thickness**3 / 12.0
    scene = Scene("twisted", FLAT, Material(5e6, 0.0, 1e3), supports=[Hinged("x0"), Hinged("y0")])
    scene = scene.replace(loads=[PointLoad(at=at, force=(0.0, 0.0, force))])
    found = lumped.solve(scene, lumped.calibrate(FLAT, scene.material, (5, 5))).displacement([at])
    assert found[0, 2] == pytest.approx(force * at[0] * at[1] / (2.0 * bending), rel=0.05)


def test_tables_of_other_grids_and_methods_without_cells_are_refused():
    with pytest.raises(BadInput, match=r"cells\.thickness: 2 × 8 values; 5x3 masses have 2 rows of 4 cells"):
        lumped.calibrate(SHEET, MATERIAL, grid=(5, 3), cells=tapered((9, 3)))
    with pytest.raises(BadInput, match="calibration 'uniform' takes no cells; cells goes with 'consistent'"):
        lumped.calibrate(SHEET, MATERIAL, grid=(9, 3), method="uniform", cells=tapered((9, 3)))
