"""A fine shell that begins at a coarse one's equilibrium: the same answer, or the whole path after all."""

import numpy as np
import pytest

import fem_reference
from fem_reference.shell import coarse_start, statics
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits


def moved(scene, solution):
    return solution.displacement(scene.probe_points())


def from_flat(scene, monkeypatch):
    with monkeypatch.context() as patch:
        patch.setattr(coarse_start, "FINE", 9)
        return fem_reference.solve(scene, elements=8)


@pytest.mark.parametrize("name", ["two-edges-clamped", "one-edge-clamped", "curved-edge"])
def test_the_answer_is_that_from_flat_in_fewer_factorisations(name, monkeypatch):
    scene = scenes.load(name)
    flat, coarse = from_flat(scene, monkeypatch), fem_reference.solve(scene, elements=2)
    found = fem_reference.solve(scene, elements=8)
    assert found.status is Status.CONVERGED and found.unknowns == flat.unknowns
    np.testing.assert_allclose(moved(scene, found), moved(scene, flat), atol=1e-9 * scene.sheet.length_x)
    assert found.iterations - coarse.iterations < flat.iterations
    assert len(found.history) > len(coarse.history)


def test_three_factorisations_lead_from_the_coarse_equilibrium_with_its_membrane_stresses(monkeypatch):
    scene = scenes.load("two-edges-clamped")
    coarse = fem_reference.solve(scene, elements=2)
    assert from_flat(scene, monkeypatch).iterations == 5  # the last correction's factors tell the stability
    assert fem_reference.solve(scene, elements=8).iterations == coarse.iterations + 3
    monkeypatch.setattr(coarse_start, "sampled", lambda nodes, strain: np.zeros((len(nodes), 21)))
    assert fem_reference.solve(scene, elements=8).iterations == coarse.iterations + 4


def test_a_sheet_with_a_hole_begins_at_a_coarse_mesh_without_rows_along_the_rim():
    hole = {"shape": {"circle": {"centre": (0.11, 0.1), "radius": 0.03}}}
    scene = scenes.load("two-edges-clamped").replace(cutouts=[hole])
    coarse = fem_reference.solve(scene, elements=2, graded=False)
    assert fem_reference.solve(scene, elements=8).iterations == coarse.iterations + 3


@pytest.mark.parametrize(
    "where, name, value",
    [
        (coarse_start, "plain", lambda path: False),  # it does not go straight
        (coarse_start, "LIMITS", Limits(factorisations=2)),  # it takes long
        (statics, "LIMITS", Limits(same_branch=1e-3)),  # the fine one's equilibrium is far away
    ],
)
def test_where_the_coarse_one_is_no_good_the_path_begins_at_rest(where, name, value, monkeypatch):
    scene = scenes.load("two-edges-clamped")
    flat = from_flat(scene, monkeypatch)
    monkeypatch.setattr(where, name, value)
    found = fem_reference.solve(scene, elements=8)
    assert found.iterations > flat.iterations
    assert np.array_equal(moved(scene, found), moved(scene, flat))


def test_rods_and_few_elements_have_no_coarse_start():
    assert coarse_start.coarse((8, 33), scenes.load("two-edges-clamped")) == (2, 8)
    assert coarse_start.coarse((7, 33), scenes.load("two-edges-clamped")) is None
    assert coarse_start.coarse((16, 16), scenes.load("actuated-edge")) is None
