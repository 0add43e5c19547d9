"""Actuators: the chain alone (triad, mass, elastica), bound to a sheet in statics and dynamics."""

import numpy as np
import pytest
import scipy.sparse as sp
from dynamic_cases import make_scene, run, system
from lattice_cases import SHEET, derivative
from numpy.testing import assert_allclose

import lumped
from lumped.actuators import Drive
from lumped.actuators.chain import BoundChain
from lumped.dynamics import INTEGRATORS
from lumped.lattice import build
from sheetbench.numerics.saddle_point import CORRECTIONS, minimal_residual
from sheetbench.scenes import Chain

LATTICE = build(SHEET, (4, 7, 2), 0.008)
ROD = dict(edge="x1", segments=4, bending_stiffness=0.02, line_density=0.05, radius=2e-3)
PLANES, BASES = ("normal", "inplane", "spatial"), ("free", "start", "middle", "end")


ENDS = {base: (base,) for base in BASES} | {
    "held at the start": ("free", (0,)),
    "held at the end": ("free", (1,)),
    "held and shared": ("free", (0,), {1: True}),
    "shared": ("free", (), {0: True, 1: False}),
    "based and shared": ("middle", (), {0: True, 1: False}),
}


def chain_of(*ends, base="free", **common):
    return bound([Chain(**{**ROD, **common, "base": base})], *ends)


def bound(rods, *ends):
    masses = LATTICE.edge_columns("x1").ravel()
    return BoundChain(rods, ("a", "b")[: len(rods)], SHEET, LATTICE, masses, 1e3, *ends)


def disturbed(chain, size=5e-3, seed=0):
    return np.where(chain.free, size * np.random.default_rng(seed).standard_normal((chain.rows, 3)), 0.0)


# a middle is a segment's or a joint
@pytest.mark.sweep(4)
@pytest.mark.parametrize(
    ("end", "segments"), [*((end, 3) for end in ENDS), ("middle", 4), ("based and shared", 4)]
)
@pytest.mark.parametrize("plane", PLANES)
def test_chain_force_and_tangents_are_derivatives(plane, end, segments):
    base, *ends = ENDS[end]
    chain = chain_of(*ends, plane=plane, base=base, segments=segments, curvature=3.0, damping_time=0.1)
    y, v, drive = disturbed(chain), disturbed(chain, seed=1), Drive(0.7)
    frames, length = chain.frames, chain.frames.length

    def lagrangian(z):
        residual = chain.force(z, drive)[1][frames.coordinates :]
        return chain.force(z, drive)[0] + np.sum(z[frames.coordinates :] * residual)

    force, tangent = chain.force(y, drive)[1], chain.tangent(y, drive).reshape(y.size, y.size)
    scale = 1e3 * length
    assert_allclose(derivative(lagrangian, y).ravel(), force.ravel(), atol=1e-7 * scale)
    numeric = derivative(lambda z: chain.force(z, drive)[1], y)
    assert_allclose(numeric, tangent, atol=1e-7 * np.abs(tangent).max())
    assert_allclose(tangent, tangent.T, atol=1e-13 * np.abs(tangent).max())
    outside = ~np.repeat(np.repeat(chain.pairs, 3, axis=0), 3, axis=1)
    assert not tangent[outside].any() and not chain.mass[~chain.pairs].any()
    power, damping = chain.damping_force(y, v)
    assert power == pytest.approx(np.sum(damping * v)) and power > 0.0
    by_velocity = chain.damping_tangent(y).reshape(y.size, y.size)
    assert not by_velocity[outside].any()
    assert_allclose(by_velocity @ v.ravel(), damping.ravel(), atol=1e-10 * np.abs(damping).max())


def test_antagonistic_chains_with_opposite_commands_leave_the_sheet_flat():
    pair = [{"curvature": 4.0, "face": "top"}, {"curvature": -4.0, "face": "bottom"}]
    scene = make_scene("one-edge-clamped", pair, gravity=False)
    flat = lumped.solve(scene)
    one = lumped.solve(make_scene("one-edge-clamped", pair[:1], gravity=False))
    points = scene.probe_points()
    assert np.abs(one.displacement(points)).max() > 1e-3
    assert np.abs(flat.displacement(points)).max() < 1e-12
    assert set(flat.actuators) == {"x1.1", "x1.2"}


def test_actuators_that_cannot_act_together_are_refused():
    chain = {"curvature": 4.0}
    for actuators, said in (
        ([{**chain, "edge": "x0"}], "edge x0 has a support"),
        ([chain, {**chain, "segments": 7}], "segments = 8 and 7"),
        ([chain, {"kind": "motion", "edge": "x1", "time": [0.0], "rotation": [[0.0, 0.1, 0.0]]}], "another"),
        ([{"curvature": [1.0, 2.0]}], "have 7 joints"),
        ([{"kind": "motion", "edge": "x1", "time": [0.0]}], "needs displacement"),
    ):
        with pytest.raises(ValueError, match=said):
            make_scene("one-edge-clamped", actuators)


LIGHT, HEAVY = 0.02, 0.07  # kg/m
PAIR = [{"face": "top", "line_density": LIGHT}, {"face": "bottom", "line_density": HEAVY}]


@pytest.mark.parametrize("segments", [1, 3, 9])
def test_weight_and_inertia_of_the_pair_are_those_of_two_rods(segments):
    chain = bound([Chain(**{**ROD, "segments": segments, **member}) for member in PAIR])
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
    masses = equations.assembly.lattice.mass_count
    points, count = chain.frames.points, chain.frames.coordinates
    x = np.concatenate([equations.assembly.lattice.positions, chain.frames.rest])
    arms = x[: masses + points]  # what translates; the rest are directors, which only turn
    v = np.zeros_like(rest.u)
    v[: masses + points] = np.array([0.1, 0.2, -0.3]) + np.cross([3.0, -2.0, 5.0], arms)
    v[masses + points : masses + count] = np.cross([3.0, -2.0, 5.0], x[masses + points :])
    start = type(rest)(0.0, rest.u, v, equations.accelerate(equations.unbalanced(rest.u, v, 0.0)))
    states, _ = run(INTEGRATORS["midpoint"](equations, 1e-3), start, 1e-3, 100)
    momenta = [(equations.mass @ state.v.ravel()).reshape(-1, 3) for state in states]
    linear = np.array([p[: masses + points].sum(axis=0) for p in momenta])
    those = slice(masses + count)
    turning = [np.cross(x + s.u[those], p[those]) for s, p in zip(states, momenta, strict=True)]
    for kept in (linear, np.sum(turning, axis=1)):
        assert np.abs(kept - kept[0]).max() < 1e-8 * np.abs(kept[0]).max()


def test_nearly_dependent_constraints_take_a_few_corrections():
    """Factors of a matrix close by miss three eigenvalues by a factor of 40: plain refinement gains a digit
    in some ninety steps, minimal residuals take a step for each."""
    draw = np.random.default_rng(0)
    n = 60
    own, _ = np.linalg.qr(draw.standard_normal((n, n)))
    eigenvalues = np.linspace(1.0, 2.0, n)
    close_by = eigenvalues.copy()
    close_by[[5, 20, 40]] *= 40.0
    matrix, b = sp.csc_array(own @ np.diag(eigenvalues) @ own.T), draw.standard_normal(n)
    calls = []

    def solve(right):
        calls.append(1)
        return own @ ((own.T @ right) / close_by)

    x, miss = minimal_residual(matrix, solve, b)
    assert miss < 1e-14
    assert len(calls) <= 6 < CORRECTIONS
    np.testing.assert_allclose(matrix @ x, b, atol=1e-13 * np.abs(b).max())
    assert minimal_residual(matrix, solve, np.zeros(n))[1] == 0.0
