"""Many designs at once against one after the other."""

import numpy as np
import pytest

import lumped
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeLoad, load


@pytest.mark.parametrize("workers", [1, 3])
def test_designs_of_moduli_and_forces_are_those_solved_alone(workers):
    scene, rng = load("two-edges-clamped"), np.random.default_rng(0)
    alone = lumped.Differentiable(scene)
    young, forces = alone.base["cells.young"], alone.base["forces"]
    designs = {
        "cells.young": young * np.exp(0.2 * rng.standard_normal((7, *young.shape))),
        "forces": 1e-3 * rng.standard_normal((7, *forces.shape)),
    }
    found = lumped.solve_many(scene, designs, workers=workers)
    assert found.status == 7 * [Status.CONVERGED]
    for n, u in enumerate(found.displacement):
        expected = alone.solve({name: values[n] for name, values in designs.items()})
        assert np.abs(u - expected).max() < 1e-8 * np.abs(expected).max()


def test_other_values_go_along_the_load_path_and_what_ends_otherwise_says_how():
    scene, alone = load("one-edge-clamped"), lumped.Differentiable("one-edge-clamped")
    curvature = 3.0 * np.random.default_rng(1).standard_normal((2, 8, 8, 3))
    designs = {"cells.curvature": curvature, "density": np.array([1000.0, 2000.0])}
    found = lumped.solve_many(scene, designs)
    for n, u in enumerate(found.displacement):
        expected = alone.solve({name: values[n] for name, values in designs.items()})
        assert np.abs(u - expected).max() < 1e-8 * np.abs(expected).max()
    pushed = scene.replace(gravity=None, loads=(EdgeLoad(edge="x1", force_per_length=(-5.0, 0.0, 0.0)),))
    young = np.array([1.0, 0.1])[:, None, None] * alone.base["cells.young"]
    found = lumped.solve_many(pushed, {"cells.young": young})
    assert found.status == [Status.CONVERGED, Status.UNSTABLE]  # which buckles
    assert np.isfinite(found.displacement[0]).all() and np.isnan(found.displacement[1]).all()
    with pytest.raises(BadInput, match="equal numbers of values"):
        lumped.solve_many(scene, {"density": np.ones(2), "young": np.ones(3)})


@pytest.mark.parametrize("solve", [lumped.Differentiable("one-edge-clamped").solve, None])
@pytest.mark.parametrize(
    "name, shape, said",
    [
        ("cells.young", (7, 8), r"cells\.young: shape \(7, 8\); \(8, 8\) is needed"),
        ("forces", (3,), r"forces: shape \(3,\); \(162, 3\) is needed"),
        ("cells.stiffness", (8, 8), r"cells\.stiffness: choose from cells\.young"),
        ("young", (2,), r"young: shape \(2,\); \(\) is needed"),
    ],
)
def test_values_of_another_name_or_shape_are_refused(solve, name, shape, said):
    values = np.ones((1, *shape))
    with pytest.raises(BadInput, match=said):
        solve({name: values[0]}) if solve else lumped.solve_many("one-edge-clamped", {name: values})
