"""References that touch obstacles: derivatives, closed forms at rest, as of lattices, energy in motion."""

import numpy as np
import pytest
from cases import equilibrium
from contact_cases import (
    GRAVITY,
    OBSTACLES,
    WEIGHT,
    bent_elastica,
    bent_over,
    curled_sheet,
    draped_quarter,
    heavy_elastica,
    laid_strip,
    loop_force,
    lying_quarter,
    pressed_ball,
    pressed_loop,
    rocking_frequency,
)

import fem_reference
import lumped.patch as lumped_patch
from fem_reference.discrete import patch, tangent_planes
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.mesh import divisions, mesh_of
from sheetbench.answers.solution import Status
from sheetbench.scenes import Plane, SceneError
from sheetbench.scenes.objects.natural import Natural


@pytest.mark.parametrize("curled", [False, True])
@pytest.mark.parametrize("name", OBSTACLES)
def test_force_is_the_potential_s_and_tangent_the_force_s_derivative(name, curled):
    natural = Natural(curvature=(1e-3 * curled, 0.0, 0.0))
    scene = laid_strip(0.1, obstacles=(OBSTACLES[name],), natural=natural if curled else None)
    sheet = DiscreteShell(mesh_of(scene, divisions(scene.sheet, (6, 2)), False), scene)
    item, rng = sheet.contacts[0], np.random.default_rng(1)
    q, step, h = np.zeros(sheet.size), rng.normal(size=sheet.size), 1e-7
    sheet.displacement(q)[:] = 0.01 * rng.normal(size=(sheet.nodes, 3)) - [0.0, 0.0, 0.02]

    def at(q):
        return sheet.shape(q, 1.0)

    assert item.report(at(q))[0].points > 0
    high, low = at(q + h * step), at(q - h * step)
    slope = (item.potential(high) - item.potential(low)) / (2 * h)
    assert slope == pytest.approx(-float(item.force(at(q)) @ step), rel=1e-7)
    on, by = item.tangent(at(q))
    found = sheet.of_surface(on, np.einsum("eicjd,ejd->eic", by, sheet.surface_change(step)[on]))
    along = (item.force(high) - item.force(low)) / (2 * h)
    assert np.linalg.norm(found - along) < 1e-7 * np.linalg.norm(along)


def test_parts_of_elements_are_as_many_on_both_sides_of_a_round_radius():
    """As a derivative by the radius takes them; an element's side is 4 of the R/3 that a part may have."""
    side = 0.16 / 4
    for near in (1.0 - 1e-8, 1.0 + 1e-8):
        scene = pressed_ball((0.07, 0.07), 4e-3, 0.75 * side * near)
        sheet = DiscreteShell(mesh_of(scene, divisions(scene.sheet, (4, 4)), False), scene)
        assert sheet.contacts[0].groups.shape == (16, 9)


def test_what_takes_kinks_off_has_its_derivatives():
    rng, h = np.random.default_rng(0), 1e-6
    vectors, step, pull = rng.normal(size=(3, 2, 18, 3))

    def slope(f):
        return (f(vectors + h * step) - f(vectors - h * step)) / (2 * h)

    def along(by):
        return np.einsum("eicjd,ejd->eic", by, step)

    def pulled(vectors):
        return np.einsum("eic,eicjd->ejd", pull, tangent_planes.first(vectors))

    first, second = along(tangent_planes.first(vectors)), along(tangent_planes.second(vectors, pull))
    assert np.linalg.norm(first - slope(tangent_planes.corrections)) < 1e-8 * np.linalg.norm(first)
    assert np.linalg.norm(second - slope(pulled)) < 1e-8 * np.linalg.norm(second)


@pytest.mark.parametrize("drop", [0.05, 0.2])
def test_shell_that_lies_down_against_the_heavy_elastica(drop):
    _, carried, moment = heavy_elastica(drop)
    scenes = laid_strip(drop), laid_strip(drop, obstacles=())
    solution, free = (fem_reference.solve(scene, "shell", elements=(20, 1), graded=False) for scene in scenes)
    assert solution.status is Status.CONVERGED
    assert solution.reactions["x0"][2] / WEIGHT == pytest.approx(carried, rel=1e-3)
    assert sum(f[2] for f in solution.reactions.values()) == pytest.approx(WEIGHT, rel=1e-7)
    finer = fem_reference.solve(scenes[0], "shell", elements=(40, 1), graded=False)
    most = 2 * free.iterations  # soft first; with stiff contact there are hundreds
    assert max(solution.iterations, finer.iterations) <= most
    assert solution.contacts["obstacle 1"].penetration < 1e-4
    # the clamp's moment is what weight and plane leave of moments about it, by Simpson's rule
    rule = np.array([1.0, *[4.0, 2.0] * 19, 4.0, 1.0]) / 120.0
    at = np.linspace(0.0, 1.0, 41)
    x = at + solution.displacement(np.column_stack([at, np.full(41, 0.05)]))[:, 0]
    nodes, pressure = solution.mesh.points[:, :2], solution.mesh.point_data["contact_pressure"]
    there = [int(np.abs(nodes - [each, 0.05]).sum(axis=1).argmin()) for each in at]
    share = 0.1 * pressure[there] / WEIGHT
    assert rule @ ((1.0 - share) * x) == pytest.approx(moment, rel=1e-3)


def test_solid_agrees_with_the_shell():
    scene = laid_strip(0.2)
    shell, solid = (fem_reference.solve(scene, name, elements=(10, 1)) for name in ("shell", "solid"))
    assert solid.status is Status.CONVERGED
    assert solid.reactions["x0"][2] == pytest.approx(shell.reactions["x0"][2], rel=5e-3)


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("model", "gap", "cells"),
    [("lumped", 0.6, 40), ("shell", 0.6, 20), ("lumped", 0.3, 80), ("shell", 0.3, 20), ("lumped", 0.6, 80)],
)
def test_loop_pressed_between_plates(model, gap, cells):
    """That a clamp turns, without loads, against a plane; nodes at a distance l leave 0.44 (l/s₁)² of the
    force open by the phase of the lift-off s₁, κ s₁ = ½ Β(¼, ½) = 2.62205; of a lattice its springs' sine
    takes κ²l²/6, the chord for the arc 1/12 of κ²l²."""
    solution = equilibrium(pressed_loop(gap), model, (cells + 1, 3), (cells, 1), graded=False)
    nodes, of_springs = (cells, 1 / 6 + 1 / 12) if model == "lumped" else (2 * cells, 0.0)
    within = (of_springs + 0.44 / 2.62205**2) * (2.0 * 1.19814 / gap / nodes) ** 2
    assert solution.reactions["obstacle 1"][2] == pytest.approx(-loop_force(gap), rel=within)


@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_sheet_that_lies_presses_evenly(model):
    solution = equilibrium(lying_quarter(), model, 9, 4)
    pressure = solution.mesh.point_data["contact_pressure"]
    assert np.abs(pressure / (1e3 * 0.002 * GRAVITY) - 1.0).max() < 1e-8
    assert model == "shell" or solution.iterations <= 8


@pytest.mark.parametrize(("elements", "within"), [(10, 3e-3), (20, 3e-4)])
def test_shell_over_a_cylinder(elements, within):
    """Wherever nodes are: at nodes alone it was 0.6 to 2 % off with ten elements."""
    for at in (0.35, 0.4):
        solution = fem_reference.solve(bent_over(at), "shell", elements=(elements, 1), graded=False)
        force = np.linalg.norm(solution.reactions["obstacle 1"])
        assert force == pytest.approx(bent_elastica(at), rel=within)


@pytest.mark.parametrize(
    ("elements", "rise", "force", "within"),
    [(8, 1.5e-4, 7.535e-4, 0.02), (12, 1.5e-4, 7.535e-4, 0.02), (8, 4e-3, 7.968e-2, 0.04)],
)
def test_ball_between_nodes_is_felt(elements, rise, force, within):
    """Force of Navier's series at (73.3, 86.7) mm of a hinged sheet, and that of 32 elements."""
    solution = fem_reference.solve(pressed_ball((0.0733, 0.0867), rise), "shell", elements=elements)
    assert solution.reactions["obstacle 1"][2] == pytest.approx(force, rel=within)
    assert solution.displacement([[0.0733, 0.0867]])[0, 2] == pytest.approx(rise, rel=5e-3)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("elements", [(8, 1), (16, 3), (9, 3), (25, 5), (10, 1), (20, 4), (11, 2)])
def test_cradle_is_stable_and_rocks_wherever_elements_end(elements):
    """With the kinks of elements it rocked up to 2.2 times too fast."""
    scene, options = curled_sheet(), {"elements": elements, "graded": False}
    solution = fem_reference.solve(scene, "shell", **options)
    assert solution.status is Status.CONVERGED
    assert solution.displacement([[0.0, 0.01], [0.1, 0.01]])[:, 2] == pytest.approx(6.013e-3, rel=1e-3)
    slowest = fem_reference.modes(scene, "shell", count=1, about="deformed", **options).frequencies[0]
    assert slowest == pytest.approx(rocking_frequency(), rel=0.03)


def test_both_integrals_over_patches_agree():
    """Of two derivations: along x between roots found one by one, along y between eigenvalues."""
    rng, (x, y) = np.random.default_rng(0), np.meshgrid([-1.0, 0.0, 1.0], [-1.0, 0.0, 1.0], indexing="ij")
    drawn = [
        rng.uniform(0.01, 0.3) - rng.uniform(0.1, 1.0) * (x - a) ** 2 - (y - b + 0.3 * x) ** 2
        for a, b in rng.uniform(-1.2, 1.2, (50, 2))
    ]
    q, k = np.array(drawn).reshape(-1, 9), rng.uniform(1.0, 2.0, (50, 9))
    found, order = patch.integrals(q, k, 2), np.arange(9).reshape(3, 3).T.ravel()
    other = lumped_patch.integrate(*(each.take(order, axis=1) for each in (q, k)), 2, True)
    assert found[0] == pytest.approx(other[0], rel=1e-6)
    assert found[1] == pytest.approx(other[1][:, order], rel=1e-5, abs=1e-7)
    assert (other[0] > 0.0).sum() > 30


@pytest.mark.nightly
def test_shell_over_a_ball_folds_one_way():
    found = fem_reference.solve(draped_quarter(), "shell", elements=6, branch="buckled")
    assert found.status is Status.CONVERGED
    u = found.displacement([[0.1, 0.0], [0.0, 0.1]])
    assert np.sort(u[:, 2]) == pytest.approx([-0.0652, 0.0002], abs=1e-3)


def test_the_plate_refuses_obstacles():
    with pytest.raises(SceneError, match="the plate, which is linear, has no contact"):
        fem_reference.solve(laid_strip(0.1), "plate")


@pytest.mark.nightly
def test_energy_of_a_shell_that_falls():
    scene = laid_strip(0.05).replace(length_x=0.2, thickness=0.002, young=5e6)
    scene = scene.replace(obstacles=(Plane(position=(0.0, 0.0, -0.011)),))
    history = fem_reference.simulate(scene, "shell", 0.08, elements=(6, 1), every=2e-3)
    assert history.status is Status.CONVERGED
    assert np.abs(history.balance - history.balance[0]).max() < 5e-3 * 1e3 * 0.002 * 0.02 * GRAVITY * 0.01
    assert history.reactions["obstacle 1"][:, 2].max() > 0.0


def test_friction_that_cannot_stick_is_said():
    floor = Plane(position=(0.0, 0.0, -0.011), friction=0.3)
    scene = laid_strip(0.05, obstacles=(floor,)).replace(length_x=0.2, thickness=0.002, young=5e6)
    history = fem_reference.simulate(scene, "shell", 2e-3, elements=(2, 1), every=1e-3)
    assert "sticking points creep" in history.message
