"""References solve, and springs are fitted, on one BLAS thread whatever is set, which stays as it was."""

import pytest
from threadpoolctl import threadpool_info, threadpool_limits

import fem_reference
import lumped
from lumped.fitting import methods
from sheetbench import scenes
from sheetbench.numerics import direct as linear

SCENE = scenes.load("one-edge-clamped")


def blas_threads():
    return [library["num_threads"] for library in threadpool_info() if library["user_api"] == "blas"]


@pytest.mark.parametrize("model", ["plate", "shell", "solid", "modes"])
def test_a_reference_is_solved_on_one_thread(model, monkeypatch):
    seen: list[int] = []
    factor = linear.DirectSolver.factor

    def watched(self, *matrix):
        seen.extend(blas_threads())
        return factor(self, *matrix)

    def answer():
        if model == "modes":
            return fem_reference.modes(SCENE, elements=2, count=2).frequencies
        return fem_reference.solve(SCENE, model=model, elements=2).displacement(SCENE.probe_points())

    alone = answer()
    monkeypatch.setattr(linear.DirectSolver, "factor", watched)
    with threadpool_limits(2, user_api="blas"):
        assert 2 in blas_threads()
        found = answer()
        assert 2 in blas_threads()
    assert seen and set(seen) == {1}
    assert found == pytest.approx(alone, rel=1e-9, abs=1e-12)


def test_springs_are_found_on_one_thread(monkeypatch):
    seen: list[int] = []
    moduli = methods.MAKERS["moduli"]

    def watched(*sheet, **options):
        seen.extend(blas_threads())
        return moduli(*sheet, **options)

    monkeypatch.setitem(methods.MAKERS, "moduli", watched)
    with threadpool_limits(2, user_api="blas"):
        lumped.calibrate(SCENE.sheet, SCENE.material, grid=3, method="moduli")
        assert 2 in blas_threads()
    assert seen and set(seen) == {1}
