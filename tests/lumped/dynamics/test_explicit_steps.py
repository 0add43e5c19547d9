"""Compiled steps of velocity Verlet: the same states and energies as the steps one by one, to rounding."""

import numpy as np
import pytest
import scipy.sparse as sp
from dynamic_cases import scene, springs

from lumped import INTEGRATORS, StepFailed, System, build_problem, simulate, step_limit
from lumped.dynamics.explicit import flat_system
from lumped.dynamics.runs.initial import initial_state
from lumped.springs import packing

STEPS = 60
HISTORY = {"time": [0.0, 1e-4, 2e-4], "factor": [0.2, 1.0, -0.5]}
COURSE = {"time": [0.0, 1e-4, 2e-4], "displacement": [[0.0, 0.0, 0.0], [0.0, 1e-5, 2e-5], [0.0, 0.0, -1e-5]]}
TURNED = {
    "kind": "motion",
    "edge": "x1",
    "time": [0.0, 2e-4],
    "displacement": [[0.0, 0.0, 0.0], [0.0, 0.0, 1e-5]],
    "rotation": [[0.0, 0.0, 0.0], [0.0, 1e-3, 5e-4]],
}
CLAMP = {"edge": "x0", "kind": "clamped"}
LOADS = [
    {"kind": "point", "at": [0.1, 0.12], "force": [0.1, 0.0, 0.3], "history": HISTORY},
    {"kind": "pressure", "value": 30.0},
    {"kind": "pressure", "value": -10.0, "history": HISTORY},
    {
        "kind": "edge",
        "edge": "x1",
        "force_per_length": [0.0, 0.1, 0.0],
        "moment_per_length": 0.02,
        "history": HISTORY,
    },
]
CASES = {
    "weight": scene(),
    "dampers": scene(damping_time=1e-5),
    "masses damped": scene(damping_rate=30.0),
    "both damped": scene(damping_time=1e-5, damping_rate=30.0),
    "hinged": scene(
        supports=[{"edge": "x0", "kind": "hinged"}, {"edge": "y0", "kind": "held", "components": ["z"]}],
        damping_time=1e-5,
    ),
    "loads": scene(loads=LOADS, damping_time=1e-5),
    "moved clamp": scene(supports=[{**CLAMP, "motion": COURSE}], damping_time=1e-5, damping_rate=30.0),
    "moved hinge": scene(supports=[CLAMP, {"edge": "x1", "kind": "hinged", "motion": COURSE}]),
    "turned edge": scene(supports=[CLAMP], actuators=[TURNED], damping_time=1e-5),
}


def start_of(asked, precision="double", n=5):
    calibration = springs(asked, n)
    system = System(asked, build_problem(asked, calibration, precision=precision))
    return system, initial_state(system, calibration, "tributary")


def test_a_call_takes_several_steps_of_the_largest_lattice(monkeypatch):
    """To lay it out for a call and back takes as long as two."""
    monkeypatch.setattr(flat_system, "PER_SPRING", 1.0)
    system, state = start_of(CASES["dampers"])
    _, taken = INTEGRATORS["verlet"](system, 1e-7).march(state, 1e-7, 100)
    assert taken == flat_system.LEAST


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("precision", ["double", "single"])
def test_compiled_steps_are_the_steps_one_by_one(name, precision):
    system, state = start_of(CASES[name], precision)
    step = 0.8 * step_limit(system, state.u).step
    method = INTEGRATORS["verlet"](system, step)
    compiled, taken = method.march(state, step, STEPS)
    dissipated = work = 0.0
    for _ in range(STEPS):
        advance = method.advance(state, step)
        state = advance.state
        dissipated, work = dissipated + advance.dissipated, work + advance.work
    assert taken == STEPS
    assert compiled.state.time == state.time
    # rounding of some thirty forces a mass and step, which the stiffest motions keep
    tolerance = 1e3 * STEPS * float(np.finfo(np.float32 if precision == "single" else float).eps)
    for one, other in ((compiled.state.u, state.u), (compiled.state.v, state.v), (compiled.state.a, state.a)):
        assert np.abs(one - other).max() < tolerance * np.abs(other).max()
    scale = max(abs(dissipated), abs(work), system.balance(state)[0]["kinetic"])
    assert compiled.dissipated == pytest.approx(dissipated, abs=tolerance * scale)
    assert compiled.work == pytest.approx(work, abs=tolerance * scale)


def test_dampers_ask_for_shapes_that_were_kept_or_find_them_anew(monkeypatch):
    system, state = start_of(CASES["both damped"])
    step = 0.8 * step_limit(system, state.u).step
    ends = []
    for most, keeping in ((packing.CACHE_LIMIT, True), (0, False)):
        monkeypatch.setattr(packing, "CACHE_LIMIT", most)
        system, _ = start_of(CASES["both damped"])
        assert system.packing.keeping == keeping
        ends.append(INTEGRATORS["verlet"](system, step).march(state, step, STEPS)[0])
    kept, found = ends
    assert np.abs(kept.state.v - found.state.v).max() < 1e-12 * np.abs(kept.state.v).max()
    assert kept.dissipated == pytest.approx(found.dissipated, rel=1e-12)


def newmark(system, state, step):
    """One step of Newmark's method, β = 0 and γ = ½, by dense matrices, and the power that dampers take."""
    time, transform = state.time + step, system.transform.toarray()
    placed = [(system.place(t), system.place_rate(t)) for t in (state.time, time)]
    jump = placed[1][0] - placed[0][0] - step * placed[0][1]
    half = state.v + 0.5 * step * state.a
    u = state.u + step * half + jump
    half = half + placed[1][1] - placed[0][1]
    blocks = system.matrix(u, np.zeros_like(u), time, 0.0, 1.0, 0.0)
    pattern = system.assembly.pattern
    damping = sp.bsr_array((blocks, pattern.indices, pattern.indptr)).toarray()
    matrix = system.mass.toarray() + 0.5 * step * damping
    force = system.external(u, time) - system.elastic(u, time)[1]
    known = (system.mass @ half.ravel()) + 0.5 * step * force.ravel() - matrix @ placed[1][1].ravel()
    free = np.linalg.solve(transform.T @ matrix @ transform, transform.T @ known)
    v = (transform @ free).reshape(-1, 3) + placed[1][1]
    return type(state)(time, u, v, (v - half) * (2.0 / step)), v.ravel() @ damping @ v.ravel()


@pytest.mark.parametrize("name", CASES)
def test_implicit_damping_solves_its_equations(name):
    stiff = CASES[name].replace(material=CASES[name].material.replace(damping_time=4e-3))
    system, state = start_of(stiff, n=4)
    step = INTEGRATORS["verlet-implicit-damping"].limit(system, state.u).advised
    compiled, taken = INTEGRATORS["verlet-implicit-damping"](system, step).march(state, step, 20)
    work = dissipated = power = 0.0
    power = system.damping_force(state.u, state.v)[0]
    for _ in range(taken):
        after, now = newmark(system, state, step)
        dissipated, power = dissipated + 0.5 * step * (power + now), now
        work, state = work + system.work(state, after), after
    # corrections end at 1e-8 of the velocity, which a step's acceleration divides by the step
    assert taken == 20
    assert np.abs(compiled.state.u - state.u).max() < 1e-6 * np.abs(state.u).max()
    assert np.abs(compiled.state.v - state.v).max() < 1e-6 * np.abs(state.v).max()
    scale = max(dissipated, abs(work), system.balance(state)[0]["kinetic"])
    assert compiled.dissipated == pytest.approx(dissipated, abs=1e-5 * scale)
    assert compiled.work == pytest.approx(work, abs=1e-5 * scale)


def test_implicit_damping_is_stable_up_to_the_springs_own_limit():
    """Small random motion decays below 2/ω_max and grows above, where the dampers' limit is far less."""
    system, rest = start_of(scene(gravity=False, damping_time=4e-3))
    limit = INTEGRATORS["verlet-implicit-damping"].limit(system, rest.u)
    assert limit.step == pytest.approx(2.0 / limit.frequency)
    assert step_limit(system, rest.u).step < 0.1 * limit.step
    v = system.expand(1e-9 * np.random.default_rng(0).standard_normal(system.reduced_mass.shape[0]))
    start = type(rest)(0.0, rest.u, v, np.zeros_like(v))

    def reached(step, left=3000):
        method, state = INTEGRATORS["verlet-implicit-damping"](system, step), start
        while left:
            advance, taken = method.march(state, step, left)
            state, left = advance.state, left - taken
        return state

    end = reached(0.99 * limit.step)
    assert np.abs(end.u).max() < np.abs(v).max() * end.time
    with pytest.raises(StepFailed):
        reached(1.1 * limit.step)


def test_implicit_damping_settles_as_a_tight_tolerance_says():
    """A run whose dampers would take steps of a microsecond, against the adaptive integrator."""
    asked = scene(damping_time=4e-3)
    runs = [
        simulate(asked, springs(asked), 0.1, integrator=name, every=0.005)
        for name in ("verlet-implicit-damping", "generalised-alpha")
    ]
    one, other = (run.probes["P4"] for run in runs)
    assert np.abs(one - other).max() < 1e-3 * np.abs(other).max()
    gained = runs[0].energies["kinetic"] + runs[0].energies["elastic"] + runs[0].energies["potential"]
    gained = gained + runs[0].energies["dissipated"]
    assert np.abs(gained - gained[0]).max() < 1e-3 * np.abs(runs[0].energies["potential"]).max()
