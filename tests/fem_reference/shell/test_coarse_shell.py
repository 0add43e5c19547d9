"""A fine shell that begins at a coarse one's equilibrium: the same answer, or the whole path after all."""

import numpy as np
import pytest

import fem_reference
from fem_reference.shell import coarse_start, statics
from fem_reference.shell.coarse_start import at_nodes, sampled
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.element import MEMBRANE
from fem_reference.surface.mesh import mesh_of
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.numerics.kept import kept


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


def test_a_membrane_strain_is_the_same_on_another_mesh():
    scene = scenes.load("two-edges-clamped")
    sheared = np.array([[0.02, 0.01], [-0.03, 0.04]])

    def shell(elements):
        sheet = DiscreteShell(mesh_of(scene, elements, True), scene)
        q = np.zeros(sheet.size)
        sheet.displacement(q)[:, :2] = sheet.plan.nodes @ sheared
        strain = sheet.element.strain(sheet.gather(q))[:, MEMBRANE]
        return sheet.element.reference[:, :9, :2], sheet.plan.elements, strain

    (at, on, coarse), (finer_at, finer_on, fine) = shell((2, 3)), shell((5, 4))
    green = 0.5 * (sheared + sheared.T + sheared @ sheared.T)
    nodal = at_nodes(at, on, coarse)
    np.testing.assert_allclose(nodal, np.broadcast_to(green, nodal.shape), rtol=1e-11)
    of_finer = np.broadcast_to(green, (finer_on.max() + 1, 2, 2))
    np.testing.assert_allclose(sampled(finer_at, of_finer[finer_on]), fine, rtol=1e-11)


def test_what_is_kept_is_given_again_for_equal_arrays_only():
    calls = []

    @kept(last=2, most=64)
    def total(values, weight=1.0):
        calls.append(len(values))
        return weight * float(values.sum())

    few, many = np.arange(4.0), np.arange(9.0)
    assert total(few) == total(few.copy()) == 6.0 and calls == [4]
    assert total(few, weight=2.0) == 12.0 and total(few[::-1].copy()) == 6.0 and calls == [4, 4, 4]
    assert total(few) == 6.0 and len(calls) == 4  # the oldest had been dropped
    assert total(many) == total(many) == 36.0 and calls[4:] == [9, 9]
