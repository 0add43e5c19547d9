"""Contact of the lattice: derivatives, closed forms at rest, what is never walked through."""

import sys

import numpy as np
import pytest
import scipy.sparse as sp
from cases import equilibrium
from contact_cases import (
    CYLINDER_TIP,
    OBSTACLES,
    THICKNESS,
    WEIGHT,
    bent_elastica,
    bent_over,
    curled_sheet,
    draped_quarter,
    heavy_elastica,
    laid_strip,
    lying_quarter,
    on_lattice,
    pressed_ball,
    rocking_frequency,
)
from drawn_obstacles import faults_of
from scipy.optimize import fsolve

import fem_reference
import lumped
from lumped.actuators import Drive
from lumped.statics.solver import build_problem
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, Motion, Plane, SceneError, Sphere
from sheetbench.scenes.objects.grading import Grading

TOUCHED = {**OBSTACLES, "rubbing": OBSTACLES["cylinder"].replace(friction=0.3, contact_damping=2.0)}


def clamp(solution):
    """A clamp's share of the weight and its M/w [m²]: of the moments of its forces, and w l²/12 of its cell,
    that weight lumped at masses leaves out."""
    mesh, reaction = solution.mesh, solution.mesh.point_data["reaction"]
    cell = np.unique(mesh.points[:, 0])[1]
    return solution.reactions["x0"][2] / WEIGHT, cell**2 / 12.0 - float(
        mesh.points[:, 2] @ reaction[:, 0]
    ) / WEIGHT


@pytest.fixture(params=TOUCHED)
def item(request):
    scene = laid_strip(0.1, obstacles=(TOUCHED[request.param],))
    problem = build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=(11, 4, 2)))
    rng = np.random.default_rng(1)
    u = 0.01 * rng.normal(size=problem.loads.dead.shape) - [0.0, 0.0, 0.02]
    return problem, problem.contacts[0], u, rng


def applied(problem, blocks, step):
    pattern = problem.assembly.pattern
    return sp.csr_array(sp.bsr_array((blocks, pattern.indices, pattern.indptr))) @ step.ravel()


def test_force_and_tangent_are_derivatives_of_the_energy(item):
    problem, contact, u, rng = item
    drive, step, h = Drive(), rng.normal(size=u.shape), 1e-7

    def at(u):
        force = np.zeros_like(u)
        return contact.add_force((u, drive), force), force

    assert contact.report((u, drive))[0].points > 0
    (high, up), (low, down), (_, force) = at(u + h * step), at(u - h * step), at(u)
    assert (high - low) / (2 * h) == pytest.approx(float((force * step).sum()), rel=1e-7)
    blocks = np.zeros((problem.assembly.pattern.blocks, 3, 3))
    contact.add_tangent((u, drive), 1.0, blocks)
    differences = (up - down).ravel() / (2 * h)
    assert np.linalg.norm(applied(problem, blocks, step) - differences) < 1e-7 * np.linalg.norm(differences)


def test_mean_force_does_the_energys_work_and_resistance_takes_power(item):
    problem, contact, u, rng = item
    still = Drive(1.0, 0.0)
    contact.set_motion_penalty(np.ones(len(u)), 1e9)
    end, mean = u + 0.01 * rng.normal(size=u.shape), np.zeros_like(u)
    contact.add_force((end, still), mean, (u, still))
    stored = [contact.add_force((at, still), np.zeros_like(u)) for at in (u, end)]
    assert float((mean * (end - u)).sum()) == pytest.approx(stored[1] - stored[0], rel=1e-12)

    blocks = np.zeros((problem.assembly.pattern.blocks, 3, 3))
    contact.add_tangent((end, still), 1.0, blocks, since=(u, still))
    h, step = 1e-7, rng.normal(size=u.shape)

    def secant(end):
        force = np.zeros_like(u)
        contact.add_force((end, still), force, (u, still))
        return force

    along = (secant(end + h * step) - secant(end - h * step)).ravel() / (2 * h)
    off = applied(problem, blocks, step) - along
    assert np.linalg.norm(off) < 0.2 * np.linalg.norm(along)  # its main part

    v, force = 0.1 * rng.normal(size=u.shape), np.zeros_like(u)
    power = contact.add_resistance((u, still), v, force)
    assert power == pytest.approx(float((force * v).sum()), rel=1e-12)
    assert power > 0.0 if contact.resists else not force.any()
    blocks[:] = 0.0
    contact.add_resistance_tangent((u, still), v, 1.0, blocks)
    ends = [np.zeros_like(u), np.zeros_like(u)]
    for sign, out in zip((1.0, -1.0), ends, strict=True):
        contact.add_resistance((u, still), v + sign * h * step, out)
    along = (ends[0] - ends[1]).ravel() / (2 * h)
    assert np.linalg.norm(applied(problem, blocks, step) - along) <= 1e-6 * np.linalg.norm(along)


def of_sampling(drop, masses):
    """Return by how much of its force and of its moment a clamp's may be off. Cells that store 0.18 κ²l² too
    little lose half of that of the moment (below), and V₀ ~ √M₀ half as much. Nodes at a distance l that a
    beam lies on leave 0.22 (l/s₁)² of its V₀ open, by the phase of the lift-off s₁ in its cell (a cubic beam
    on unilateral points), and twice that of M₀ ~ V₀²."""
    lift_off, _, moment = heavy_elastica(drop)
    cell = 1.0 / (masses - 1)
    turn, phase = (moment / 0.01 * cell) ** 2, 0.22 * (cell / lift_off) ** 2
    return 0.045 * turn + phase, 0.09 * turn + 2 * phase


@pytest.mark.parametrize(("drop", "masses"), [(0.05, 41), (0.2, 41), (0.05, 81), (0.2, 81)])
def test_strip_that_lies_down_against_the_heavy_elastica(drop, masses):
    lift_off, carried, moment = heavy_elastica(drop)
    within, of_moment = of_sampling(drop, masses)
    solution = on_lattice(laid_strip(drop), (masses, 3, 2))
    assert solution.status is Status.CONVERGED
    free = on_lattice(laid_strip(drop, obstacles=()), (masses, 3, 2))
    assert solution.iterations <= 2 * free.iterations
    (force, clamped), plane = clamp(solution), solution.reactions["obstacle 1"][2] / WEIGHT
    assert force == pytest.approx(carried, rel=within)
    assert force + plane == pytest.approx(1.0, abs=1e-9)
    contact = solution.contacts["obstacle 1"]
    assert contact.penetration < 1e-4
    assert contact.undecided == 0
    assert solution.energies["contact"] > 0.0
    mesh, field = solution.mesh, solution.mesh.point_data
    assert clamped == pytest.approx(moment, rel=of_moment)
    assert moment == pytest.approx(np.sqrt(2 * 0.01 * drop), rel=1e-6)  # √(2 B w H), of any heavy elastica
    # the plane's force R, at x, is a point force at s₁ and the weight of what lies: R x = R s₁ + w (L −
    # s₁)²/2
    pressed = field["contact_pressure"] * field["mass_share"]
    place, force = float(pressed @ mesh.points[:, 0] / pressed.sum()), plane
    s1 = fsolve(lambda s: force * (place - s) - 0.5 * (1.0 - s) ** 2, 0.5)[0]
    assert s1 == pytest.approx(lift_off, rel=0.01)


@pytest.mark.parametrize("drop", [0.05, 0.2])
def test_cells_graded_towards_the_clamp_bring_its_force_and_moment_within_a_thousandth(drop):
    """As `--grading auto` does, by 0.5 and with `consistent-membrane` where one edge alone is held."""
    _, carried, moment = heavy_elastica(drop)
    graded = on_lattice(laid_strip(drop), (41, 3, 2), Grading(0.5, ("x0",)), "consistent-membrane")
    assert clamp(graded) == pytest.approx((carried, moment), rel=1e-3)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("at", [0.3, 0.35, 0.4, 0.45, 0.5])
def test_strip_over_a_cylinder_against_the_elastica(at):
    solution = on_lattice(bent_over(at), (41, 3, 2))
    assert solution.status is Status.CONVERGED
    force = np.linalg.norm(solution.reactions["obstacle 1"])
    assert force == pytest.approx(bent_elastica(at), rel=6e-4)
    if at == 0.4:
        assert solution.displacement([[1.0, 0.05]])[0, 2] == pytest.approx(CYLINDER_TIP, abs=1e-3)


def test_thin_rod_is_not_walked_through_and_one_thinner_than_the_points_is_refused():
    rod = bent_over(radius=THICKNESS, height=-1.5 * THICKNESS)
    solution = on_lattice(rod, (21, 3, 2))
    assert solution.status is Status.CONVERGED
    assert solution.reactions["obstacle 1"][2] > 1.0
    thinner = bent_over(radius=THICKNESS / 4, height=-THICKNESS)
    with pytest.raises(BadInput, match=r"obstacle 1.radius = 0.00125: too thin"):
        on_lattice(thinner, (21, 3, 2))


def test_drape_over_a_ball_is_unstable_and_folds_one_way():
    symmetric = on_lattice(draped_quarter(), (9, 9, 2))
    assert symmetric.status is Status.UNSTABLE
    u = symmetric.displacement([[0.1, 0.0], [0.0, 0.1]])
    assert u[0, 2] == pytest.approx(u[1, 2], rel=1e-6)
    stable = on_lattice(draped_quarter(), (9, 9, 2), branch="stable")
    assert stable.status is Status.CONVERGED
    u = np.sort(stable.displacement([[0.1, 0.0], [0.0, 0.1]])[:, 2])
    assert u[0] < -0.06
    assert u[1] > -0.005


def test_moving_obstacle_ends_at_its_last_place():
    press = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, 0.05)))
    lifted = laid_strip(0.1, obstacles=(Plane(position=(0.0, 0.0, -0.1 - THICKNESS / 2), motion=press),))
    moved, placed = (on_lattice(scene, (21, 3, 2)) for scene in (lifted, laid_strip(0.05)))
    assert moved.reactions["x0"] == pytest.approx(placed.reactions["x0"], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("model", ["lumped", "shell"])
@pytest.mark.parametrize("ball", [False, True])
def test_pressure_integrates_to_the_force(model, ball):
    """On a plane and around a point: the mean one over the area in contact, and a lattice's field over it."""
    scene = pressed_ball((0.0733, 0.0867), 1.5e-3) if ball else laid_strip(0.05)
    solution = equilibrium(scene, model, (9, 9) if ball else (21, 3), (8, 8) if ball else (10, 1))
    found, force = solution.document()["contacts"]["obstacle 1"], solution.reactions["obstacle 1"]
    within = 3e-4 if ball else 1e-6  # normals around a ball are not parallel
    assert found["pressure"] * found["area"] == pytest.approx(np.linalg.norm(force), rel=within)
    assert found["area"] < (2e-6 if ball else 0.0601)
    if model == "lumped":
        field, masses = solution.mesh.point_data, 2 * (64 if ball else 40)
        each = scene.sheet.length_x * scene.sheet.length_y * field["mass_share"] / masses
        assert field["contact_pressure"] @ each == pytest.approx(np.linalg.norm(force), rel=within)


@pytest.mark.parametrize("far", [
    Plane(position=(0.0, 0.0, -30.0)), Sphere(position=(0.5, 0.0, -20.0), radius=1.0),
])  # fmt: skip
def test_far_obstacle_changes_nothing(far):
    """Neither a shape at rest of lattice or shell, nor a motion, nor a frequency."""

    def answers(scene):
        springs = lumped.calibrate(scene.sheet, scene.material, grid=(7, 3, 2))
        moving = {"step": 5e-6, "every": 2e-4, "integrator": "verlet"}
        return [
            lumped.solve(scene, springs).displacement([[1.0, 0.05]]),
            fem_reference.solve(scene, "shell", elements=(3, 1)).displacement([[1.0, 0.05]]),
            np.stack([*lumped.simulate(scene, springs, 2e-3, **moving).probes.values()]),
            lumped.modes(scene, springs, 3, about="deformed").frequencies,
        ]

    free = laid_strip(0.05, obstacles=())
    *shapes, frequencies = zip(answers(free), answers(free.replace(obstacles=(far,))), strict=True)
    for without, beside in shapes:
        assert beside == pytest.approx(without, rel=1e-9, abs=1e-12)
    assert frequencies[1] == pytest.approx(frequencies[0], rel=2e-8)  # rounding of eigenvalues


def test_without_an_obstacle_nothing_of_contact_runs():
    """Neither at rest nor in motion, by calls that a profiler sees; with one it sees hundreds."""
    files = "lumped/contact.py", "discrete/contact.py", "continuation/stiffening.py"

    def calls(scene):
        found = []

        def seen(frame, event, _):
            if event == "call" and frame.f_code.co_filename.endswith(files):
                found.append(frame.f_code.co_name)

        springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 3, 2))
        sys.setprofile(seen)
        try:
            lumped.solve(scene, springs)
            fem_reference.solve(scene, "shell", elements=(2, 1))
            lumped.simulate(scene, springs, 0.01, integrator="esdirk")
        finally:
            sys.setprofile(None)
        return found

    assert len(calls(laid_strip(0.05))) > 300  # and has imported all
    # an empty tuple, once a solve
    assert set(calls(laid_strip(0.05, obstacles=()))) <= {"contacts", "<genexpr>"}


def test_statics_refuse_friction_linearity_and_free_motions():
    sheet = laid_strip(0.05, obstacles=(Plane(position=(0.0, 0.0, -0.1), friction=0.3),))
    with pytest.raises(SceneError, match=r"obstacle 1.friction = 0.3: at rest"):
        on_lattice(sheet, (5, 3, 2))
    with pytest.raises(SceneError, match="a linear solve has no contact"):
        on_lattice(laid_strip(0.05), (5, 3, 2), linear=True)
    with pytest.raises(SceneError, match="nothing stops translation along x"):
        on_lattice(lying_quarter(supports=()), (5, 5, 2))


@pytest.mark.sweep(3)
@pytest.mark.parametrize("graded", [False, True])
@pytest.mark.parametrize("grid", [(20, 4), (21, 5), (22, 5), (12, 4), (11, 3), (21, 6)])
def test_cradle_is_stable_and_rocks_on_grids_of_either_parity(grid, graded):
    """Wherever it touches: at columns a surface of parabolas has a kink of V l²/6B, on which it rocked up to
    1.8 times too fast."""
    scene, grading = curled_sheet(), Grading(0.5, ("x0", "x1")) if graded else 0.0
    solution = on_lattice(scene, (*grid, 2), grading)
    assert solution.status is Status.CONVERGED
    assert solution.iterations <= 30
    ends = solution.displacement([[0.0, 0.01], [0.1, 0.01]])[:, 2]
    assert ends == pytest.approx(6.013e-3, rel=1e-3)
    assert solution.reactions["obstacle 1"][2] == pytest.approx(1780.0 * 1e-6 * 9.81, rel=1e-7)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(*grid, 2), grading=grading)
    slowest = lumped.modes(scene, springs, 1, about="deformed").frequencies[0]
    assert slowest == pytest.approx(rocking_frequency(), rel=0.03)


def test_light_sheet_is_not_left_in_the_air():
    """Of the forces of 41 × 9 masses its weight is less than a stage's residual: a start off the table passed
    for an equilibrium."""
    solution = on_lattice(curled_sheet(), (41, 9, 2), method="consistent-membrane")
    assert solution.status is Status.CONVERGED
    assert solution.iterations <= 30


@pytest.mark.parametrize("grid", [(21, 4, 2), (20, 4, 2), (40, 8, 2)])
def test_energy_of_a_curled_sheet_is_off_by_its_bending(grid):
    """By up to 0.7 % on four masses across, on a table as on a clamp without one: contact has 1e-5 of it."""
    on_table = curled_sheet()
    clamped = on_table.replace(supports=(Clamped(edge="x0"),), obstacles=())
    fine, coarse = (
        [on_lattice(scene, of).energies for scene in (on_table, clamped)] for of in ((61, 13, 2), grid)
    )
    off = [sum(a.values()) / sum(b.values()) - 1.0 for a, b in zip(coarse, fine, strict=True)]
    assert off[0] == pytest.approx(off[1], abs=1e-3)
    assert coarse[0]["contact"] < 2e-5 * sum(coarse[0].values())


@pytest.mark.parametrize("number", [pytest.param(2, marks=pytest.mark.nightly), 22, 39, 59])
def test_drawn_sheet_is_not_walked_through(number):
    assert faults_of(number) == ""


@pytest.mark.nightly
def test_a_thousand_drawn_sheets():
    faults = {number: found for number in range(1000) if (found := faults_of(number))}
    assert not faults, faults
