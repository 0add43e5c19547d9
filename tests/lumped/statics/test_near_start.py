"""Statics from an equilibrium close by: the same answer in fewer factorisations, else the whole way."""

import numpy as np
import pytest

import lumped
import sheetbench as sb
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.parameters import put


def moved(solution):
    return solution.mesh.point_data["displacement"]


@pytest.fixture(scope="module")
def case():
    """A scene, its springs, its answer from flat, and that of a scene with another rod."""
    scene = sb.load("curved-edge")
    springs = sb.calibrate(scene, grid=5)
    other = lumped.solve(put(scene, "curvature_x0", 3.7), springs)
    return scene, springs, lumped.solve(scene, springs), moved(other)


def test_the_answer_is_that_from_flat_in_fewer_factorisations(case):
    scene, springs, flat, near = case
    found = lumped.solve(scene, springs, near=near)
    assert found.status == flat.status == "converged"
    # both are corrected to rounding: residuals of 1e-11 of the forces
    np.testing.assert_allclose(moved(found), moved(flat), rtol=0, atol=1e-10 * np.abs(moved(flat)).max())
    assert found.iterations < flat.iterations


def test_a_start_that_leads_nowhere_is_left(case):
    scene, springs, flat, _ = case
    lost = 0.3 * np.random.default_rng(1).standard_normal(moved(flat).shape)
    found = lumped.solve(scene, springs, near=lost)
    assert found.status == "converged"
    np.testing.assert_allclose(moved(found), moved(flat), rtol=0, atol=1e-10 * np.abs(moved(flat)).max())


def test_a_start_of_another_grid_is_refused(case):
    scene, springs, _, near = case
    with pytest.raises(BadInput, match="near"):
        lumped.solve(scene, springs, near=near[1:])
