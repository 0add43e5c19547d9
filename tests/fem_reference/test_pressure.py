"""Pressure has a potential where the edges sweep no area: symmetric tangents, inertia, paths past folds."""

import numpy as np
import pytest
from cases import equilibrium, relative
from dynamic_cases import make_scene

import lumped
from fem_reference.discrete.static import Static
from fem_reference.sheets import solid
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.mesh import mesh_of
from sheetbench.numerics.direct import SymmetricPartFactor

EDGES = ("x0", "x1", "y0", "y1")
CLAMPED = [{"edge": edge, "kind": "clamped"} for edge in EDGES]
HINGED = [{"edge": edge, "kind": "hinged"} for edge in EDGES]
# held across itself, an edge may rise and still sweeps no area
ACROSS = [{"edge": edge, "kind": "held", "components": [edge[0]]} for edge in EDGES[:3]]
ACROSS += [{"edge": "y1", "kind": "curved", "curvature": 0.0}]
FREE = [{"edge": edge, "kind": "clamped"} for edge in EDGES[:3]]


def pressed(supports, value=300.0, **material):
    """The catalogue's sheet under pressure alone."""
    loads = [{"kind": "pressure", "value": value}]
    return make_scene(supports=supports, loads=loads, gravity=False, **material)


def problem_of(scene, grid=(4, 5, 2)):
    return lumped.build_problem(scene, lumped.calibrate(scene.sheet, scene.material, grid=grid))


def bent(problem, seed=0):
    """An admissible displacement, of the size of the cells."""
    size = 0.2 * problem.assembly.lattice.spacing[0]
    unknowns = np.random.default_rng(seed).standard_normal(problem.system.unknowns)
    return problem.expand(size * unknowns) + problem.prescribed(1.0)


def test_the_force_is_that_of_the_areas_whatever_the_shape():
    problem = problem_of(pressed(FREE))
    lattice, u = problem.assembly.lattice, bent(problem)
    x = (lattice.positions + u)[lattice.mid_cells].mean(axis=2)
    area = 0.5 * np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 1]).sum(axis=0)
    np.testing.assert_allclose(problem.loads.followers(u).sum(axis=0), 300.0 * area, rtol=1e-12, atol=1e-12)


@pytest.mark.parametrize("supports", [CLAMPED, HINGED, ACROSS], ids=["clamped", "hinged", "across"])
def test_on_edges_that_sweep_no_area_the_force_is_the_gradient_of_the_work(supports):
    problem = problem_of(pressed(supports))
    assert problem.conservative and problem.descends
    u, h = bent(problem), 1e-6
    draw = np.random.default_rng(5)
    for _ in range(3):
        along = problem.expand(draw.standard_normal(problem.system.unknowns))
        slope = (problem.loads.work(u + h * along) - problem.loads.work(u - h * along)) / (2.0 * h)
        assert slope == pytest.approx(float(np.sum(problem.loads.force(u) * along)), rel=1e-6)
    blocks = np.zeros((problem.assembly.pattern.blocks, 3, 3))
    problem.loads.add_tangent(u, 1.0, blocks)
    reduced = problem.system.matrix(blocks).toarray()
    np.testing.assert_allclose(reduced, reduced.T, atol=1e-13 * np.abs(reduced).max())


def test_on_a_free_edge_the_tangent_is_unsymmetric_and_solved_with_its_symmetric_part():
    problem = problem_of(pressed(FREE), (9, 9, 2))
    assert not problem.conservative
    u = 1e-4 * bent(problem)
    blocks = problem.tangent(u, 1.0)
    factor = problem.system.factor(blocks)
    assert isinstance(factor, SymmetricPartFactor)
    matrix = problem.system.matrix(blocks)
    assert abs(matrix - matrix.T).max() > 1e-8 * abs(matrix).max()
    b = np.random.default_rng(1).standard_normal(problem.system.unknowns)
    np.testing.assert_allclose(matrix @ factor.solve(b), b, atol=1e-9 * np.abs(matrix.data).max())
    assert factor._full is None and factor.negative_real() == 0


@pytest.mark.parametrize("supports", [CLAMPED, HINGED, FREE], ids=["clamped", "hinged", "free"])
def test_lattice_and_shell_agree_under_pressure(supports):
    scene = pressed(supports)
    points = np.array([[0.094, 0.094], [0.094, 0.15], [0.188, 0.188]])
    found, truth = (equilibrium(scene, model, 17, 8) for model in ("lumped", "shell"))
    assert ("unsymmetric" in found.message) == (supports is FREE)
    assert relative(found.displacement(points), truth.displacement(points)) < 0.01


@pytest.mark.parametrize("model", ["shell", "solid"])
@pytest.mark.parametrize("supports, symmetric", [(CLAMPED, True), (ACROSS, True), (FREE, False)])
def test_a_references_tangent_is_symmetric_where_its_pressure_has_a_potential(supports, symmetric, model):
    scene = pressed(supports)
    sheet = solid(scene, (2, 2)) if model == "solid" else DiscreteShell(mesh_of(scene, (3, 2)), scene)
    structure = Static(sheet)
    assert structure.symmetric is symmetric
    state = structure.rest()
    for _ in range(2):  # somewhere off the flat state
        forces = structure.forces(state, 1.0)
        draw = np.random.default_rng(3).standard_normal(structure.unknowns)
        state = structure.advance(
            state, forces, 1.0, draw * (1e-4 if model == "solid" else 0.02 * sheet.longer_side)
        )
    matrix = structure.linearised(state, structure.forces(state, 1.0), 1.0, mixed=False)[0]
    rounding, flat = 1e-13 * abs(matrix).max(), sheet.shape(np.zeros(sheet.size), 1.0)
    if model == "shell":
        rounding = 1e-9 * sum(np.abs(item.tangent(flat)[1]).max() for item in sheet.items)
    assert bool(abs(matrix - matrix.T).max() < rounding) is symmetric


def arch(value):
    """A strip whose ends turn and come nearer, so that it hangs in an arch, and a pressure from below."""
    shift = {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [-0.004, 0.0, 0.0]]}
    ends = [{"edge": "x0", "kind": "clamped", "tilt": 0.35}]
    ends += [{"edge": "x1", "kind": "clamped", "tilt": 0.35, "motion": shift}]
    return pressed([*ends, *({"edge": edge, "kind": "symmetric"} for edge in ("y0", "y1"))], value)


@pytest.mark.parametrize("value, side", [(400.0, -1.0), (1000.0, 1.0)], ids=["held", "through"])
def test_an_arch_is_pressed_through_in_lattice_and_shell(value, side):
    """Their paths go past folds and end at stable shapes: the inertia and the energy of a pressure tell."""
    scene, middle = arch(value), np.array([[0.094, 0.094]])
    found = [equilibrium(scene, model, (13, 3), (8, 2)) for model in ("lumped", "shell")]
    heights = [side * each.displacement(middle)[0, 2] for each in found]
    assert min(heights) > 0.01 and heights[0] == pytest.approx(heights[1], rel=0.1)
