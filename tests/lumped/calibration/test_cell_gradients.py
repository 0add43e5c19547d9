"""Strains that vary across a cell: what they cost, and what coarse grids owe to it."""

import numpy as np
import pytest
from scipy.optimize import minimize

from lumped import moduli
from lumped.assembly import Assembly
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.closed_form import springs_of_cells
from lumped.calibration.report import report
from sheetbench.scenes import Material, Sheet

YOUNG, THICKNESS = 1e6, 1e-3


def one_cell(gradients, poisson, sides):
    """A cell of these sides, the sheet's moduli and its springs."""
    sheet = Sheet(length_x=sides[0], length_y=sides[1], thickness=THICKNESS)
    material = Material(young=YOUNG, poisson=poisson, density=1.0)
    each = each_cell(sheet, material, (2, 2, 2))
    springs = springs_of_cells(each, gradients=gradients)
    calibration = report("test", each, springs)
    section = moduli.Moduli(*(part[0] for part in vars(each.target).values()))
    return Assembly(sheet, calibration), section, springs


def cost_of_bending_in_plane(gradients, poisson, axis, sides):
    """Energy of one cell under ε = χ (place across) along an axis, over a beam's, E h χ² b³ l/24."""
    bend = 1e-4
    assembly = one_cell(gradients, poisson, sides)[0]
    x, y = (assembly.lattice.positions[:, :2] - np.array(sides) / 2.0).T
    u = np.zeros_like(assembly.lattice.positions)
    u[:, axis] = bend * x * y
    length, depth = sides[axis], sides[1 - axis]
    energy: float = assembly.force(u)[0] / (YOUNG * THICKNESS * bend**2 * depth**3 * length / 24.0)
    return energy


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("poisson", [-0.1, 0.0, 0.3, 0.48])
def test_a_cell_bends_in_its_plane_as_a_beam_does(poisson, axis):
    """But for the thickness, which masses shared by cells cannot change with the strain (up to a percent)."""
    square = (0.1, 0.1)
    assert cost_of_bending_in_plane(True, poisson, axis, square) == pytest.approx(1.0, abs=0.015)
    assert cost_of_bending_in_plane(False, poisson, axis, square) > 1.7


@pytest.mark.parametrize("poisson", [0.0, 0.48])
@pytest.mark.parametrize("sides", [(0.1, 0.15), (0.3, 0.1)])
def test_an_oblong_cell_costs_no_more_in_either_direction(sides, poisson):
    """One layer distance for both: the sides of one direction carry a third, of the other less."""
    costs = [cost_of_bending_in_plane(True, poisson, axis, sides) for axis in (0, 1)]
    assert max(costs) == pytest.approx(1.0, abs=0.015) and min(costs) > 0.4


@pytest.mark.parametrize("gradients", [False, True])
@pytest.mark.parametrize("poisson", [0.0, 0.48])
def test_a_cell_bent_to_an_arc_is_too_soft_by_what_is_derived(gradients, poisson):
    """In θ², chord and columns free to change: by chord, diagonals and columns, of a cell 20 h long."""
    side = 20.0 * THICKNESS
    assembly, section, springs = one_cell(gradients, poisson, (side, side))
    at, turn, distance = assembly.lattice.positions, 0.2, springs.layer_distance

    def energy(free):
        chord, column = side * (1.0 + 1e-4 * free[0]), distance * (1.0 + 1e-2 * free[1])
        ahead, above = np.sign(at[:, 0] - side / 2.0), np.sign(at[:, 2] - at[:, 2].mean())
        tilt = ahead * turn / 2.0
        x = ahead * chord / 2.0 + above * column / 2.0 * np.sin(tilt)
        moved = np.column_stack(
            [side / 2.0 + x, at[:, 1], at[:, 2].mean() + above * column / 2 * np.cos(tilt)]
        )
        return float(assembly.force(moved - at)[0] / (0.5 * section.bending[0, 0] * turn**2))

    least = minimize(energy, np.zeros(2), tol=1e-12).fun
    w = section.shear[0] * distance**2 / (8.0 * section.bending[0, 0])
    k = springs["vertical"].item() * distance**2 / section.bending[0, 0]
    softer = 1.0 / 12.0 - w / 8.0 + (1.0 - w) ** 2 / (k + 40.0 * w / 3.0)
    assert (1.0 - least) / turn**2 == pytest.approx(softer, abs=0.003)
