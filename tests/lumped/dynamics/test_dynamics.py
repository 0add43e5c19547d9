"""Dynamics: settling, energy, periods, agreement with solve_ivp, orders, step limits, momentum, dampers."""

from itertools import pairwise

import numpy as np
import pytest
from dynamic_cases import make_scene, run, springs, system

import lumped
from lumped.dynamics import INTEGRATORS
from lumped.dynamics.explicit.step_limit import step_limit, turn_limit
from lumped.dynamics.implicit.esdirk import ERROR
from lumped.dynamics.integrator import StepFailed
from lumped.dynamics.runs.plan import plan_run
from lumped.lattice import STEPS
from sheetbench.answers.solution import Status
from sheetbench.runs.schedule import Schedule
from sheetbench.scenes import DamperSet


def largest(values):
    return float(np.abs(values).max())


@pytest.mark.parametrize("name, dips", [("generalised-alpha", 0.0), ("esdirk", ERROR)])
def test_settles_on_the_static_answer(name, dips):
    """Dampers only take energy; within its steps `esdirk` has a polynomial, good to their error."""
    scene = make_scene(damping_time=0.02)
    static = lumped.solve(scene, springs(scene)).displacement(scene.probe_points())
    history = lumped.simulate(scene, springs(scene), 0.8, integrator=name)
    end = np.array([history.probes[name][-1] for name in scene.probes])
    assert history.status is Status.CONVERGED
    assert largest(end - static) < 1e-4 * largest(static)  # measured 2e-6
    taken = history.energies["dissipated"]
    assert np.all(np.diff(taken) >= -dips * taken[-1])


ORDER_STEPS = {"verlet": 4e-5, "generalised-alpha": 4e-5, "esdirk": 4e-4, "midpoint": 4e-5}
# damped, the slope of a fifth-order method wanders where its steps pass the dampers' own times
ORDERS = [(name, d) for name in INTEGRATORS for d in (0.0, 1e-3) if (name, d) != ("esdirk", 1e-3)]


def test_an_explicit_run_without_an_end_is_refused():
    scene = make_scene(damping_time=10.0)
    with pytest.raises(ValueError, match=r"'verlet': would take \d\.\de\+\d+ steps.*ω_max.*implicit"):
        lumped.simulate(scene, springs(scene), 1.0, integrator="verlet")


@pytest.mark.parametrize("name, damping", ORDERS)
def test_observed_order_is_the_declared_one(name, damping):
    scene = make_scene(damping_time=damping)
    step = ORDER_STEPS[name] * (0.1 if name == "verlet" and damping else 1.0)
    masses, duration = (4, 0.004) if name == "esdirk" else (3, 0.002)
    ends = []
    for h in (step / 2, step / 4, step / 8):
        history = lumped.simulate(
            scene, springs(scene, masses), duration, integrator=name, step=h, every=step
        )
        ends.append(history.probes["P4"])
    changes = [largest(a - b) for a, b in pairwise(ends)]
    slope = np.log2(changes[0] / changes[1])
    assert slope == pytest.approx(INTEGRATORS[name].order, abs=0.15)
    assert changes[1] < 2e-3 * largest(ends[-1])


def grows(equations, rest, h, steps=400):
    """Whether small random motion grows under verlet with step h."""
    rng = np.random.default_rng(0)
    v = equations.expand(1e-6 * rng.standard_normal(equations.reduced_mass.shape[0]))
    start = type(rest)(0.0, rest.u, v, equations.accelerate(equations.unbalanced(rest.u, v, 0.0)))
    method, state = INTEGRATORS["verlet"](equations, h), start
    try:
        while steps:
            advance = method.march(state, h, steps)
            state, steps = advance.state, steps - advance.steps
    except StepFailed:
        return True
    return largest(state.v) > 1e2 * largest(v)


def amplification(h, ratio):
    """Spectral radius of verlet's step for an oscillator of frequency 1 and damping ratio `ratio`."""
    columns = []
    for u, v in ((1.0, 0.0), (0.0, 1.0)):
        a = -u - 2.0 * ratio * v
        moved = u + h * v + 0.5 * h * h * a
        columns.append([moved, v + 0.5 * h * (a - moved - 2.0 * ratio * (v + h * a))])
    return largest(np.linalg.eigvals(np.array(columns).T))


@pytest.mark.parametrize("ratio", [0.0, 0.05, 0.3, 0.49, 0.7, 2.0])
def test_explicit_step_limit_agrees_with_theory(ratio):
    equations, rest = system(make_scene(gravity=False))
    frequency = step_limit(equations, rest.u).frequency
    equations, rest = system(make_scene(gravity=False, damping_time=2.0 * ratio / frequency))
    limit = step_limit(equations, rest.u)
    assert limit.damping_ratio == pytest.approx(ratio, rel=1e-4, abs=1e-12) and limit.exact
    assert amplification(0.9999 * limit.step * frequency, ratio) < 1.0 + 1e-9
    assert amplification(1.001 * limit.step * frequency, ratio) > 1.0 + 1e-9
    assert limit.step >= 0.9999 * 2.0 / frequency * (np.sqrt(1.0 + ratio**2) - ratio)  # central differences
    assert not grows(equations, rest, 0.995 * limit.step)
    assert grows(equations, rest, 1.02 * limit.step, steps=2000)


@pytest.mark.parametrize("ratio", [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 1.0, 5.0])
def test_the_limit_for_any_dampers_holds_for_every_damping_up_to_theirs(ratio):
    """The box of (ω h)² and c h below the limit's corner is stable, and its corner or an edge touches."""
    turn = turn_limit(ratio, exact=False)
    assert turn <= turn_limit(ratio)
    radius = np.array(
        [[amplification(h, z / 2.0 / h) for h in turn * np.linspace(0.01, 1, 40)] for z in
         2.0 * ratio * turn * np.linspace(0, 1, 41)]
    )  # fmt: skip
    assert radius.max() < 1.0 + 1e-9
    z = np.linspace(0.0, 2.0 * ratio * 1.01 * turn, 400)
    assert max(amplification(1.01 * turn, each / 2.02 / turn) for each in z) > 1.0 + 1e-9


def test_a_step_above_the_limit_is_refused_with_the_limit_named():
    scene = make_scene()
    equations, rest = system(scene)
    limit = step_limit(equations, rest.u)
    with pytest.raises(ValueError, match=rf"stability limit of verlet, {limit.step:.4g} s .*ω_max"):
        lumped.simulate(scene, springs(scene), 0.01, integrator="verlet", step=1.001 * limit.step)
    assert lumped.simulate(scene, springs(scene), 0.01, integrator="verlet", step=0.999 * limit.step).steps


@pytest.mark.parametrize("damping", [0.0, 1e-3])
@pytest.mark.parametrize("name, tolerance", [("verlet", 1e-10), ("midpoint", 1e-9)])
def test_momentum_of_a_free_sheet_is_conserved(name, tolerance, damping):
    equations, rest = system(make_scene(gravity=False, supports=[], damping_time=damping), n=4)
    rng = np.random.default_rng(1)
    x, mass = equations.assembly.lattice.positions, equations.lattice_mass[:, None]
    v = np.cross([3.0, -2.0, 5.0], x - x.mean(axis=0)) + 0.02 * rng.standard_normal(x.shape)
    v += [0.1, 0.2, -0.3]
    start = type(rest)(0.0, rest.u, v, equations.accelerate(equations.unbalanced(rest.u, v, 0.0)))
    h = min(2e-5, 0.5 * step_limit(equations, rest.u).step) if name == "verlet" else 1e-3
    states, _ = run(INTEGRATORS[name](equations, h), start, h, 100)
    linear = [(mass * s.v).sum(axis=0) for s in states]
    angular = [np.cross(x + s.u, mass * s.v).sum(axis=0) for s in states]
    if name == "verlet" and damping:  # the second look at the dampers is not at the same place and velocity
        angular, tolerance = linear, 1e-10
    assert largest(np.array(linear) - linear[0]) < tolerance * largest(linear[0])
    assert largest(np.array(angular) - angular[0]) < tolerance * largest(angular[0])


@pytest.mark.parametrize("name, h", [("verlet", 2e-5), ("midpoint", 1e-3), ("generalised-alpha", 1e-3)])
def test_a_push_that_ends_between_steps_has_its_own_impulse(name, h):
    """Steps end at both ends of the jump; half a step more of the push was felt before."""
    end, until = 10.5 * h, 20 * h
    history = {"time": [0.0, end, end + 1e-3 * h], "factor": [1.0, 1.0, 0.0]}
    scene = make_scene(supports=[]).replace(gravity={"acceleration": [1.0, 0.0, 0.0], "history": history})
    pushed = lumped.simulate(scene, springs(scene, 3), until, integrator=name, step=h, every=until)
    gone = 0.5 * end**2 + end * (until - end)
    assert pushed.probes["P1"][-1, 0] == pytest.approx(gone, rel=1e-4)  # 3e-2 before


def test_dampers_of_the_table_act_by_family_and_mass_damping_decays_exactly():
    table = DamperSet(axial=0.5, cross=0.2)
    equations, rest = system(make_scene(gravity=False).model_copy(update={"dampers": table}), n=3)
    v = 0.1 * np.random.default_rng(0).standard_normal(rest.u.shape)
    power, force = equations.damping_force(rest.u, v, 0.0)
    links = equations.assembly.lattice.links
    c = np.array([{"axial": 0.5, "cross": 0.2}.get(name, 0.0) for name, *_ in STEPS])[links.step]
    a, b = links.nodes.T
    n = links.offset / links.rest_length[:, None]
    expected = np.sum(c * links.shares.sum(axis=0) * np.sum(n * (v[b] - v[a]), axis=1) ** 2)
    assert power == pytest.approx(expected, rel=1e-12) and power == pytest.approx(np.sum(force * v))
    equations, rest = system(make_scene(gravity=False, supports=[], damping_rate=4.0), n=3)
    v = np.tile([0.1, 0.0, 0.2], (len(rest.u), 1))
    start = type(rest)(0.0, rest.u, v, equations.accelerate(equations.unbalanced(rest.u, v, 0.0)))
    states, _ = run(INTEGRATORS["midpoint"](equations, 1e-3), start, 1e-3, 200)
    assert states[-1].v[0] == pytest.approx(v[0] * np.exp(-4.0 * 0.2), rel=1e-5)


def test_unknown_choices_are_refused():
    scene = make_scene()
    for options, said in (
        ({"integrator": "euler"}, "choose from generalised-alpha"),
        ({"step": -1.0}, "step = -1 s"),
        ({"integrator": "verlet", "radius": 0.5}, "does not take radius"),
    ):
        with pytest.raises(ValueError, match=said):
            lumped.simulate(scene, springs(scene), 0.01, **options)


@pytest.mark.parametrize("periods", [0.1, 3.0])
def test_the_lowest_period_has_a_hundred_samples(periods):
    scene = make_scene()
    calibration = springs(scene, 3)
    period = 1.0 / lumped.modes(scene, calibration, 1, calibration.masses).frequencies[0]
    equations, _ = system(scene, 3)
    plan, _ = plan_run(equations, calibration, None, periods * period, None, "esdirk", None)
    assert plan.samples == round(100 * periods)
    assert plan.every == pytest.approx(period / 100, rel=1e-9)


def test_frames_are_the_first_and_the_last_sample_and_evenly_between():
    plan = Schedule(samples=10, every=1e-3)
    assert plan.shown(0) == [] and plan.shown(1) == [0] and plan.shown(2) == [0, 10]
    assert plan.shown(3) == [0, 5, 10] and plan.shown(4) == [0, 3, 7, 10]
