"""ESDIRK5(4): the tableau's order conditions, samples within steps, kinks, what it refuses."""

from itertools import pairwise

import numpy as np
import pytest
from dynamic_cases import ROD, make_scene, run, springs, system

import lumped
from lumped.dynamics.implicit import esdirk
from lumped.dynamics.implicit.compiled_stages import polynomials
from lumped.dynamics.implicit.esdirk import Esdirk
from lumped.dynamics.implicit.newton import Newton
from lumped.dynamics.implicit.tableau import ABSCISSAE, CUMULATIVE, ERRORS, GUESSES, STAGES, WEIGHTS
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Air, Clamped, EdgeLoad, Material, Scene, Sheet


def conditions(weights, order):
    """What each rooted tree of up to five nodes leaves of its order condition."""
    a, c, one = STAGES, ABSCISSAE, np.ones(7)
    trees = {
        1: [(one, 1.0)],
        2: [(c, 1 / 2)],
        3: [(c**2, 1 / 3), (a @ c, 1 / 6)],
        4: [(c**3, 1 / 4), (c * (a @ c), 1 / 8), (a @ c**2, 1 / 12), (a @ a @ c, 1 / 24)],
        5: [
            (c**4, 1 / 5),
            (c**2 * (a @ c), 1 / 10),
            ((a @ c) ** 2, 1 / 20),
            (c * (a @ c**2), 1 / 15),
            (c * (a @ a @ c), 1 / 30),
            (a @ c**3, 1 / 20),
            (a @ (c * (a @ c)), 1 / 40),
            (a @ a @ c**2, 1 / 60),
            (a @ a @ a @ c, 1 / 120),
        ],
    }
    return np.array([weights @ phi - value for q in range(1, order + 1) for phi, value in trees[q]])


def test_the_tableau_is_of_fifth_order_with_an_embedded_fourth():
    assert np.abs(conditions(WEIGHTS, 5)).max() < 1e-14
    assert np.abs(conditions(WEIGHTS - ERRORS, 4)).max() < 1e-14
    assert np.abs(STAGES @ ABSCISSAE - ABSCISSAE**2 / 2)[1:].max() < 1e-14  # stages of second order
    stability = np.linalg.solve(np.eye(7) + 1e9 * STAGES, np.ones(7))[-1]  # u₁/u₀ at z = −1e9
    assert abs(stability) < 1e-7
    assert CUMULATIVE.sum(axis=0) == pytest.approx(WEIGHTS)


def test_states_within_a_step_are_those_of_shorter_steps():
    """Of fifth degree with both ends' accelerations: a sixth of the step's sixth power (Hermite)."""
    equations, rest = system(make_scene(damping_time=1e-3), 4)
    start, _ = run(Esdirk(equations, 1e-3), rest, 1e-3, 10)
    misses = []
    for h in (8e-3, 4e-3):
        whole, parts = Esdirk(equations, h), Esdirk(equations, h / 8)
        total = whole.advance(start[-1], h)
        states, taken = run(parts, start[-1], h / 8, 8)
        passed = whole.at(np.array([state.time for state in states[1:]]), total)
        assert passed.dissipated == pytest.approx(np.cumsum(taken), rel=0.02)
        assert passed.dissipated[-1] == pytest.approx(total.dissipated, rel=1e-12)
        misses.append(np.abs(passed.u[2] - states[3].u).max())
    assert misses[0] < 1e-3 * np.abs(start[-1].u).max()
    assert misses[1] < misses[0] / 16.0


def test_samples_do_not_change_the_steps_and_lie_on_one_curve():
    scene = make_scene("two-edges-settling")
    fine, coarse = (
        lumped.simulate(scene, springs(scene), 0.3, integrator="esdirk", every=e) for e in (1e-3, 0.05)
    )
    tight = lumped.simulate(scene, springs(scene), 0.3, integrator="esdirk", step=1e-3, every=1e-3)
    for history in (fine, coarse, tight):
        assert history.status is Status.CONVERGED
    assert fine.steps < 60 and coarse.steps < 60
    truth = tight.probes["P4"]
    largest = np.abs(truth).max()
    assert np.abs(fine.probes["P4"] - truth).max() < 1e-3 * largest
    assert np.abs(coarse.probes["P4"] - truth[::50]).max() < 1e-3 * largest
    for edge, reaction in tight.reactions.items():  # stiff springs magnify what the polynomial leaves
        assert np.abs(fine.reactions[edge] - reaction)[20:].max() < 0.05 * np.abs(reaction).max()
    went_round = np.abs(fine.energies["potential"]).max()
    assert np.abs(fine.balance - fine.balance[0]).max() < 2e-3 * went_round


def test_polynomials_serve_where_states_have_little_energy_too_much(monkeypatch):
    """All states within steps solved for, they differ by less than the error that a step may have, and their
    energy by less than ten times that."""
    scene = make_scene("two-edges-settling")
    few = lumped.simulate(scene, springs(scene), 0.3, integrator="esdirk", every=1e-3)
    monkeypatch.setattr(Newton, "excess", lambda *given: np.inf)
    each = lumped.simulate(scene, springs(scene), 0.3, integrator="esdirk", every=1e-3)
    assert few.steps == each.steps < 60
    largest = max(np.abs(u).max() for u in each.probes.values())
    for name, u in each.probes.items():
        assert np.abs(few.probes[name] - u).max() < 3.0 * esdirk.ERROR * largest  # as motions of each wander
    stored = each.energies["elastic"]
    assert np.abs(few.energies["elastic"] - stored).max() < esdirk.ENERGY * esdirk.ERROR * stored.max()


@pytest.mark.sweep(2)
@pytest.mark.parametrize("grid", [(9, 2), (11, 2)])
def test_a_plucked_film_in_air_keeps_its_energy_at_every_sample(grid):
    """Steps are three samples long, and stiff springs magnify what their polynomial misses: where an equation
    of a sample was not solved with the step's factors its energy was off by 7 %, or the run ended by it."""
    film, tip = Sheet(0.06, 0.012, 3e-4), EdgeLoad("x1", force_per_length=(0.0, 0.0, 0.15), hold=True)
    own = {"air": Air(drag=1.6, density=1.2), "initial": {"shape": "static"}, "loads": (tip,)}
    scene = Scene("film", film, Material(8e8, 0.0, 1300.0), supports=(Clamped("x0"),), **own)
    history = lumped.simulate(scene, lumped.calibrate(film, scene.material, grid), 1.4)
    assert history.status is Status.CONVERGED
    lost = history.numerical / history.energies["elastic"][0]
    assert lost.min() > -1e-4 and lost.max() < 0.008
    assert lost[len(lost) // 2 :].max() - lost[len(lost) // 2] < 2e-3  # but for waves of the beginning


def test_guesses_of_stages_are_right_where_the_acceleration_stays():
    np.testing.assert_allclose(GUESSES[1:].sum(axis=1), 1.0, atol=1e-12)
    assert not np.triu(GUESSES).any()


def test_steps_follow_the_error_asked_for():
    scene, steps, misses = make_scene("two-edges-settling"), [], []
    kept = springs(scene, 4)
    truth = lumped.simulate(scene, kept, 0.1, integrator="esdirk", step=1e-3, every=0.01).probes["P4"]
    for error in (3e-4, 3e-6):
        found = lumped.simulate(scene, kept, 0.1, integrator="esdirk", every=0.01, error=error)
        steps.append(found.steps)
        misses.append(np.abs(found.probes["P4"] - truth).max() / np.abs(truth).max())
        assert misses[-1] < 10 * error  # of some ten steps, as they follow each other
    assert steps[0] < steps[1] and misses[1] < misses[0]


def test_steps_end_where_a_load_changes_its_course():
    pulse = {"time": [0.1, 0.101, 0.102], "factor": [0.0, 1.0, 0.0]}
    load = {"kind": "point", "at": [0.188, 0.188], "force": [0.0, 0.0, 5.0], "history": pulse}
    scene = make_scene(gravity=False, loads=[load], damping_time=1e-3)
    equations, state = system(scene, 4)
    method, times = Esdirk(equations, 0.02, fixed=False), [0.0]
    while state.time < 0.2:
        state = method.advance(state, 0.25 - state.time).state
        times.append(state.time)
    for kink in pulse["time"]:
        assert min(abs(time - kink) for time in times) < 1e-12
    assert max(b - a for a, b in pairwise(times)) > 0.01
    assert np.abs(state.u).max() > 1e-5  # a pulse shorter than a step is felt


@pytest.mark.parametrize("name", ["esdirk", "verlet"])
def test_chains_are_refused(name):
    scene = make_scene("one-edge-clamped", actuators=[ROD])
    with pytest.raises(BadInput, match=f"'{name}': does not take chains"):
        lumped.simulate(scene, springs(scene, 4), 0.01, integrator=name)


def test_a_steps_polynomial_has_the_states_of_both_ends(monkeypatch):
    """Compiled, and as Python, which checks indices."""
    ends = np.random.default_rng(0).standard_normal((3, 2, 4, 3))
    compiled = polynomials(*ends, 0.1, np.array([0.0, 1.0]))
    monkeypatch.setattr("lumped.dynamics.implicit.compiled_stages.empty", np.empty)
    python = getattr(polynomials, "py_func", polynomials)(*ends, 0.1, np.array([0.0, 1.0]))
    for found in (compiled, python):
        np.testing.assert_allclose(found, ends, rtol=1e-11, atol=1e-11)
