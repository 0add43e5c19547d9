"""Paths that large load steps would leave: a column that is not quite straight, a fold jumped over."""

import numpy as np
import pytest
from cases import elastica_tip, equilibrium, sheet

import lumped
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation import trace as tracer
from sheetbench.numerics.continuation.limits import Limits
from sheetbench.scenes import Curved, EdgeLoad, Gravity

PRESS, ACROSS = 0.0334127, 0.002  # N/m: 1.3 of Euler's load, and a little upwards
PRESSED = (EdgeLoad(edge="x1", force_per_length=(-PRESS, 0.0, ACROSS)),)
COLUMN = sheet(0.2, 0.05, 0.001, 5e6, 0.0, 1100.0, loads=PRESSED)


@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_a_column_bends_the_way_it_is_pushed(model):
    found = equilibrium(COLUMN, model, (33, 3), (16, 2))
    assert not found.snaps
    tip = found.displacement([(0.2, 0.025)])[0, [0, 2]]
    exact = elastica_tip(5e6 * 0.001**3 / 12.0, 0.2, (-PRESS, ACROSS), turn=2.0) - [0.2, 0.0]
    np.testing.assert_allclose(tip, exact, atol=5e-3 * 0.148)


def test_a_fold_that_large_steps_jump_over_is_told_with_its_load():
    """A hundredth below it nothing snaps yet, a hundredth above it does."""
    bent = (Curved(edge="x0", curvature=-8.0),)
    scene = sheet(0.15, 0.15, 0.002, 1e7, 0.45, 1200.0, weight=0.78 * 9.81, supports=bent)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(9, 9), method="consistent")
    found = lumped.solve(scene, springs)
    assert found.status is Status.CONVERGED
    (turning,) = found.snaps

    def up_to(share):
        weight = Gravity(acceleration=(0.0, 0.0, -0.78 * 9.81 * share))
        part = scene.replace(gravity=weight, supports=(Curved(edge="x0", curvature=-8.0 * share),))
        return lumped.solve(part, springs)

    below, above = up_to(0.99 * turning), up_to(1.01 * turning)
    assert not below.snaps and below.status is Status.CONVERGED and above.snaps


def pulled(force, along=2):
    """A sheet pulled by its far edge [N/m]; straight up it bends by a quarter turn, and nothing folds."""
    pull = tuple(force * np.eye(3)[along])
    loads = (EdgeLoad(edge="x1", force_per_length=pull),)
    return sheet(0.15, 0.15, 0.002, 1e7, 0.45, 1200.0, loads=loads)


@pytest.mark.parametrize("model", ["lumped", "shell"])
@pytest.mark.parametrize("force", [300.0, 3000.0])
def test_a_look_for_folds_costs_a_few_times_the_path(monkeypatch, force, model):
    """And tells of none where there is none, however small the share of the load that a step is."""
    scene = pulled(force)
    looked = equilibrium(scene, model, 9, 4)
    monkeypatch.setattr(tracer, "_careful_budget", lambda *_: 0)
    plain = equilibrium(scene, model, 9, 4)
    assert plain.iterations < looked.iterations <= (1 + Limits.careful_budget_factor) * plain.iterations
    assert looked.message == plain.message and looked.snaps == plain.snaps == ()
    at = scene.probe_points()
    np.testing.assert_allclose(looked.displacement(at), plain.displacement(at), atol=1e-8)


def test_strains_that_the_springs_have_no_meaning_at_are_not_followed_for_long():
    """Before, 522 factorisations where the path had taken 25."""
    scene = pulled(5e4, along=0)
    found = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, 9, "consistent"))
    assert found.status is Status.STRAIN_OUTSIDE_MODEL
    assert found.iterations < 200


@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_a_look_that_finds_no_end_leaves_the_answer_and_says_so(monkeypatch, model):
    monkeypatch.setattr(tracer, "_careful_budget", lambda *_: 20)
    found = equilibrium(pulled(300.0), model, 9, 4)
    assert found.load_factor == 1.0
    assert "after 20 factorisations" in found.message and "another branch" in found.message
