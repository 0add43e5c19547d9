"""The solid on scenes: Habibi et al.'s, agreement with the shell and closed forms, convergence, no
locking."""

import numpy as np
import pytest
from cases import relative, sheet, with_material

import fem_reference
from fem_reference.solid.materials import LAWS
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.choices import STRAIN_LAWS
from sheetbench.scenes import Pressure


def solid(scene, elements, **options):
    return fem_reference.solve(scene, "solid", elements=elements, **options)


def shell(scene, elements, **options):
    return fem_reference.solve(scene, "shell", elements=elements, **options)


def with_poisson(name, poisson):
    return with_material(scenes.load(name), poisson=poisson)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", ["curved-edge", "curved-edge-down"])
def test_curved_edge_lies_on_its_arc_beside_the_shell(name):
    """The face follows the rod's director, free in thickness; the rest agrees with the shell."""
    scene = scenes.load(name)
    points = scene.probe_points()
    answer = solid(scene, 6)
    assert answer.status is Status.CONVERGED
    assert relative(answer.displacement(points), shell(scene, 8).displacement(points)) < 3e-3
    kappa = scene.supports[0].curvature
    x, u = answer.mesh.points, answer.mesh.point_data["displacement"]
    face = np.abs(x[:, 0]) < 1e-12
    angle = kappa * (x[face, 1] - 0.094)
    rod = np.column_stack([0 * angle, 0.094 + np.sin(angle) / kappa, (1 - np.cos(angle)) / kappa])
    director = np.column_stack([0 * angle, -np.sin(angle), np.cos(angle)])
    off = x[face] + u[face] - rod
    along = np.einsum("nc,nc->n", off, director)
    np.testing.assert_allclose(off - along[:, None] * director, 0.0, atol=1e-12)
    np.testing.assert_allclose(along, x[face, 2], atol=2e-4 * 0.003 + 2e-2 * np.abs(x[face, 2]).max())
    mid = np.abs(x[face, 2]) < 1e-12
    np.testing.assert_allclose(along[mid], 0.0, atol=1e-12)


@pytest.mark.nightly
def test_no_volumetric_locking_of_a_full_clamp():
    """The 8×8 mesh is as near the converged answer as at any ν; of the other clamp: test_locking.py."""
    scene = with_poisson("two-edges-clamped", 0.4999)
    points = scene.probe_points()
    coarse, fine = (solid(scene, n, clamp="full").displacement(points) for n in (6, 9))
    assert relative(coarse, fine) < 1e-2


@pytest.mark.sweep(2)
@pytest.mark.parametrize("law", [law for law in LAWS if law in STRAIN_LAWS and law != "st-venant-kirchhoff"])
def test_other_laws_are_close_at_small_strain_and_converge_as_fast(law):
    scene = with_poisson("one-edge-clamped", 0.4999)
    points = scene.probe_points()
    one, other = (solid(scene, 4, law=name) for name in ("st-venant-kirchhoff", law))
    assert other.status is Status.CONVERGED and other.iterations < 15
    assert relative(one.displacement(points), other.displacement(points)) < 2e-3


def test_full_clamp_is_stiffer():
    """It stops the Poisson contraction of the face as well: a little less deflection, the same reactions."""
    scene = scenes.load("one-edge-clamped")
    points = scene.probe_points()
    full, like_a_shell = (solid(scene, 6, clamp=clamp) for clamp in ("full", "shell-like"))
    ratio = full.displacement(points)[2, 2] / like_a_shell.displacement(points)[2, 2]
    assert 0.98 < ratio < 1.0
    np.testing.assert_allclose(full.reactions["x0"], like_a_shell.reactions["x0"], atol=1e-7)


def test_a_compressed_flat_sheet_is_unstable():
    """Beyond Euler's load the flat sheet is an equilibrium, but not a stable one."""
    euler = np.pi**2 * 1e6 * 0.002**3 / 12 / (2 * 0.2) ** 2
    for share, status in ((0.9, Status.CONVERGED), (1.1, Status.UNSTABLE)):
        press = {"kind": "edge", "edge": "x1", "force_per_length": (-share * euler, 0.0, 0.0)}
        scene = sheet(0.2, 0.05, 0.002, poisson=0.0, loads=[press])
        assert solid(scene, (8, 2), grading="uniform").status is status


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("elements", "grading"), [((24, 1), "edges"), ((48, 1), "edges"), ((90, 1), "uniform")]
)
def test_slices_much_longer_than_wide_are_as_stable_as_the_sheet(elements, grading):
    """Strips bent to a surface strain of 0.04: no slice buckles by shear that its samples do not see.
    The cantilever is 3.1 of Sze, Liu & Lo (2004)."""
    loads = [{"kind": "edge", "edge": "x1", "force_per_length": (0.0, 0.0, 16.0)}]
    scene = sheet(10.0, 1.0, 0.1, 1.2e6, 0.0, 1.0, loads=loads)
    answer, coarse = solid(scene, elements, grading=grading), solid(scene, (12, 1))
    assert answer.status is Status.CONVERGED
    assert relative(answer.displacement([[10.0, 0.5]]), coarse.displacement([[10.0, 0.5]])) < 3e-3


def test_field_mesh_has_every_node():
    answer = solid(scenes.load("two-edges-clamped"), 2, layers=2)
    (kind, cells), points = answer.mesh.cells[0], answer.mesh.points
    assert kind == "hexahedron" and cells.shape == (2 * 2 * 4 * 4, 8)
    assert len(points) == 5 * 5 * 5 and answer.mesh.point_data["displacement"].shape == points.shape
    a, b, c, d = (points[cells[:, i]] for i in (0, 1, 3, 4))
    volumes = np.einsum("nc,nc->n", np.cross(b - a, c - a), d - a)
    assert np.all(volumes > 0.0) and volumes.sum() == pytest.approx(0.188**2 * 0.003)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"law": "hooke"}, "law = 'hooke'"),
        ({"clamp": "glued"}, "clamp = 'glued'"),
        ({"grading": "random"}, "grading = 'random'"),
        ({"layers": 0}, "layers = 0"),
    ],
)
def test_unknown_options_are_refused(options, said):
    with pytest.raises(ValueError, match=said):
        solid(scenes.load("two-edges-clamped"), 2, **options)


def test_a_clamp_that_holds_the_mean_is_not_dented_by_finer_layers():
    """The shear force on its mid-line alone would dent the face by 6 %."""
    load = (Pressure(value=-200.0),)
    scene = sheet(0.1, 0.1, 0.012, 1e6, 0.45, 1100.0, held="x0 x1 y0 y1", loads=load)
    points = scene.probe_points()
    two, three = (solid(scene, 5, layers=layers, clamp="mean").displacement(points) for layers in (2, 3))
    assert relative(three, two) < 0.003
    assert relative(solid(scene, 5, layers=2).displacement(points), two) > 0.04
