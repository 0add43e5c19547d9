"""The condensed model: its equilibrium, its motion, and where it stops."""

from itertools import pairwise

import numpy as np
import pytest
from dynamic_cases import ROD, scene, springs, system

import lumped
from lumped.dynamics.reduced import LOOK, Reduced
from lumped.reduction.monomials import add_force, gradients, monomials, values
from sheetbench import scenes
from sheetbench.scenes import Status
from sheetbench.scenes.errors import BadInput


def test_monomials_gradients_and_second_derivatives_agree_with_differences():
    table, q, h = monomials(3, (1, 2, 3, 4)), np.array([0.3, -0.7, 1.1]), 1e-6
    weight = np.random.default_rng(0).standard_normal(len(table))
    force, tangent = np.zeros(3), np.zeros((3, 3))
    add_force(table, weight, q, force, tangent)
    assert force == pytest.approx(weight @ gradients(table, q))
    for i, along in enumerate(np.eye(3)):
        ahead, behind = (values(table, q + sign * h * along) for sign in (1.0, -1.0))
        assert gradients(table, q)[:, i] == pytest.approx((ahead - behind) / (2.0 * h), abs=1e-8)
        slopes = [weight @ gradients(table, q + sign * h * along) for sign in (1.0, -1.0)]
        assert tangent[:, i] == pytest.approx((slopes[0] - slopes[1]) / (2.0 * h), abs=1e-7)


def test_the_models_equilibrium_is_the_lattices():
    asked = scenes.load("two-edges-settling")
    equations, rest = system(asked)
    model = Reduced(equations, 1e-3)._model
    pull = model.modes.T @ equations.reduce(equations.external(rest.u, 0.0))
    q = np.zeros(len(pull))
    for share in np.linspace(0.1, 1.0, 10).repeat(4):
        left, tangent = model.squares * q - share * pull, np.diag(model.squares)
        add_force(model.energy, model.weights, q, left, tangent)
        q = q - np.linalg.solve(tangent, left)
    u = equations.expand(model.modes @ q + values(model.expansion, q) @ model.shapes)
    corner = equations.assembly.lattice.columns()[-1, -1]
    static = lumped.solve(asked, springs(asked)).displacement(np.array([[0.188, 0.188]]))[0]
    assert np.abs(u[corner].mean(axis=0) - static).max() < 0.02 * np.abs(static).max()


def test_four_modes_follow_the_settling_sheet():
    asked = scenes.load("two-edges-settling")
    full = lumped.simulate(asked, springs(asked), 0.4, integrator="esdirk", step=2e-3, every=0.01)
    few = lumped.simulate(asked, springs(asked), 0.4, integrator="reduced", step=1e-3, every=0.01)
    assert few.status is Status.CONVERGED and few.steps == 400
    largest = np.abs(full.probes["P4"]).max()
    assert np.abs(few.probes["P4"] - full.probes["P4"]).max() < 0.08 * largest
    taken = few.energies["dissipated"][-1]
    assert taken == pytest.approx(full.energies["dissipated"][-1], rel=0.05)


def test_steps_of_the_model_are_of_second_order():
    equations, rest = system(scenes.load("two-edges-settling"), 5)
    method, ends = Reduced(equations, 1e-3), []
    for count in (20, 40, 80):
        method.recall({"algorithm": None, "largest": 0.0, "unseen": 0})
        state, left = rest, count
        while left:
            advance, taken = method.march(state, 0.1 / count, left)
            state, left = advance.state, left - taken
        ends.append(state.u)
    changes = [np.abs(a - b).max() for a, b in pairwise(ends)]
    assert np.log2(changes[0] / changes[1]) == pytest.approx(Reduced.order, abs=0.15)
    assert changes[1] < 2e-2 * np.abs(ends[-1]).max()


def test_the_full_equations_are_asked_every_so_many_steps_however_rare_the_samples(monkeypatch):
    asked, looks, look = scenes.load("two-edges-settling"), [], Reduced._look
    monkeypatch.setattr(Reduced, "_look", lambda self, state: looks.append(state.time) or look(self, state))
    lumped.simulate(asked, springs(asked), 0.1, integrator="reduced", step=1e-3, every=0.05)
    np.testing.assert_allclose(np.diff([0.0, *looks]), LOOK * 1e-3, rtol=1e-6)
    assert len(looks) == 5


class Stopped(Exception):
    """What ends a run from outside."""


def test_a_stopped_run_resumes_to_the_last_digit(tmp_path):
    asked, seen = scenes.load("two-edges-settling"), []
    options = {"integrator": "reduced", "step": 1e-3, "every": 2e-3, "frames": 20}

    def stop(time):
        seen.append(time)
        if len(seen) > 55:  # samples after the checkpoint, to be dropped
            raise Stopped

    whole = lumped.simulate(asked, springs(asked, 3), 0.12, store=tmp_path / "whole", **options)
    with pytest.raises(Stopped):
        lumped.simulate(asked, springs(asked, 3), 0.12, store=tmp_path / "cut", progress=stop, **options)
    resumed = lumped.simulate(asked, springs(asked, 3), 0.12, store=tmp_path / "cut", **options)
    assert resumed.resumed_from == pytest.approx(0.1) and resumed.steps == whole.steps == 120
    for file in ("samples.bin", "frames.bin"):
        assert (tmp_path / "cut" / file).read_bytes() == (tmp_path / "whole" / file).read_bytes()


def test_motion_that_the_model_does_not_know_ends_the_run():
    asked = scenes.load("two-edges-settling")
    history = lumped.simulate(
        asked, springs(asked), 0.3, integrator="reduced", modes=1, step=1e-3, every=0.01
    )
    assert history.status is Status.DIVERGED
    assert "left what the reduced model knows" in history.message and "use more modes" in history.message


@pytest.mark.parametrize(
    "asked",
    [
        scene("one-edge-clamped", actuators=[ROD]),
        scene("one-edge-clamped", loads=[{"kind": "pressure", "value": 1.0}]),
        scene("curved-edge"),
        scene(gravity=False),
    ],
)
def test_what_it_cannot_be_made_of_is_refused(asked):
    with pytest.raises(BadInput, match="'reduced'"):
        lumped.simulate(asked, springs(asked, 4), 0.01, integrator="reduced")


@pytest.mark.parametrize("modes", [0, 1000])
def test_no_modes_or_nearly_all_of_them_are_refused(modes):
    with pytest.raises(BadInput, match="at least 1, and at most a third of the unknowns"):
        Reduced(system(scene(), 3)[0], 1e-3, modes)
