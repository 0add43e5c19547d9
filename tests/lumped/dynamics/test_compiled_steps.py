"""Implicit steps done by one compiled call: the same states as call by call, to the iteration's tolerance."""

import numpy as np
import pytest
from dynamic_cases import ROD, make_scene, run, system

from lumped.dynamics import INTEGRATORS, State
from lumped.dynamics.implicit.compiled_newton import compiled_of
from lumped.dynamics.integrator import LatticeSamples
from lumped.dynamics.runs.observer import LatticeObserver
from sheetbench import scenes

HINGED = [{"edge": "x0", "kind": "hinged"}, {"edge": "x1", "kind": "held", "components": ["z"]}]
MOVED = [
    {"edge": "x0", "kind": "clamped", "motion": {"time": [0, 1], "displacement": [[0, 0, 0], [0, 0, 1]]}}
]
GROWING = [
    {"kind": "edge", "edge": "x1", "force_per_length": [0.0, 0.0, 5.0],
     "history": {"time": [0.0, 0.012], "factor": [0.0, 1.0]}},
]  # fmt: skip
TABLE = scenes.DamperSet.model_validate({"axial": 0.3, "vertical": 1.0, "cross": {"x": 0.2, "y": 0.1}})
CASES = {
    "dampers in proportion": make_scene(damping_time=1e-3),
    "dampers of a table, and of masses": make_scene(damping_rate=3.0).replace(dampers=TABLE),
    "air": make_scene().replace(air=scenes.Air(drag=100.0)),
    "supports that hold means": make_scene(supports=HINGED),
    "a load that grows": make_scene("one-edge-clamped", loads=GROWING, gravity=False, damping_time=1e-3),
    "a moving support": make_scene("one-edge-clamped", supports=MOVED, damping_time=1e-3),
}


@pytest.mark.parametrize("name", ["generalised-alpha", "esdirk"])
@pytest.mark.parametrize("scene", CASES.values(), ids=CASES)
def test_the_compiled_iteration_takes_the_steps_of_the_general_one(scene, name):
    equations, rest = system(scene, 4)
    ends = []
    for compiled in (True, False):
        method = INTEGRATORS[name](equations, 1e-3)
        assert method._newton._compiled is not None
        if not compiled:
            method._newton._compiled = None
        states, dissipated = run(method, rest, 1e-3, 12)
        ends.append((states[-1], dissipated))
    (one, lost), (other, spent) = ends
    # both stop at corrections below 1e-11 of the side, kept factors shrinking them by 5 or more a time
    size = equations.problem.size
    np.testing.assert_allclose(one.u, other.u, rtol=0.0, atol=1e-9 * size)
    np.testing.assert_allclose(lost, spent, rtol=1e-5, atol=1e-15)
    assert np.abs(one.u).max() > 1e-4 * size


FOLLOWING = make_scene(
    loads=[{"kind": "pressure", "value": 1.0}, {"kind": "edge", "edge": "x1", "moment_per_length": 0.01}]
)


@pytest.mark.parametrize("scene", [*CASES.values(), FOLLOWING], ids=[*CASES, "loads that follow"])
def test_the_compiled_sample_is_the_general_one(scene):
    equations, _ = system(scene, 4)
    drawn = np.random.default_rng(0).standard_normal((3, *equations.lattice_mass.shape, 3))
    state = State(0.3, *(np.array([1e-3, 0.1, 10.0])[:, None, None] * drawn))
    sampling = LatticeObserver(equations)
    one = LatticeSamples.of(state, 0.1, 0.2)
    parts = [np.concatenate([part, 2.0 * part]) for part in one if not isinstance(part, list)]
    samples = LatticeSamples(*parts[:4], [None] * 2, *parts[4:])
    rows = sampling.rows(samples)
    assert sampling._observed is not None
    sampling._observed = None
    np.testing.assert_allclose(rows, sampling.rows(samples), rtol=1e-11, atol=1e-13)


@pytest.mark.parametrize(
    "scene",
    [
        make_scene("one-edge-clamped", actuators=[ROD]),
        make_scene("one-edge-clamped", loads=[{"kind": "pressure", "value": 1.0}]),
    ],
)
def test_chains_and_followers_are_solved_call_by_call(scene):
    assert compiled_of(system(scene, 4)[0]) is None
