"""Values over time, and where bent, tilted and moved edges are, against formulas written another way."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.interpolate import PchipInterpolator
from scipy.spatial.transform import Rotation

from sheetbench.scenes import Chain, Clamped, CurvatureTable, Curved, EdgeMotion, Sheet, Symmetric
from sheetbench.scenes.meaning.kinematics import UP, MovedEdge, TurnedEdge, bent_or_tilted
from sheetbench.scenes.objects.tables import PiecewiseCurve

SHEET = Sheet(length_x=0.3, length_y=0.2, thickness=0.003)
TIME, DISPLACEMENT = (0.1, 0.5, 0.7), ((0.0, 0.01, 0.0), (0.02, 0.0, -0.01), (0.0, 0.0, 0.03))
TURNS = ((0.0, 0.0, 0.0), (0.4, -0.9, 0.3), (0.4, 1.1, -2.0))
MOTION = EdgeMotion(kind="motion", edge="x1", time=TIME, displacement=DISPLACEMENT, rotation=TURNS)
HEIGHT = np.array([0.0, 1.5e-3, -1.5e-3, 0.02])


def on_edge(edge):
    start, end = np.array(SHEET.edge_ends(edge))
    return start + np.array([[0.0], [0.25], [0.6], [1.0]]) * (end - start)


def test_values_over_time_are_linear_between_samples_and_constant_outside():
    course = PiecewiseCurve((1.0, 2.0, 4.0), ((0.0, 1.0), (2.0, 1.0), (2.0, -3.0)))
    assert_allclose([course.at(t) for t in (0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0)],
                    [(0, 1), (0, 1), (1, 1), (2, 1), (2, -1), (2, -3), (2, -3)])  # fmt: skip
    assert_allclose(course.at(), (2.0, -3.0))


def test_slopes_are_those_from_a_moment_on_and_rounding_misses_none():
    course = PiecewiseCurve((1.0, 2.0, 4.0), (0.0, 2.0, -2.0))
    found = [
        course.slope(t) for t in (0.5, 1.0, np.nextafter(1.0, 0.0), 1.5, 2.0, np.nextafter(2.0, 0.0), 4.0)
    ]
    assert_allclose(found, [0.0, 2.0, 2.0, 2.0, -2.0, -2.0, 0.0])
    assert PiecewiseCurve((3.0,), (7.0,)).slope(3.0) == 0.0 and PiecewiseCurve((3.0,), (7.0,)).at(9.0) == 7.0


@pytest.mark.parametrize("curvature", [0.0, 1e-9, 4.0, -7.0])
def test_a_bent_edge_lies_on_an_arc_about_the_middle_of_its_own(curvature):
    """κ → 0 from numbers whose 1 − cos has no digits left: the parabola κ s²/2."""
    support = Curved(edge="x0", curvature=curvature)
    points, displaced = on_edge("x0"), TurnedEdge(support, (support,), SHEET).displaced(on_edge("x0"))
    s = points[:, 1] - 0.1
    if abs(curvature) > 1e-6:
        arc = np.column_stack(
            [0.0 * s, np.sin(curvature * s) / curvature - s, (1 - np.cos(curvature * s)) / curvature]
        )
    else:
        arc = np.column_stack([0.0 * s, 0.0 * s, 0.5 * curvature * s**2])
    assert_allclose(displaced.displacement, arc, atol=1e-17 + 1e-14 * np.abs(arc).max())
    normal = np.column_stack([0.0 * s, -np.sin(curvature * s), np.cos(curvature * s)])
    assert_allclose(UP + displaced.director, normal, atol=1e-15)


def test_on_a_plane_of_symmetry_a_rod_has_its_middle():
    supports = (Curved(edge="x0", curvature=3.0), Symmetric(edge="y1"))
    displaced = bent_or_tilted(supports, SHEET)[0].displaced(on_edge("x0"))
    assert_allclose(displaced.displacement[-1], 0.0, atol=1e-18)
    assert displaced.displacement[0, 2] == pytest.approx((1.0 - np.cos(0.6)) / 3.0, rel=1e-13)


@pytest.mark.parametrize("edge", ["x0", "x1", "y0", "y1"])
def test_beyond_a_tilted_clamp_the_sheet_would_go_up(edge):
    displaced = TurnedEdge(Clamped(edge=edge, tilt=0.3), (), SHEET).displaced(on_edge(edge), 0.5)
    outward = {"x0": (-1, 0), "x1": (1, 0), "y0": (0, -1), "y1": (0, 1)}[edge]
    director = [-np.sin(0.15) * outward[0], -np.sin(0.15) * outward[1], np.cos(0.15)]
    assert_allclose(UP + displaced.director, np.tile(director, (len(HEIGHT), 1)), atol=1e-15)
    assert_allclose(displaced.lifted(HEIGHT), HEIGHT[:, None] * (np.array(director) - UP), atol=1e-17)


@pytest.mark.parametrize("time", [0.0, 0.1, 0.23, 0.69, 2.0, None])
def test_a_moved_edge_is_a_rigid_bar(time):
    points, share = on_edge("x1"), 0.7
    d, theta = (
        np.array(v[-1]) if time is None else np.array([np.interp(time, TIME, c) for c in np.transpose(v)])
        for v in (DISPLACEMENT, TURNS)
    )
    arms = np.column_stack([points - [0.3, 0.1], HEIGHT])
    expected = share * d + Rotation.from_rotvec(share * theta).apply(arms) - arms
    assert_allclose(
        MovedEdge(MOTION, SHEET).displaced(points, share, time).lifted(HEIGHT), expected, atol=1e-16
    )


@pytest.mark.parametrize("time", [0.05, 0.1, 0.3, 0.6, 0.9])
def test_the_velocity_of_a_moved_edge_is_its_derivative(time):
    """One-sided differences of second order: h² of the third derivative, and rounding over h."""
    edge, points, h = MovedEdge(MOTION, SHEET), on_edge("x1"), 1e-5
    now, soon, later = (edge.displaced(points, time=time + k * h).lifted(HEIGHT) for k in range(3))
    assert_allclose(
        edge.velocity(points, HEIGHT, time), (4.0 * soon - 3.0 * now - later) / (2.0 * h), atol=1e-8
    )


@pytest.mark.parametrize(
    "edge",
    [
        TurnedEdge(Curved(edge="x1", curvature=5.0), (), SHEET),
        TurnedEdge(Clamped(edge="x1", tilt=-0.8), (), SHEET),
        MovedEdge(MOTION, SHEET),
    ],
)
def test_the_linear_change_is_the_derivative_by_the_load_factor(edge):
    points, h = on_edge("x1"), 1e-4
    up, down = edge.displaced(points, h), edge.displaced(points, -h)
    displacement, director = edge.linear(points)
    assert_allclose((up.displacement - down.displacement) / (2.0 * h), displacement, atol=1e-8)
    assert_allclose((up.director - down.director) / (2.0 * h), director, atol=1e-7)


def test_curvatures_are_told_joint_by_joint_whatever_they_are_given_as():
    def chain(curvature, segments=4, base="free"):
        return Chain(edge="x0", segments=segments, bending_stiffness=1.0, line_density=1.0, radius=1e-3,
                     curvature=curvature, base=base)  # fmt: skip

    assert_allclose(chain(2.0).curvatures().at(5.0), [2.0, 2.0, 2.0])
    assert_allclose(chain((1.0, 2.0, 3.0)).curvatures().at(), [1.0, 2.0, 3.0])
    table = chain(CurvatureTable(time=(0.0, 2.0), value=(1.0, 5.0)), base="start").curvatures()
    assert_allclose(table.at(0.5), [2.0] * 4)
    assert_allclose(table.at(), [5.0] * 4)
    assert_allclose(chain(3.0, segments=1).curvatures().at(), [3.0])
    assert_allclose(chain((), segments=1).curvatures().at(), [0.0])


def test_a_smooth_course_is_scipys_and_its_derivatives_are_its_slopes():
    """Constant outside; one slope from either side at an inner sample, none beyond the ends."""
    time, values = (1.0, 2.0, 4.0, 5.0), ((0.0, 1.0), (2.0, 1.0), (3.0, 1.5), (3.0, -3.0))
    course, scipys = PiecewiseCurve(time, values, "smooth"), PchipInterpolator(time, values)
    at = np.linspace(1.01, 4.99, 37)
    assert_allclose(course.at(at), scipys(at), atol=1e-15)
    assert_allclose(course.slope(at), scipys(at, 1), atol=1e-14)
    assert_allclose(course.bend(at), scipys(at, 2), atol=1e-14)
    assert_allclose(course.slope(2.0), course.slope(2.0, before=True), atol=1e-14)
    assert_allclose(course.at(np.array([0.0, 9.0])), [values[0], values[-1]])
    assert_allclose([course.slope(0.5), course.slope(5.0), course.bend(7.0)], 0.0)
    assert_allclose(course.slope(5.0, before=True), scipys(5.0, 1))


def test_a_smooth_course_does_not_overshoot_and_rests_where_samples_are_equal():
    course = PiecewiseCurve((0.0, 0.1, 0.5, 0.6), (0.0, 3.0, 3.0, 0.0), "smooth")
    between = course.at(np.linspace(0.0, 0.6, 301))
    assert between.max() == 3.0 and between.min() == 0.0
    assert_allclose(course.at(np.linspace(0.1, 0.5, 9)), 3.0)


def test_a_table_of_two_samples_is_a_line_either_way():
    at = np.linspace(-0.1, 0.3, 9)
    assert_allclose(
        PiecewiseCurve((0.0, 0.2), (1.0, 3.0), "smooth").at(at), PiecewiseCurve((0.0, 0.2), (1.0, 3.0)).at(at)
    )


@pytest.mark.parametrize("span", [1e-9, 1.0, 1e6])
def test_a_slope_does_not_depend_on_the_unit_of_time(span):
    """A table of nanoseconds had the next piece's slope half a piece early."""
    table = PiecewiseCurve([0.0, 0.5 * span, span], [0.0, 1.0, 0.0])
    assert table.slope(0.25 * span) == pytest.approx(2.0 / span)
    assert table.slope(0.5 * span * (1.0 - 1e-12)) == pytest.approx(-2.0 / span)  # a sum of steps
