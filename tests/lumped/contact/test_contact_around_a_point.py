"""Contact around a point: integral over a patch, curved surface of a lattice, balls pressed into it."""

import numpy as np
import pytest
from cases import equilibrium
from contact_cases import on_lattice, pressed_ball

import fem_reference
import lumped
from lumped.cell_surface import middle
from lumped.patch import integrate
from lumped.statics.solver import build_problem
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import PointLoad

PLACES = np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0])


@pytest.mark.parametrize(("depth", "a", "b", "x", "y"), [
    (0.01, 1.0, 0.5, 0.3, -0.1), (1e-3, 1.0, 0.2, 0.9, 0.99), (1e-3, 0.2, 1e-4, 0.3, 0.2),
    (0.3, 1.0, 0.5, 1.2, -0.9),
])  # fmt: skip
@pytest.mark.parametrize("turned", [0.0, 0.7])
@pytest.mark.parametrize("power", [2, 3])
def test_integral_over_a_patch_has_its_derivatives(depth, a, b, x, y, turned, power):
    """Of an ellipse within a cell, at its corner, around a place outside it, and of a line across it."""
    u, v = PLACES[0] - x, PLACES[1] - y
    u, v = np.cos(turned) * u + np.sin(turned) * v, np.cos(turned) * v - np.sin(turned) * u
    q, step = (depth - a * u**2 - b * v**2).ravel(), np.random.default_rng(1).normal(size=9)
    k = np.linspace(1.0, 2.0, 9)[None]
    _, load, slope, deepest = integrate(q[None], k, power, True)
    h = 1e-5 * depth
    ends = [integrate((q + sign * h * step)[None], k, power, False) for sign in (1.0, -1.0)]
    along = [(up - down)[0] / (2 * h) for up, down in zip(*ends, strict=True)]
    assert along[0] == pytest.approx(float(load[0] @ step), abs=1e-8 * np.linalg.norm(load) * 3.0)
    assert along[1] == pytest.approx(slope[0] @ step, abs=1e-6 * np.linalg.norm(slope))
    assert deepest[0] <= depth * (1.0 + 1e-9)
    if max(abs(x), abs(y)) + np.sqrt(depth / min(a, b)) < 1.0 and power == 2:  # the whole ellipse
        even = integrate(q[None], np.ones((1, 9)), power, False)[0][0]
        assert even == pytest.approx(np.pi * depth**3 / (6.0 * np.sqrt(a * b)), rel=1e-8)


def test_parts_of_cells_are_as_many_on_both_sides_of_a_round_radius():
    """As a derivative by the radius takes them; a cell's side is 4 of the R/3 that a part may have."""
    side = 0.16 / 8
    for near in (1.0 - 1e-8, 1.0 + 1e-8):
        scene = pressed_ball((0.07, 0.07), 4e-3, 0.75 * side * near)
        problem = build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=9))
        assert problem.contacts[0].groups.shape == (16, 9)


def test_what_an_answer_has_at_points_is_on_the_surface_that_touches():
    """Its derivatives are those of it, forwards and backwards; on a flat sheet's cells it is the bilinear."""
    at = np.array([[0.0733, 0.0867], [0.08, 0.08], [0.16, 0.03], [0.0, 0.16], [0.091, 0.07]])
    scene = pressed_ball((0.0733, 0.0867), 4e-3)
    problem = build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(7, 8, 2)))
    rng, lattice, h = np.random.default_rng(2), problem.assembly.lattice, 1e-6
    u, step = 1e-2 * rng.normal(size=(2, *problem.loads.dead.shape))
    ends = [middle(lattice, at, u + sign * h * step, curved=True)[0] for sign in (1.0, -1.0)]
    _, change = middle(lattice, at, u, curved=True)
    along, weights = (ends[0] - ends[1]) / (2 * h), rng.normal(size=(len(at), 3))
    assert change.of(step) == pytest.approx(along, abs=1e-8 * np.abs(along).max())
    back = float((change.shared(weights, len(u)) * step).sum())
    assert back == pytest.approx(float((weights * along).sum()), rel=1e-7)
    shift = np.array([0.0, 0.01, 0.02])
    moved, _ = middle(lattice, at, np.broadcast_to(shift, u.shape), curved=True)
    assert np.abs(moved - shift).max() < 1e-15


def test_a_lattice_as_a_function_has_that_surface_at_points_and_no_matrix_to_it():
    at = np.array([[0.0733, 0.0867], [0.08, 0.08], [0.16, 0.03]])
    scene = pressed_ball((0.0733, 0.0867), 4e-3)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(7, 8, 2))
    sheet, answer = lumped.Differentiable(scene, springs), lumped.solve(scene, springs)
    u, (found, surface) = sheet.solve({}), sheet.surface(at)
    assert found == pytest.approx(answer.displacement(at), abs=1e-9 * np.abs(found).max())
    weights = np.random.default_rng(2).normal(size=(3, 3))
    by = sheet.pullback(surface.shared(weights, len(u)))["cells.young"]
    expected = answer.sensitivity().at_points(at, weights)["cells.young"]
    assert by == pytest.approx(expected, abs=1e-6 * np.abs(by).max())
    with pytest.raises(BadInput, match="curved"):
        sheet.at(at)


@pytest.mark.parametrize(("model", "side"), [("lumped", 9), ("lumped", 10), ("shell", 8)])
@pytest.mark.parametrize("at", [(0.08, 0.08), (0.0733, 0.0867)])
def test_sheet_over_a_ball_is_where_the_ball_is(model, side, at):
    """Of 4 mm a point sinks in by 4 µm; on cubics through masses and on the elements' own surface it was up
    to 190 µm inside."""
    scene = pressed_ball(at, 4e-3)
    solution = equilibrium(scene, model, (side, side), side)
    line, ball = 1e-3 * np.linspace(-3.0, 3.0, 31), scene.obstacles[0]
    around = np.array(at) + np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
    places = np.pad(around, ((0, 0), (0, 1))) + solution.displacement(around)
    away = np.linalg.norm(places - ball.place(), axis=1).min()
    assert away == pytest.approx(ball.radius + 1e-3, abs=6e-6)


def test_contact_under_a_mass_is_the_lattice_under_its_force():
    """A ball adds no error of its own: 4 mm take 3 % too little force on 9 masses, as they do without it."""
    scene = pressed_ball((0.08, 0.08), 4e-3)
    pressed, centre = on_lattice(scene, (9, 9, 2)), [(0.08, 0.08)]
    dead = PointLoad(at=(0.08, 0.08), force=(0.0, 0.0, pressed.reactions["obstacle 1"][2]))
    loaded = on_lattice(scene.replace(obstacles=(), loads=(dead,)), (9, 9, 2))
    assert loaded.displacement(centre) == pytest.approx(pressed.displacement(centre), rel=1e-4, abs=1e-9)


@pytest.mark.parametrize("rise", [1.5e-3, 4e-3])
@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_modes_do_not_lead_into_the_ball(model, rise):
    """At the point that touches, to its stiffness; cubics through masses moved 2 to 4 % of a mode into it."""
    scene, at = pressed_ball((0.0733, 0.0867), rise), np.array([[0.0733, 0.0867]])
    if model == "lumped":
        springs = lumped.calibrate(scene.sheet, scene.material, grid=(10, 10, 2))
        found = lumped.modes(scene, springs, 3, about="deformed")
    else:
        found = fem_reference.modes(scene, "shell", elements=8, count=3, about="deformed")
    most = np.abs(found.shapes).max(axis=(1, 2))
    assert (np.abs(found.displacement(at)[:, 0, 2]) < 4e-3 * most).all()


@pytest.mark.parametrize("at", [(0.08, 0.08), (0.0733, 0.0867)])
def test_a_linear_system_beside_a_ball_is_the_derivative_of_the_residual(at):
    """Its stiffness against the residual's differences, its frequencies against modes, and its answer to both
    edges moved along z against the ball moved the other way."""

    def pressed(rise):
        held, probes = pressed_ball(at, rise).supports[:2], {"P": at, "Q": (0.03, 0.05)}
        return pressed_ball(at, rise).replace(supports=held, probes=probes)

    scene, h = pressed(1.5e-3), 3e-9
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(9, 8, 2))
    linear, problem = lumped.linearise(scene, springs), build_problem(scene, springs)
    step = np.random.default_rng(4).normal(size=linear.stiffness.shape[0])
    ends = [linear.displacement + sign * h * problem.expand(step) for sign in (1.0, -1.0)]
    high, low = (problem.reduce(problem.internal(u, 1.0)[1]) for u in ends)
    along = (high - low) / (2 * h)
    assert np.linalg.norm(linear.stiffness @ step - along) < 1e-7 * np.linalg.norm(along)
    found = lumped.modes(scene, springs, 4, "gregory", about="deformed").frequencies
    assert linear.state_space(4).frequencies == pytest.approx(found, rel=1e-6)
    edges = [linear.inputs.index(f"{edge} z") for edge in ("x0", "x1")]
    lifted = linear.jacobian[:, edges].sum(axis=1)
    less, more = (lumped.solve(pressed(rise), springs) for rise in (1.499e-3, 1.501e-3))
    points = scene.probe_points()
    change = (more.displacement(points) - less.displacement(points)).ravel() / 2e-6
    assert lifted == pytest.approx(np.tile([0.0, 0.0, 1.0], 2) - change, abs=1e-5)


@pytest.mark.parametrize(("at", "rigid"), [((0.08, 0.08), 7.400e-4), ((0.0733, 0.0867), 7.535e-4)])
@pytest.mark.parametrize("side", [9, 10, 17])
def test_ball_is_felt_wherever_masses_are(at, rigid, side):
    """By 0.15 mm; force of Navier's series, to the give of a point contact, √(F/πkR) ≈ 0.4 µm of 150."""
    solution = on_lattice(pressed_ball(at, 1.5e-4), (side, side, 2))
    assert solution.status is Status.CONVERGED
    assert solution.reactions["obstacle 1"][2] == pytest.approx(rigid, rel=0.03)
    assert solution.displacement([at])[0, 2] == pytest.approx(1.5e-4, rel=4e-3)


def test_residuals_of_rounding_under_a_ball_are_known_as_such():
    """Directors lift the middle of a cell of 15 layer distances: 1e-11 of the load was asked, and rounding
    left 3e-11 for 1 949 factorisations."""
    solution = on_lattice(pressed_ball((0.08, 0.08), 1.5e-3), (10, 10, 2))
    assert solution.status is Status.CONVERGED
    assert solution.iterations <= 20
