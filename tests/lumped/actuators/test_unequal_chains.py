"""Chains of unequal mass on opposite faces of an edge: weight, inertia, free fall, momentum."""

import numpy as np
import pytest
from dynamic_cases import make_scene, run, system
from numpy.testing import assert_allclose

from lumped.actuators.chain import BoundChain as LumpedChain
from lumped.dynamics import INTEGRATORS
from lumped.lattice import build
from sheetbench.scenes import Chain, Sheet

LIGHT, HEAVY = 0.02, 0.07  # kg/m
PAIR = [{"face": "top", "line_density": LIGHT}, {"face": "bottom", "line_density": HEAVY}]


def pair_alone(segments):
    """The pair on an edge of length 0.3 m along y, at the heights ±0.007 m."""
    sheet = Sheet(length_x=0.2, length_y=0.3, thickness=0.01)
    both = [
        Chain(edge="x1", segments=segments, bending_stiffness=0.02, radius=2e-3, **member) for member in PAIR
    ]
    lattice = build(sheet, (4, 7, 2), 0.008)
    return LumpedChain(both, ("a", "b"), sheet, lattice, lattice.edge_columns("x1").ravel(), scale=1e3)


@pytest.mark.parametrize("segments", [1, 3, 9])
def test_weight_and_inertia_of_the_pair_are_those_of_two_rods(segments):
    chain = pair_alone(segments)
    light, heavy, height, radius = LIGHT * 0.3, HEAVY * 0.3, 0.007, 2e-3
    points, count = chain.frames.points, chain.frames.coordinates
    weight = chain.weight(np.array([3.0, -2.0, -9.81]))
    assert_allclose(weight[:points].sum(axis=0), (light + heavy) * np.array([3.0, -2.0, -9.81]), rtol=1e-12)
    x = chain.frames.rest
    moment = np.cross(x[:count], weight[:count]).sum(axis=0)  # directors turn, and take moments, as arms do
    at = [np.array([0.2, 0.15, side * height]) for side in (1.0, -1.0)]
    pulls = [mass * np.array([3.0, -2.0, -9.81]) for mass in (light, heavy)]
    assert_allclose(moment, sum(np.cross(a, f) for a, f in zip(at, pulls, strict=True)), rtol=1e-12)
    slender = 0.3**2 / 12.0 + radius**2 / 4.0
    for axis, inertia in (
        ([1.0, 0.0, 0.0], (light + heavy) * (slender + height**2)),
        ([0.0, 1.0, 0.0], (light + heavy) * (radius**2 / 2.0 + height**2)),
        ([0.0, 0.0, 1.0], (light + heavy) * slender),
    ):
        turned = np.zeros((chain.rows, 3))
        turned[:points] = np.cross(axis, x[:points] - x[:points].mean(axis=0))
        turned[points:count] = np.cross(axis, x[points:count])
        assert np.sum(turned * (chain.mass @ turned)) == pytest.approx(inertia, rel=1e-12)


@pytest.mark.parametrize("name", ["generalised-alpha", "midpoint"])
def test_a_free_sheet_with_the_pair_falls_without_bending(name):
    equations, rest = system(make_scene(supports=[], actuators=PAIR), n=4)
    chain = equations.coupling.bodies[0]
    masses, points = equations.assembly.lattice.mass_count, chain.frames.points
    states, _ = run(INTEGRATORS[name](equations, 1e-3), rest, 1e-3, 50)
    fall = -0.5 * 9.81 * states[-1].time ** 2
    expected = np.zeros((masses + chain.frames.coordinates, 3))
    expected[: masses + points, 2] = fall  # every mass and point; the directors stay as they are
    moved = states[-1].u[: len(expected)]
    # every integrator is exact for a constant acceleration
    assert_allclose(moved, expected, atol=1e-9 * abs(fall))


def test_the_pair_keeps_momentum():
    equations, rest = system(make_scene(gravity=False, supports=[], actuators=PAIR), n=4)
    chain = equations.coupling.bodies[0]
    masses, points, count = (
        equations.assembly.lattice.mass_count,
        chain.frames.points,
        chain.frames.coordinates,
    )
    x = np.concatenate([equations.assembly.lattice.positions, chain.frames.rest])
    arms = x[: masses + points]  # what translates; the rest are directors, which only turn
    v = np.zeros_like(rest.u)
    v[: masses + points] = np.array([0.1, 0.2, -0.3]) + np.cross([3.0, -2.0, 5.0], arms)
    v[masses + points : masses + count] = np.cross([3.0, -2.0, 5.0], x[masses + points :])
    start = type(rest)(0.0, rest.u, v, equations.accelerate(equations.unbalanced(rest.u, v, 0.0)))
    states, _ = run(INTEGRATORS["midpoint"](equations, 1e-3), start, 1e-3, 100)
    momenta = [(equations.mass @ state.v.ravel()).reshape(-1, 3) for state in states]
    linear = np.array([p[: masses + points].sum(axis=0) for p in momenta])
    angular = np.array(
        [
            np.cross(x + s.u[: masses + count], p[: masses + count]).sum(axis=0)
            for s, p in zip(states, momenta, strict=True)
        ]
    )
    for kept in (linear, angular):
        assert np.abs(kept - kept[0]).max() < 1e-8 * np.abs(kept[0]).max()
