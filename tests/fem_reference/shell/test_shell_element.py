"""The shell element: zero modes, constant strain on a distorted mesh; rigid motions: test_moved_corners."""

import numpy as np
import pytest
from cases import RUBBER, SHEET, distorted
from skfem import Basis, ElementQuad2, MeshQuad

from fem_reference.discrete.answer import solve_on
from fem_reference.discrete.static import Static, StaticState
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.directors import multiplier, tangent_frames, to_unit
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.shell.element import Element
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.surface.materials import section_of
from fem_reference.surface.mesh import rectangle
from sheetbench import scenes
from sheetbench.scenes import Clamped, Pressure, Scene

pytestmark = pytest.mark.smoke


def build(mesh):
    basis = Basis(mesh, ElementQuad2())
    return Element.build(basis.doflocs.T[basis.element_dofs.T], section_of(RUBBER, SHEET.thickness))


FREE = Scene(name="t", sheet=SHEET, material=RUBBER, supports=(), probes={"A": (0, 0)})


def test_the_linear_step_honours_constraints_and_extrapolates_the_stress():
    scene = FREE.replace(supports=(Clamped(edge="x0"),), loads=(Pressure(value=2e5),))
    sheet, rng = DiscreteShell(distorted(), scene), np.random.default_rng(1)
    moved = 2e-4 * rng.uniform(-1, 1, (sheet.nodes, 3))
    director = np.array([0, 0, 1.0]) + 0.005 * rng.uniform(-1, 1, (sheet.nodes, 3))
    turned = director / np.linalg.norm(director, axis=1, keepdims=True) - [0, 0, 1.0]
    static, stretched = Static(sheet), StaticState(sheet.of_vectors(moved, turned) * 1.01)
    forces = static.forces(stretched, 1.0)
    matrix, rows = static.linearised(stretched, forces, 1.0)
    following = static.advance(stretched, forces, 1.0, np.linalg.solve(matrix.toarray(), rows)).q
    director, step = sheet.directors(stretched.q), following - stretched.q
    square = np.einsum("nc,nc->n", director, director)
    free = ~sheet.supports.director
    along = np.einsum("nc,nc->n", director, step.reshape(2, -1, 3)[1])
    np.testing.assert_allclose(along[free], (0.5 * (1 - square))[free], atol=1e-13)
    np.testing.assert_allclose(following.reshape(2, -1, 3)[:, ~free], 0.0, atol=1e-14)


@pytest.mark.parametrize("elements", [1, 2, 3])
@pytest.mark.parametrize("thickness", [0.003, 0.03])
def test_the_free_sheet_has_exactly_six_zero_modes(elements, thickness):
    sheet = DiscreteShell(distorted(elements=elements), FREE.replace(thickness=thickness))
    static, rest = Static(sheet), Static(sheet).rest()
    matrix, _ = static.linearised(rest, static.forces(rest, 0.0), 0.0)
    # a rotation counts as a thickness
    scale = np.where(np.arange(sheet.unknowns) < 3 * sheet.nodes, 1.0, 1.0 / thickness)
    eigenvalues = np.linalg.eigvalsh(scale[:, None] * matrix.toarray() * scale)
    assert np.all(np.abs(eigenvalues[:6]) < 1e-12 * eigenvalues[-1])
    assert eigenvalues[6] > 1e-7 * eigenvalues[-1]


def test_patch_of_constant_strain_on_a_distorted_mesh():
    """Linear displacement: constant membrane strain. Constant shear of the director: constant γ. Exactly."""
    element = build(distorted(by=0.3))
    stretch = np.array([[2e-3, 1e-3, 0.0], [-3e-3, 1.5e-3, 0.0], [0.0, 0.0, 0.0]])
    vectors = element.reference.copy()
    vectors[:, :9] += element.reference[:, :9] @ stretch.T
    strain = element.strain(vectors - element.reference)
    gradient = (np.eye(3) + stretch)[:, :2]
    green = 0.5 * (gradient.T @ gradient - np.eye(2))
    voigt = np.array([green[0, 0], green[1, 1], 2 * green[0, 1]])
    modulus = RUBBER.young / (1 - 0.48**2) * np.array([[1, 0.48, 0], [0.48, 1, 0], [0, 0, 0.26]])
    expected = 0.5 * SHEET.thickness * voigt @ modulus @ voigt * element.areas.sum()
    assert 0.5 * np.sum(strain * element.stress(strain)) == pytest.approx(expected, rel=1e-12)

    vectors = element.reference.copy()
    vectors[:, 9:] += [1e-3, -2e-3, 0.0]
    strain = element.strain(vectors - element.reference)
    shear = 5 / 6 * SHEET.thickness * RUBBER.young / (2 * 1.48)
    expected = 0.5 * shear * (1e-6 + 4e-6) * element.areas.sum()
    assert 0.5 * np.sum(strain * element.stress(strain)) == pytest.approx(expected, rel=1e-12)


def test_an_inverted_element_is_refused_by_every_reference():
    mesh = rectangle(SHEET, 2)
    p = mesh.p.copy()
    p[:, mesh.interior_nodes()] += 0.12
    folded = MeshQuad(p, mesh.t).with_boundaries(mesh.boundaries)
    with pytest.raises(ValueError, match="of the mesh is inverted"):
        build(folded)
    scene = scenes.load("one-edge-clamped")
    for model in (DiscretePlate, DiscreteShell, DiscreteSolid):
        with pytest.raises(ValueError, match="of the mesh is inverted"):
            solve_on(model, folded, scene)


def test_directors_are_brought_to_unit_length_and_turn_across_themselves():
    """Of length s, the step is Newton's for s² = 1, to (s² + 1)/2s; tangents are orthonormal, whatever s."""
    rng = np.random.default_rng(7)
    unit = rng.normal(size=(6, 3))
    unit /= np.linalg.norm(unit, axis=1, keepdims=True)
    lengths = np.array([0.5, 0.9, 1.0, 1.001, 1.5, 3.0])
    directors = lengths[:, None] * unit
    np.testing.assert_allclose(
        directors + to_unit(directors), ((lengths**2 + 1.0) / (2.0 * lengths))[:, None] * unit, rtol=1e-14
    )
    frames = tangent_frames(directors, np.full(len(directors), -1))
    whole = np.concatenate([frames, unit[:, :, None]], axis=2)
    np.testing.assert_allclose(whole.swapaxes(1, 2) @ whole, np.tile(np.eye(3), (6, 1, 1)), atol=1e-14)
    nearby = np.array([[1e-9, 2e-9, 1.0], [2e-9, 1e-9, 1.0], [0.6, 0.0, 1e-9], [0.6, 0.0, -1e-9]])  # no jumps
    frames = tangent_frames(nearby, np.full(4, -1))
    np.testing.assert_allclose(frames[::2], frames[1::2], atol=1e-8)
    couple = rng.normal(size=(6, 3))
    held = couple + multiplier(directors, couple)[:, None] * directors
    np.testing.assert_allclose(np.einsum("nc,nc->n", held, directors), 0.0, atol=1e-13)
