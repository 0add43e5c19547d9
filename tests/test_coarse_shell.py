"""A fine shell that begins at a coarse one's equilibrium: the same answer, or the whole path after all."""

from __future__ import annotations

import numpy as np
import pytest

import fem_reference
from fem_reference.shell import coarse_start
from fem_reference.solving.kept import kept
from sheetbench import scenes
from sheetbench.scenes import Status


def moved(scene, solution):
    return solution.displacement(scene.probe_points())


@pytest.mark.parametrize("name", ["one-edge-clamped", "curved-edge"])
def test_the_answer_is_that_from_flat_in_fewer_factorisations(name, monkeypatch):
    scene = scenes.load(name)
    flat = fem_reference.solve(scene, elements=8)
    coarse = fem_reference.solve(scene, elements=2)
    monkeypatch.setattr(coarse_start, "FINE", 8)
    found = fem_reference.solve(scene, elements=8)
    assert found.status is Status.CONVERGED and found.unknowns == flat.unknowns
    np.testing.assert_allclose(moved(scene, found), moved(scene, flat), atol=1e-10 * scene.sheet.length_x)
    assert found.iterations - coarse.iterations < flat.iterations
    assert len(found.history) > len(coarse.history)


def test_where_the_coarse_one_does_not_go_straight_the_path_begins_at_rest(monkeypatch):
    scene = scenes.load("two-edges-clamped")
    flat = fem_reference.solve(scene, elements=8)
    assert flat.iterations == 5  # the last correction's factors tell the stability
    monkeypatch.setattr(coarse_start, "FINE", 8)
    monkeypatch.setattr(coarse_start, "plain", lambda path: False)
    found = fem_reference.solve(scene, elements=8)
    assert found.iterations > flat.iterations
    assert np.array_equal(moved(scene, found), moved(scene, flat))


def test_rods_and_few_elements_have_no_coarse_start():
    assert coarse_start.coarse((16, 33), scenes.load("two-edges-clamped")) == (4, 8)
    assert coarse_start.coarse((15, 33), scenes.load("two-edges-clamped")) is None
    assert coarse_start.coarse((16, 16), scenes.load("actuated-edge")) is None


def test_what_is_kept_is_given_again_for_equal_arrays_only():
    calls = []

    @kept(last=2, most=64)
    def total(values: np.ndarray, weight: float = 1.0) -> float:
        calls.append(len(values))
        return weight * float(values.sum())

    few, many = np.arange(4.0), np.arange(9.0)
    assert total(few) == total(few.copy()) == 6.0 and calls == [4]
    assert total(few, weight=2.0) == 12.0 and total(few[::-1].copy()) == 6.0 and calls == [4, 4, 4]
    assert total(few) == 6.0 and len(calls) == 4  # the oldest had been dropped
    assert total(many) == total(many) == 36.0 and calls[4:] == [9, 9]
