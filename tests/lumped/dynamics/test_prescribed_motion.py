"""Edges that move as prescribed, and constraints, step by step: positions, velocities, work and impulses."""

import numpy as np
import pytest
from dynamic_cases import make_scene, run, springs, system
from numpy.testing import assert_allclose
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

import lumped
from lumped.dynamics.integrators import INTEGRATORS

TIME = [0.0, 0.0031, 0.01]  # s, its middle inside a step
LIFTED = [[0.0, 0.0, 0.0], [1e-3, 2e-3, 4e-3], [2e-3, 0.0, -1e-3]]
TURNED = [[0.0, 0.0, 0.0], [0.1, 0.3, -0.1], [0.1, -0.2, 0.2]]


def support(kind, interpolation="smooth", **more):
    motion = {"time": TIME, "displacement": LIFTED, "interpolation": interpolation}
    return {"edge": "x0", "kind": kind, "motion": motion, **more}


MOVED = {
    "clamped": {"supports": [support("clamped")]},
    "clamped, linear": {"supports": [support("clamped", "linear")]},
    "hinged": {"supports": [support("hinged"), {"edge": "x1", "kind": "clamped"}]},
    "held": {"supports": [support("held", components=["z"]), {"edge": "x1", "kind": "clamped"}]},
    "turned": {
        "supports": [{"edge": "x1", "kind": "clamped"}],
        "actuators": [
            {"edge": "x0", "kind": "motion", "time": TIME, "displacement": LIFTED, "rotation": TURNED}
        ],
    },
}


@pytest.mark.parametrize("moved", MOVED)
def test_the_components_that_are_driven_are_those_that_are_put_elsewhere(moved):
    equations, _ = system(make_scene(gravity=False, **MOVED[moved]), n=3)
    places = [equations.prescribed.place(time) for time in (0.0, 0.001, 0.0031, 0.007, 0.01)]
    np.testing.assert_array_equal(equations.prescribed.components, np.ptp(places, axis=0) > 0.0)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", [name for name in INTEGRATORS if name != "esdirk"])
@pytest.mark.parametrize("moved", MOVED)
def test_at_every_step_an_edge_is_where_and_as_fast_as_prescribed(moved, name):
    """All layers of a held director, the mean of the others; in every axis that is held, past a kink."""
    equations, rest = system(make_scene(gravity=False, **MOVED[moved]), n=3)
    states, _ = run(INTEGRATORS[name](equations, 4e-5), rest, 4e-5, 90)
    edge = equations.assembly.lattice.edge_columns("x0")
    arms = equations.assembly.lattice.positions[edge] - [0.0, 0.094, 0.0]
    axes = [2] if moved == "held" else [0, 1, 2]

    def expected(time):
        lift, turn = ([np.interp(time, TIME, c) for c in np.transpose(v)] for v in (LIFTED, TURNED))
        if moved in ("clamped", "hinged", "held"):
            lift = PchipInterpolator(TIME, LIFTED)(time)
        turned = Rotation.from_rotvec(turn).apply(arms.reshape(-1, 3)).reshape(arms.shape)
        return (lift + (turned - arms if moved == "turned" else 0.0 * arms))[..., axes]

    def values_of(field):
        columns = field[edge][..., axes]
        whole = moved.startswith(("clamped", "turned"))
        return columns if whole else np.broadcast_to(columns.mean(axis=1, keepdims=True), columns.shape)

    for state in states:
        assert_allclose(values_of(state.u), expected(state.time), atol=1e-14)
    for state in states[1:]:  # no kink within 1e-6 s of these
        slope = (expected(state.time + 1e-7) - expected(state.time - 1e-7)) / 2e-7
        assert_allclose(values_of(state.v), slope, atol=2e-7)  # rounding, 1e-14 m in 1e-7 s, and a little


@pytest.mark.parametrize("turned", [0.0, 0.4])
def test_a_moved_edge_exerts_what_balances_a_load(turned):
    """A weightless sheet held by the motion alone: force, and moment about where the edge's middle is."""
    pull, motion = np.array([0.01, -0.02, 0.03]), MOVED["turned"]["actuators"][0]
    motion = {**motion, "time": [0.0], "displacement": [[1e-3, 0.0, 2e-3]], "rotation": [[0.1, turned, 0.0]]}
    load = {"kind": "point", "at": [0.188, 0.141], "force": pull.tolist()}  # at a mass
    scene = make_scene(gravity=False, supports=[], actuators=[motion], loads=[load])
    solution = lumped.solve(scene, springs(scene, 5))
    at = np.array([[0.188, 0.141], [0.0, 0.094]])
    loaded, middle = np.column_stack([at, [0.0, 0.0]]) + solution.displacement(at)
    force, moment = np.split(solution.actuators["x0"][0], 2)
    assert_allclose(force, -pull, atol=1e-8)
    assert_allclose(moment, -np.cross(loaded - middle, pull), atol=1e-8 * 0.188)
    assert_allclose(solution.reactions["x0"], force, atol=1e-12)
