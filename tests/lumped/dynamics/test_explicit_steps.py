"""Compiled steps of velocity Verlet: the same states and energies as the steps one by one, to rounding."""

import numpy as np
import pytest
from dynamic_cases import make_scene, springs

from lumped import INTEGRATORS, System, build_problem, step_limit
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
    "weight": make_scene(),
    "dampers": make_scene(damping_time=1e-5),
    "masses damped": make_scene(damping_rate=30.0),
    "both damped": make_scene(damping_time=1e-5, damping_rate=30.0),
    "hinged": make_scene(
        supports=[{"edge": "x0", "kind": "hinged"}, {"edge": "y0", "kind": "held", "components": ["z"]}],
        damping_time=1e-5,
    ),
    "loads": make_scene(loads=LOADS, damping_time=1e-5),
    "moved clamp": make_scene(supports=[{**CLAMP, "motion": COURSE}], damping_time=1e-5, damping_rate=30.0),
    "moved corner": make_scene(
        supports=[{"edge": edge, "kind": "hinged", "motion": COURSE} for edge in ("x0", "y0")]
    ),
    "moved hinge": make_scene(supports=[CLAMP, {"edge": "x1", "kind": "hinged", "motion": COURSE}]),
    "turned edge": make_scene(supports=[CLAMP], actuators=[TURNED], damping_time=1e-5),
}


def start_of(scene, n=5):
    calibration = springs(scene, n)
    system = System(scene, build_problem(scene, calibration))
    return system, initial_state(system, calibration, "tributary")


@pytest.mark.parametrize("name", CASES)
def test_compiled_steps_are_the_steps_one_by_one(name):
    system, state = start_of(CASES[name])
    step = 0.8 * step_limit(system, state.u).step
    method = INTEGRATORS["verlet"](system, step)
    compiled = method.march(state, step, STEPS)
    dissipated = work = 0.0
    for _ in range(STEPS):
        advance = method.advance(state, step)
        state = advance.state
        dissipated, work = dissipated + advance.dissipated, work + advance.work
    assert compiled.steps == STEPS and compiled.state.time == state.time
    # rounding of some thirty forces a mass and step, which the stiffest motions keep
    tolerance = 1e3 * STEPS * float(np.finfo(float).eps)
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
        ends.append(INTEGRATORS["verlet"](system, step).march(state, step, STEPS))
    kept, found = ends
    assert np.abs(kept.state.v - found.state.v).max() < 1e-12 * np.abs(kept.state.v).max()
    assert kept.dissipated == pytest.approx(found.dissipated, rel=1e-12)
