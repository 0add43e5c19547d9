"""Many solves at once against single ones."""

import numpy as np
import pytest

import lumped
from sheetbench.errors import BadInput
from sheetbench.scenes import SceneError, Status, load

SCENE = load("two-edges-clamped")
SPRINGS = lumped.calibrate(SCENE.sheet, SCENE.material, grid=(5, 5))


def stiffer(share):
    values = SCENE.material.model_dump() | {"young": share * SCENE.material.young}
    return SCENE.model_copy(update={"material": type(SCENE.material)(**values)})


def same(many, single):
    assert (many.status, many.iterations, many.remarks) == (single.status, single.iterations, single.remarks)
    points = np.array(list(SCENE.probes.values()))
    assert np.array_equal(many.displacement(points), single.displacement(points))
    assert many.energies == single.energies
    assert many.balance is not None and many.balance.holds == single.balance.holds
    assert np.array_equal(many.mesh.point_data["reaction"], single.mesh.point_data["reaction"])


def test_one_scene_with_many_springs():
    several = [SPRINGS.with_constant("diagonal", k) for k in np.linspace(2000.0, 9000.0, 12)]
    answers = lumped.solve_many(SCENE, several, workers=3)
    for answer, springs in zip(answers, several, strict=True):
        same(answer, lumped.solve(SCENE, springs))


def test_scenes_of_every_kind_side_by_side():
    """Grids, supports at rest and moving, full weights."""
    names = ["two-edges-clamped", "curved-edge", "curved-edge", "one-edge-clamped", "two-edges-clamped"]
    scenes = [load(name) for name in names]
    scenes.append(replace_gravity(load("curved-edge"), 20.0))  # moving supports in more than one load step
    grids = [(3, 3), (5, 5), (5, 5), (4, 3), (3, 3), (3, 3)]
    springs = [lumped.calibrate(s.sheet, s.material, grid=g) for s, g in zip(scenes, grids, strict=True)]
    answers = lumped.solve_many(scenes, springs, weights="full", workers=1)
    for answer, scene, own in zip(answers, scenes, springs, strict=True):
        same(answer, lumped.solve(scene, own, weights="full"))
        assert answer.settings["weights"] == "full"


def test_many_scenes_with_springs_of_their_own_or_one_for_all():
    scenes = [stiffer(share) for share in (0.5, 1.0, 2.0)]
    springs = [lumped.calibrate(s.sheet, s.material, grid=(5, 4)) for s in scenes]
    for answer, scene, own in zip(lumped.solve_many(scenes, springs), scenes, springs, strict=True):
        same(answer, lumped.solve(scene, own))
    for answer, scene in zip(lumped.solve_many(scenes), scenes, strict=True):
        same(answer, lumped.solve(scene))
    linear = lumped.solve_many(scenes, SPRINGS, linear=True)
    for answer, scene in zip(linear, scenes, strict=True):
        same(answer, lumped.solve(scene, SPRINGS, linear=True))


def test_a_case_that_fails_costs_no_other():
    """Weight enough to tear any sheet apart, between two that stand."""
    gravity = replace_gravity(SCENE, 1e9)
    answers = lumped.solve_many([SCENE, gravity, SCENE], SPRINGS, workers=1)
    statuses = [answer.status for answer in answers]
    assert statuses[0] == statuses[2] == Status.CONVERGED and statuses[1] != Status.CONVERGED


def replace_gravity(scene, times):
    gravity = scene.gravity
    values = {"acceleration": tuple(times * a for a in gravity.acceleration)}
    return scene.model_copy(update={"gravity": type(gravity)(**values)})


def test_none_and_misuse():
    assert lumped.solve_many(SCENE, []) == lumped.solve_many([], SPRINGS) == []
    with pytest.raises(BadInput, match="2 scenes and 3 calibrations"):
        lumped.solve_many([SCENE, SCENE], [SPRINGS] * 3)
    with pytest.raises(SceneError):
        lumped.solve_many([SCENE, SCENE.model_copy(update={"supports": ()})], SPRINGS)
