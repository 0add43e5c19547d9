"""A lattice for control: poles, step responses, what commands do at rest, and the files with them."""

from dataclasses import replace

import numpy as np
import pytest
from cases import CLAMP, RUBBER, SHEET, with_material
from dynamic_cases import springs
from scipy.io import loadmat
from scipy.signal import lsim

import lumped
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.numerics.eigenmodes import lowest_modes
from sheetbench.scenes import Chain, Clamped, Gravity, Hinged, Pressure, Scene
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.supports import Motion

TAU, RATE = 2e-3, 0.5  # s, 1/s
DAMPED = with_material(scenes.load("two-edges-clamped"), damping_time=TAU, damping_rate=RATE)


@pytest.fixture(scope="module")
def flat():
    return lumped.linearise(DAMPED, springs(DAMPED, 4), "flat")


def test_poles_are_those_of_the_modes_with_their_damping(flat):
    omega = 2.0 * np.pi * lumped.modes(DAMPED, springs(DAMPED, 4), 10, "gregory").frequencies
    drag = TAU * omega**2 + RATE
    wanted = -drag / 2.0 + 1j * np.sqrt(omega**2 - drag**2 / 4.0 + 0j)
    for modes in (None, 12):
        poles = flat.state_space(modes).poles
        nearest = [poles[np.argmin(np.abs(poles - pole))] for pole in wanted]
        np.testing.assert_allclose(nearest, wanted, rtol=1e-8)
        assert len(poles) == 2 * (flat.mass.shape[0] if modes is None else modes)


def test_a_moved_edge_answers_as_the_simulation_does(flat):
    """A ramp of 1e-6 m of the edge, as steps of its rate: the dampers of the edge's cells take part."""
    rise = Motion(time=(0.0, 0.02), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 1e-6)))
    held, probes = (Clamped(edge="x0", motion=rise),), {"P": (0.188, 0.188)}
    scene = Scene(name="shaken", sheet=SHEET, material=DAMPED.material, support=held, probes=probes)
    own = springs(scene, 3)
    history = lumped.simulate(scene, own, 0.05, every=0.001, step=1e-4, integrator="midpoint")
    linear = lumped.linearise(scene, own, "flat")
    space, moved = linear.state_space(None), [linear.inputs.index("x0 z")]
    of_edge = space.a, space.b[:, moved], space.c, space.d[:, moved]
    steps = lsim(of_edge, np.ones(len(history.time)), history.time)[1][:, 2]
    # the ramp is the mean of steps at all moments of it
    fine = np.linspace(0.0, 0.02, 201)
    shifted = [np.interp(history.time - at, history.time, steps, left=0.0) for at in fine]
    weights = np.full(len(fine), 1.0 / 200.0)
    weights[[0, -1]] *= 0.5
    found = 1e-6 * weights @ np.array(shifted)
    u = history.probes["P"][:, 2]
    assert np.abs(found - u).max() < 5e-3 * np.abs(u).max()  # linear between samples a millisecond apart


@pytest.mark.parametrize("edge", ["x1", "x0"])
def test_jacobians_are_slopes_of_statics(edge):
    rod = {"segments": 4, "bending_stiffness": 0.2, "line_density": 0.05, "radius": 1.5e-3, "curvature": 3.0}
    scene = scenes.load("curved-edge")
    if edge == "x1":
        scene = scenes.load("one-edge-clamped").replace(actuators=(Chain(edge="x1", **rod),))
    own, name = springs(scene, 4), f"curvature_{edge}"
    linear = lumped.linearise(scene, own)
    found = linear.jacobian[:, linear.inputs.index(f"{edge} curvature")]
    value, points = parameter(scene, name).value, scene.probe_points()

    def slope(step):
        ends = (lumped.solve(put(scene, name, value + side * step), own) for side in (1.0, -1.0))
        more, less = (end.displacement(points).ravel() for end in ends)
        return (more - less) / (2.0 * step)

    known = (4.0 * slope(0.01) - slope(0.02)) / 3.0  # of steps in 1/m
    np.testing.assert_allclose(found, known, atol=1e-6 * np.abs(known).max())


def test_inputs_at_rest_are_what_statics_do(flat):
    loaded = lumped.linearise(DAMPED, springs(DAMPED, 4))
    more, less = (
        lumped.solve(DAMPED.replace(gravity=Gravity(acceleration=(0.0, 0.0, -9.81 * by))), springs(DAMPED, 4))
        for by in (1.0005, 0.9995)
    )
    points = DAMPED.probe_points()
    slope = (more.displacement(points) - less.displacement(points)).ravel() / 1e-3
    column = loaded.jacobian[:, loaded.inputs.index("gravity")]
    np.testing.assert_allclose(column, slope, atol=1e-5 * np.abs(slope).max())
    # reciprocity; a sheet on one clamp goes where that goes
    at = [loaded.inputs.index(f"{name} f{axis}") for name in DAMPED.probes for axis in "xyz"]
    forced = loaded.jacobian[:, at]
    np.testing.assert_allclose(forced, forced.T, atol=1e-9 * np.abs(forced).max())
    alone = DAMPED.replace(supports=(CLAMP,), gravity=None)
    linear = lumped.linearise(alone, springs(alone, 4))
    moved = linear.jacobian[:, linear.inputs.index("x0 z")].reshape(-1, 3)
    np.testing.assert_allclose(moved, np.tile([0.0, 0.0, 1.0], (len(moved), 1)), atol=1e-7)


def test_few_modes_answer_slow_inputs_exactly_and_others_nearly(flat):
    few, whole = flat.state_space(6), flat.state_space(None)
    np.testing.assert_allclose(few.response(np.array([0.0]))[0].real, flat.jacobian, atol=1e-9)
    column, low = flat.inputs.index("gravity"), np.geomspace(0.1, few.frequencies[2], 20)
    a, b = few.response(low)[:, :, column], whole.response(low)[:, :, column]
    assert np.abs(a - b).max() < 0.02 * np.abs(b).max()


def test_a_chain_moves_as_its_constraints_allow():
    scene = scenes.load("actuated-edge")
    linear = lumped.linearise(scene, springs(scene, 4))
    assert np.linalg.eigvalsh(linear.mass.toarray()).min() > 0.0
    space = linear.state_space(8)
    assert space.poles.real.max() < 0.0 and space.frequencies[0] > 1.0
    assert "x1 curvature" in linear.inputs


def test_what_has_no_linear_form_is_refused():
    blown = Scene(name="b", sheet=SHEET, material=RUBBER, support=(CLAMP,), load=(Pressure(value=1.0),))
    with pytest.raises(BadInput, match="unsymmetric tangents"):
        lumped.linearise(blown, springs(blown, 4))
    with pytest.raises(BadInput, match="nothing stops"):
        free = Scene(name="f", sheet=SHEET, material=RUBBER, support=(Hinged(edge="x0"),))
        lumped.linearise(free, springs(free, 4))
    with pytest.raises(BadInput, match="flat sheet has no actuators"):
        scene = scenes.load("actuated-edge")
        lumped.linearise(scene, springs(scene, 4), "flat")


def test_the_verb_leaves_matrices_for_numpy_and_matlab(kept):
    found = kept("modes state-space")
    document = found.document["state_space"]
    assert len(document["poles"]) == 6 and document["unknowns"] == 36
    arrays, other = dict(np.load(found.folder / "linear.npz")), loadmat(found.folder / "linear.mat")
    assert other["K"].shape == (36, 36) and other["ss_A"].shape == (6, 6)
    assert [str(cell[0]) for cell in other["inputs"].ravel()] == document["inputs"]
    np.testing.assert_array_equal(arrays["ss_D"], other["ss_D"])


def test_few_modes_need_no_dense_matrices(flat, monkeypatch):
    """By Lanczos on the factors of K they are those of dense matrices; what is unstable is refused alike."""
    dense = flat.state_space(6)
    monkeypatch.setattr(lowest_modes, "__defaults__", (*lowest_modes.__defaults__[:-1], 0))
    monkeypatch.setattr("scipy.linalg.eigh", lambda *given, **named: pytest.fail("dense"))
    sparse = flat.state_space(6)
    np.testing.assert_allclose(sparse.frequencies, dense.frequencies, rtol=1e-9)
    at_rest = [one.d - one.c @ np.linalg.solve(one.a, one.b) for one in (sparse, dense)]
    np.testing.assert_allclose(*at_rest, atol=1e-8 * np.abs(flat.jacobian).max())
    with pytest.raises(BadInput, match="not stable"):
        replace(flat, stiffness=-flat.stiffness).state_space(6)
