"""Edges and supports that are moved: without strain where nothing holds; at corners, with what holds them."""

from functools import cache, partial

import numpy as np
import pytest
from cases import CLAMP, GRAVITY, OBLONG, SILICONE, equilibrium, sheet
from numpy.testing import assert_allclose
from rod_cases import chain as rod
from rod_cases import driven

import fem_reference
import lumped
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, Curved, EdgeMotion, Held, Hinged, Scene, Symmetric
from sheetbench.scenes.objects.supports import Motion

WEIGHT = 9.81 * 1200.0 * 0.005 * 0.2 * 0.1
CORNER = (0.2, 0.0)
chain = partial(rod, edge="y0", segments=8, bending_stiffness=0.02, radius=2e-3)


REST = (0.0, 0.0, 0.0)


def motion(edge="x1", displacement=REST, rotation=REST, time=None):
    """At a pose from t = 0 on, or by tables."""
    moved = {"displacement": displacement, "rotation": rotation}
    moved = {key: at if time else (at,) for key, at in moved.items() if not time or at != REST}
    return EdgeMotion(kind="motion", edge=edge, time=time or (0.0,), **moved)


def make_scene(supports, *actuators, gravity=GRAVITY):
    return Scene("corner", OBLONG, SILICONE, gravity, supports, actuators=actuators)


LIFT, PULL, ABOUT_ITSELF = (0.0, 0.0, 0.01), (0.01, 0.0, 0.0), (0.0, 0.3, 0.0)
TOGETHER = (0.0, 0.2, 0.0)  # rad; edge y0's middle is 0.1 m from x1, the axis of x1's turn
FOLLOWS = (0.1 * (1.0 - np.cos(0.2)), 0.0, 0.1 * np.sin(0.2))
COMPATIBLE = {
    "hinged, turned about its own line": ((CLAMP, Hinged(edge="y0")), motion(rotation=ABOUT_ITSELF)),
    "held in z, pulled": ((CLAMP, Held(edge="y0", components=("z",))), motion(displacement=PULL)),
    "clamped, at rest": ((CLAMP, Clamped(edge="y0")), motion()),
    "symmetric, lifted": ((CLAMP, Symmetric(edge="y0")), motion(displacement=LIFT)),
    "symmetric, turned about its own line": ((CLAMP, Symmetric(edge="y0")), motion(rotation=ABOUT_ITSELF)),
    "two motions as one": ((), motion(rotation=TOGETHER), motion("y0", FOLLOWS, TOGETHER)),
}


@cache
def answer(name, model):
    """Of a compatible case: what several tests look at."""
    supports, *actuators = COMPATIBLE[name]
    return equilibrium(make_scene(supports, *actuators), model, (21, 11), (12, 6))


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", COMPATIBLE)
def test_models_agree_where_both_can_be_obeyed(name):
    """Within 1 % of the largest displacement; the moved edge is where it was put, corners included."""
    _, *actuators = COMPATIBLE[name]
    points = np.random.default_rng(3).uniform(0.0, 1.0, (60, 2)) * OBLONG.lengths
    ends = np.array(OBLONG.edge_ends("x1"))
    found = {model: answer(name, model) for model in ("lumped", "shell", "solid")}
    truth = found["shell"].displacement(points)
    for model, solution in found.items():
        assert np.abs(solution.displacement(points) - truth).max() < 0.01 * np.abs(truth).max(), model
        moved = next(a for a in actuators if isinstance(a, EdgeMotion)).displacement[0]
        assert_allclose(solution.displacement(ends), [moved, moved], atol=1e-8 * 0.2, err_msg=model)


@pytest.mark.parametrize("name", ["hinged, turned about its own line", "symmetric, lifted"])
def test_the_plate_is_their_limit_of_small_motions(name):
    supports, one = COMPATIBLE[name]
    small = motion(
        displacement=tuple(1e-4 * np.array(one.displacement[0])),
        rotation=tuple(1e-4 * np.array(one.rotation[0])),
    )
    scene = make_scene(supports, small, gravity=None)
    points = np.random.default_rng(3).uniform(0.0, 1.0, (60, 2)) * OBLONG.lengths
    shell, plate = (equilibrium(scene, model, 0, (12, 6)) for model in ("shell", "plate"))
    truth = shell.displacement(points)
    assert np.abs(plate.displacement(points) - truth)[:, 2].max() < 1e-3 * np.abs(truth).max()
    total = sum(plate.reactions[s.edge] for s in supports) + plate.actuators["x1"][0, :3]
    assert_allclose(total, 0.0, atol=1e-9 * np.abs(plate.actuators["x1"]).max())


def test_wrenches_are_about_the_middle_of_the_moved_edge():
    """Where the middle is now: a free sheet hung from an edge turned by a quarter has no moment about it."""
    scene = make_scene((), motion(displacement=(0.0, 0.03, 0.02), rotation=(0.0, np.pi / 2.0, 0.0)))
    for model in ("lumped", "shell", "solid"):
        wrench = equilibrium(scene, model, (9, 5), (4, 2)).actuators["x1"][0]
        assert_allclose(wrench, [0.0, 0.0, WEIGHT, 0.0, 0.0, 0.0], atol=1e-3 * WEIGHT * 0.2, err_msg=model)


UP = {"time": (0.0, 1.0), "displacement": (REST, LIFT)}
UP_AND_DOWN = {"time": (0.0, 1.0, 2.0), "displacement": (REST, LIFT, REST)}
HINGE = Hinged(edge="y0")
# a turn about the corner itself obeys the hinge as a pose; on the way there the straight line between two
# samples does not
CORNERED = (0.05 * -np.sin(0.4), 0.05 * (np.cos(0.4) - 1.0), 0.0)
TO_THERE = {"time": (0.0, 1.0), "displacement": (REST, CORNERED), "rotation": (REST, (0.0, 0.0, 0.4))}


@pytest.mark.parametrize(
    ("supports", "actuators", "said"),
    [
        ((CLAMP, HINGE), [motion(**UP_AND_DOWN)], "t = 1 s"),  # looked at all the time
        ((CLAMP, HINGE), [motion(time=(0.0, 1.0), rotation=(REST, (2.0 * np.pi, 0, 0)))], r"t = 0\."),
        ((HINGE,), [motion(**TO_THERE)], r"y by 0.000925 m at t = 0\.382 s"),
        ((CLAMP, Clamped(edge="y0")), [motion(**UP_AND_DOWN)], r"z by 0.01 m at t = 1 s"),
        (
            (CLAMP, Clamped(edge="y0", motion=Motion(**UP))),
            [],
            r"clamped support on edge y0 moves .* support on edge x0 holds: z by 0.01 m at t = 1",
        ),
        ((Clamped(edge="y0"),), [motion(displacement=LIFT)], r"moves the corner.*clamped.*y0.*z by 0.01 m"),
        ((Clamped(edge="y1"),), [motion(rotation=ABOUT_ITSELF)], "turns the director.*clamped.*y1"),
        ((Curved(edge="y0", curvature=0.0),), [motion(displacement=PULL)], "curved.*y0.*x by 0.01 m"),
        ((Curved(edge="y0", curvature=2.0),), [motion()], r"rod on edge y0 \(curvature 2 1/m\).*edge x1"),
        (
            (Clamped(edge="y0", tilt=0.1),),
            [motion()],
            r"clamp on edge y0 \(tilt 0.1 rad\) turns the director.*edge x1",
        ),
        ((Hinged(edge="y0"),), [motion(displacement=LIFT)], "hinged.*y0.*z by 0.01 m"),
        ((Hinged(edge="y0"),), [motion(rotation=(0.1, 0.0, 0.0))], "hinged.*y0.*z by 0.00499 m"),
        ((Held(edge="y0", components=("z",)),), [motion(displacement=LIFT)], "held.*y0.*z by 0.01 m"),
        ((Symmetric(edge="y0"),), [motion(displacement=(0.0, 0.01, 0.0))], "symmetric.*y by 0.01 m"),
        ((Symmetric(edge="y0"),), [motion(rotation=(0.1, 0.0, 0.0))], "symmetric.*y0"),
        ((), [motion(), motion("y0", LIFT)], r"motion on edge y0.*motion on edge x1.*z by 0.01 m"),
        ((), [motion("y0", rotation=(0.2, 0.0, 0.0)), motion()], "turns the director.*motion on edge x1"),
        ((), [motion(displacement=LIFT), chain(base="end")], "base.*chain on edge y0.*motion on edge x1"),
        ((), [chain(edge="x0", base="start"), motion("y0", rotation=(0.1, 0, 0))], "base.*chain.*x0"),
    ],
)
def test_what_cannot_both_be_obeyed_is_refused(supports, actuators, said):
    with pytest.raises(ValueError, match=said):
        make_scene(supports, *actuators)


def test_compatible_supports_of_a_corner_are_accepted():
    make_scene((HINGE,), motion("x1", CORNERED, (0.0, 0.0, 0.4)))
    alike, sideways = Motion(**UP), Motion(time=(0.0, 1.0), displacement=(REST, (0.01, 0, 0)))
    make_scene((CLAMP.replace(motion=alike), Clamped(edge="y0", motion=alike)))
    make_scene((CLAMP, Held(edge="y0", components=("z",), motion=sideways)))  # along x it holds nothing


def test_a_support_that_moves_counts_in_statics_where_it_ends():
    """As the edge's motion beside it, which is linear."""
    for course, ends in ((UP_AND_DOWN, REST), (UP, LIFT)):
        moving = Clamped(edge="y0", motion=Motion(**course, interpolation="linear"))
        scene = make_scene((moving,), motion(**course), gravity=None)
        found = lumped.solve(scene, lumped.calibrate(OBLONG, SILICONE, (5, 3)))
        assert_allclose(found.displacement([CORNER, (0.05, 0.05)]), [ends, ends], atol=1e-12)


def test_in_dynamics_too_the_corner_follows_the_motion():
    table = {"time": (0.0, 0.02), "displacement": ((0.0, 0.0, 0.0), PULL)}
    scene = make_scene(
        (CLAMP, Held(edge="y0", components=("z",))), EdgeMotion(kind="motion", edge="x1", **table)
    )
    scene = scene.model_copy(update={"probes": {"corner": CORNER, "far": (0.2, 0.1)}})
    run = lumped.simulate(scene, lumped.calibrate(OBLONG, SILICONE, (5, 3)), 0.02)
    for place in run.probes.values():
        assert_allclose(place[:, 0], 0.5 * run.time, atol=1e-12)
        assert_allclose(place[:, 1:], 0.0, atol=1e-12)


def test_a_tilt_that_a_motion_forbids_is_not_sought():
    from comparisons.identification.unknowns import BadInput, unknown

    scene = make_scene((Clamped(edge="y0"),), motion())
    with pytest.raises(BadInput, match=r"allow no tilt.*x1"):
        unknown(scene, "tilt_y0")
    assert scenes.free_rigid_motions(scene) == []


@pytest.mark.parametrize(("model", "scale"), [("shell", 1.0), ("solid", 1.0), ("plate", 1e-4)])
def test_an_edge_moved_rigidly_takes_a_free_sheet_with_it(model, scale):
    """Without strain; the plate by a small motion, in which nothing is longer to first order."""
    shift, turn = scale * np.array([0.01, -0.02, 0.03]), scale * np.array([0.5, -0.3, 0.2])
    moved = motion("y1", tuple(shift), tuple(turn))
    scene = driven(gravity=None).model_copy(update={"supports": (), "actuators": (moved,)})
    solution = fem_reference.solve(scene, model, elements=3)
    assert solution.status is Status.CONVERGED
    assert sum(solution.energies.values()) < 1e-12 * scale**2
    flat = np.array([[0.0, 0.0, 0.0], [0.188, 0.0, 0.0], [0.0, 0.188, 0.0]])
    corners = flat + solution.displacement(flat[:, :2])
    sides = np.linalg.norm(np.diff(flat, axis=0), axis=1)
    assert np.linalg.norm(np.diff(corners, axis=0), axis=1) == pytest.approx(
        sides, rel=max(1e-9, 1e-8 / scale * (scale < 1))
    )
    np.testing.assert_allclose(solution.displacement([[0.094, 0.188]])[0], shift, atol=1e-12)


def small(*supports, weight=9.81):
    return sheet(0.1, 0.04, 0.002, 1e6, 0.3, 1100.0, weight=weight, supports=supports)


@pytest.mark.parametrize("model", ["lumped", "plate", "shell", "solid"])
def test_sheets_and_all_their_supports_move_as_one(model):
    """The held edge moves in z alone, which is all that it holds: a translation strains nothing."""
    along = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.003, 0.0, 0.004)))
    free_along = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.5, 0.5, 0.004)))
    supports = (Hinged(edge="x0", motion=along), Held(edge="x1", components=("z",), motion=free_along))
    at_rest = (Hinged(edge="x0"), Held(edge="x1", components=("z",)))
    points = np.array([(0.05, 0.02), (0.1, 0.0), (0.02, 0.04)])
    still, moved = (
        equilibrium(small(*held, weight=0.981), model, (11, 5), 2).displacement(points)
        for held in (at_rest, supports)  # by a weight that leaves the plate's slopes below 1
    )
    assert_allclose(moved, still + np.array([0.003, 0.0, 0.004]), atol=1e-8)


def test_a_run_that_settles_ends_where_statics_are():
    """The hinge's corner masses, held by a clamp that moves alike, are moved once."""
    raised = (0.0, 0.0, 0.004)
    rise = Motion(time=(0.0, 0.05), displacement=((0.0, 0.0, 0.0), raised))
    scene = small(Clamped(edge="x0", motion=rise), Hinged(edge="y0", motion=rise)).replace(
        damping_time=0.02, probes={"P": (0.1, 0.04), "corner": (0.0, 0.0)}
    )
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(7, 3), method="consistent")
    run = lumped.simulate(scene, springs, 1.5, every=0.5, integrator="esdirk")
    assert_allclose(run.probes["corner"][-1], raised, atol=1e-12)
    rest = lumped.solve(scene, springs).displacement([(0.1, 0.04)])[0]
    assert_allclose(run.probes["P"][-1], rest, atol=1e-4 * np.abs(rest).max())
