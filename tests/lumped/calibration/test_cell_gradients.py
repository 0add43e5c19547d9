"""Strains that vary across a cell: what they cost, and what coarse grids owe to it."""

import numpy as np
import pytest
from cases import relative

import fem_reference
import lumped
from lumped import moduli
from lumped.assembly import Assembly
from lumped.calibration.closed_form import closed_form
from lumped.calibration.report import report
from sheetbench.scenes import Material, Sheet
from studies.transfer.scenes import transfer_scenes


def cost_of_bending_in_plane(gradients: bool, poisson: float, axis: int, sides: tuple[float, float]) -> float:
    """Energy of one cell under ε = χ (place across) along an axis, over a beam's, E h χ² b³ l/24."""
    young, thickness, bend = 1e6, 1e-3, 1e-4
    sheet = Sheet(length_x=sides[0], length_y=sides[1], thickness=thickness)
    material = Material(young=young, poisson=poisson, density=1.0)
    springs = closed_form(moduli.of_sheet(sheet, material, sides), sides, 2, gradients=gradients)
    assert springs is not None
    assembly = Assembly(sheet, report("test", sheet, material, (2, 2, 2), springs))
    x, y = (assembly.lattice.positions[:, :2] - np.array(sides) / 2.0).T
    u = np.zeros_like(assembly.lattice.positions)
    u[:, axis] = bend * x * y
    length, depth = sides[axis], sides[1 - axis]
    energy: float = assembly.force(u)[0] / (young * thickness * bend**2 * depth**3 * length / 24.0)
    return energy


@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("poisson", [-0.1, 0.0, 0.3, 0.48])
def test_a_cell_bends_in_its_plane_as_a_beam_does(poisson: float, axis: int) -> None:
    """But for the thickness, which masses shared by cells cannot change with the strain (up to a percent)."""
    square = (0.1, 0.1)
    assert cost_of_bending_in_plane(True, poisson, axis, square) == pytest.approx(1.0, abs=0.015)
    assert cost_of_bending_in_plane(False, poisson, axis, square) > 1.7


@pytest.mark.parametrize("poisson", [0.0, 0.48])
@pytest.mark.parametrize("sides", [(0.1, 0.15), (0.3, 0.1)])
def test_an_oblong_cell_costs_no_more_in_either_direction(sides: tuple[float, float], poisson: float) -> None:
    """One layer distance for both: the sides of one direction carry a third, of the other less."""
    costs = [cost_of_bending_in_plane(True, poisson, axis, sides) for axis in (0, 1)]
    assert max(costs) == pytest.approx(1.0, abs=0.015) and min(costs) > 0.4


@pytest.mark.parametrize("poisson", [0.0, 0.24, 0.48])
def test_bending_is_as_it_was(poisson: float) -> None:
    """The linear answer of a sheet that bends is that of `consistent`, whatever ν."""
    scene = transfer_scenes()["two-edges-linear"]
    sheet, material = scene.sheet, scene.material.model_copy(update={"poisson": poisson})
    scene = scene.model_copy(update={"material": material})
    answers = []
    for method in ("consistent", "consistent-membrane"):
        springs = lumped.calibrate(sheet, material, 5, method)
        answers.append(lumped.solve(scene, springs, linear=True).displacement(scene.probe_points())[:, 2])
        assert all(row["miss"] == pytest.approx(0.0, abs=1e-9) for row in springs.moduli)
    assert answers[1] == pytest.approx(answers[0], rel=1e-9)


@pytest.mark.parametrize(
    "name, before, held", [("curved-edge", 0.033, 0.007), ("tenth-of-young", 0.034, 0.007)]
)
def test_coarse_grids_follow_layers_at_the_edges(name: str, before: float, held: float) -> None:
    """9 × 9 masses against the shell, of the largest displacement: `before` with all that links can take."""
    scene = transfer_scenes()[name]
    side = np.linspace(0.0, scene.sheet.length_x, 5)
    points = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    reference = fem_reference.solve(scene, model="shell", elements=12).displacement(points)
    found = {}
    for method in ("consistent", "consistent-membrane"):
        springs = lumped.calibrate(scene.sheet, scene.material, 9, method)
        found[method] = relative(lumped.solve(scene, springs).displacement(points), reference)
    assert found["consistent"] > 0.9 * before and found["consistent-membrane"] < held
