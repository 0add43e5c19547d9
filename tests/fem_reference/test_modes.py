"""Natural frequencies: published and closed-form values; rigid motions of free and half-held sheets."""

import numpy as np
import pytest

from fem_reference.vibration import SHEETS, modes
from sheetbench import scenes
from sheetbench.scenes import Clamped, Hinged, Material, Scene, Sheet

STEEL = Material(young=200e9, poisson=0.3, density=8000.0)
NAFEMS = Sheet(length_x=10.0, length_y=10.0, thickness=0.05)
THIN = Sheet(length_x=1.0, length_y=1.0, thickness=1e-3)


def clamped(sheet, *edges, material=STEEL):
    return Scene("modes", sheet, material, supports=[Clamped(edge=edge) for edge in edges])


def factor(scene):
    """Turns Hz into ω a² √(ρh/D)."""
    sheet, material = scene.sheet, scene.material
    bending = material.young * sheet.thickness**3 / (12 * (1 - material.poisson**2))
    return 2 * np.pi * sheet.length_x**2 * np.sqrt(material.density * sheet.thickness / bending)


@pytest.mark.parametrize(
    ("edges", "published"),
    [
        (["x0"], [3.471, 8.507, 21.28, 27.20, 30.95, 54.18]),
        pytest.param(["x0", "y0"], [6.919, 23.90, 26.58, 47.64, 62.70, 65.53], marks=pytest.mark.nightly),
    ],
)
def test_leissa_thin_plates_of_the_solid(edges, published):
    """Of plate and shell, and NAFEMS: test_verify.py."""
    scene = clamped(THIN, *edges)
    elements = 8 if edges == ["x0"] else 16  # the corner of two clamps requests for more
    got = modes(scene, model="solid", elements=elements, count=6)
    np.testing.assert_allclose(got.frequencies * factor(scene), published, rtol=1e-3)


def test_convergence_from_above():
    """One edge clamped, even meshes: errors fall like h² (the corners of clamp and free edge) or faster."""
    scene = clamped(THIN, "x0")
    found = [modes(scene, "plate", n, count=6, graded=False) for n in (4, 8, 16, 24)]
    coefficients = [each.frequencies * factor(scene) for each in found]
    steps = np.abs(np.diff(coefficients, axis=0)) / coefficients[-1]
    slopes = np.log2(steps[0] / steps[1])
    assert np.all(slopes > 1.85), slopes
    assert np.all(steps[-1] < 1e-4), steps


def test_free_strip_is_a_beam():
    """ν = 0, slender: free–free Euler beam, (βL)² = 22.373, 61.673; transverse shear is 0.1 % there."""
    strip = Sheet(length_x=1.0, length_y=0.05, thickness=2e-3)
    material = Material(young=1e7, poisson=0.0, density=1000.0)
    got = modes(clamped(strip, material=material), "plate", (24, 2), count=6)
    bending = np.sqrt(1e7 * strip.thickness**2 / (12 * 1000.0)) / (2 * np.pi)
    np.testing.assert_allclose(got.frequencies[:2], bending * np.array([22.3733, 61.6728]), rtol=1e-3)


def test_in_plane_rod():
    """A wide bar between rollers, ν = 0: axial modes (2i − 1)/4 c/L appear with the bending modes."""
    bar = Sheet(length_x=1.0, length_y=0.2, thickness=0.2)
    material = Material(young=1e7, poisson=0.0, density=1000.0)
    got = modes(clamped(bar, "x0", material=material), "plate", (8, 2), count=8)
    points = np.array([[1.0, 0.05], [1.0, 0.15]])
    moves = [np.abs(shape) for shape in got.displacement(points)]
    axial = [f for f, u in zip(got.frequencies, moves, strict=True) if u[:, 0].min() > 10 * u[:, 1:].max()]
    assert axial[0] == pytest.approx(np.sqrt(1e7 / 1000.0) / 4, rel=1e-3)


@pytest.mark.parametrize(
    ("supports", "expected"),
    [
        ([], 6),
        ([{"edge": "x0", "kind": "hinged"}], 1),
        ([{"edge": "x0", "kind": "held", "components": ["z"]}], 4),
        ([{"edge": "x0", "kind": "held", "components": ["x"]}, {"edge": "y0", "kind": "clamped"}], 0),
    ],
)
@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_rigid_motions_left_out(supports, expected, model):
    """As many zero frequencies as rigid motions, no more: the first elastic one is far from zero."""
    scene = clamped(THIN).replace(supports=supports)
    got = modes(scene, model, 4, count=4)
    assert got.rigid == expected
    assert got.frequencies[0] * factor(scene) > 1.0


@pytest.mark.parametrize("model", ["plate", "solid"])
def test_rigid_motions_have_the_mass_and_the_moments_of_inertia_of_the_sheet(model):
    """About its middle, through the thickness too; quadrature is exact for products of linear motions."""
    sheet = Sheet(length_x=0.3, length_y=0.2, thickness=0.05)
    still = SHEETS[model](clamped(sheet), (3, 2))
    a, b, h = 0.3, 0.2, 0.05
    squares = [1.0, 1.0, 1.0, (b**2 + h**2) / 12, (a**2 + h**2) / 12, (a**2 + b**2) / 12]
    arms = np.pad(still.plan.nodes - still.plan.nodes.mean(axis=0), ((0, 0), (0, 1)))
    at_rest, up = np.zeros_like(arms), np.tile([0.0, 0.0, 1.0], (len(arms), 1))
    motions = [(at_rest + axis, at_rest) for axis in np.eye(3)]
    motions += [(np.cross(axis, arms), np.cross(axis, up)) for axis in np.eye(3)]
    rigid = np.array([still.of_vectors(*motion) for motion in motions]).T
    inertia = rigid.T @ still.mass @ rigid
    np.testing.assert_allclose(inertia, STEEL.density * a * b * h * np.diag(squares), atol=1e-10)


def test_hinged_plate():
    """All edges hinged, thin: 2π² = 19.74 and 5π² twice (a soft hinge is a little softer); in all models."""
    scene = clamped(THIN).replace(supports=[Hinged(edge=edge) for edge in scenes.EDGES])
    for model in ("plate", "shell", "solid"):
        got = modes(scene, model, 12, count=3).frequencies * factor(scene)
        np.testing.assert_allclose(got, np.pi**2 * np.array([2.0, 5.0, 5.0]), rtol=5e-3)


def test_shapes_are_orthonormal_and_sampled():
    """Mirror-symmetric supports give symmetric or antisymmetric shapes; modal masses are 1."""
    got = modes(scenes.load("one-edge-clamped"), "plate", 8, count=4)
    points = np.array([[0.188, 0.188], [0.188, 0.0], [0.0, 0.05]])
    for mode in range(4):
        tip, mirrored, root = got.displacement(points)[mode][:, 2]
        assert abs(tip) == pytest.approx(abs(mirrored), rel=1e-6)
        assert root == 0.0
    w = got.shapes[0, :, 2]
    mass = 1678.0 * 0.003 * 0.188**2
    assert 0.1 / mass < np.mean(w**2) < 1.0 / mass * 4
