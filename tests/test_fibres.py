"""Sheets with fibres in every model: isotropic constants are the isotropic sheet, and models agree."""

import numpy as np
import pytest

import fem_reference
import lumped.plies
from fem_reference.surface import plies
from sheetbench.scenes import Material, load
from sheetbench.scenes.orthotropy import Ply

PLAIN = load("two-edges-clamped")
YOUNG, POISSON = PLAIN.material.young, PLAIN.material.poisson
SAME = dict(young_1=YOUNG, young_2=YOUNG, poisson_12=POISSON, shear_12=YOUNG / (2.0 * (1.0 + POISSON)))
FIBRES = dict(young_1=54.5e6, young_2=8e6, poisson_12=0.35, shear_12=4e6, shear_13=3e6, shear_23=2e6)


def with_fibres(scene=PLAIN, **constants):
    return scene.replace(material=Material(kind="orthotropic", density=scene.material.density, **constants))


def answer(scene, model):
    return fem_reference.solve(scene, model, elements=4)


def both(scene, other, *models):
    fields = [answer(scene, models[0]), answer(other, models[-1])]
    assert all(field.balance.holds for field in fields)
    return (field.displacement(scene.probe_points()) for field in fields)


def test_two_derivations_of_the_section_agree():
    """Tensors turned in the references, invariants in the lattice, of three unlike plies."""
    angles = np.random.default_rng(0).uniform(-3.0, 3.0, (3, 5))
    ends = ((-0.5, -0.2), (-0.2, 0.1), (0.1, 0.5))
    layers = [
        Ply(*z, 50e6, 5e6, 5e6, 0.3, 0.3, 0.3, 3e6, 2e6, 1e6, t, 1e3)
        for z, t in zip(ends, angles, strict=True)
    ]
    thickness = np.linspace(0.001, 0.002, 5)
    membrane, bending, shear = plies.section(layers, thickness)
    found = lumped.plies.section(layers, thickness)
    for mine, theirs in zip(found, (membrane, bending, np.diagonal(shear, axis1=1, axis2=2)), strict=True):
        assert mine == pytest.approx(theirs, rel=1e-12, abs=1e-12 * np.abs(theirs).max())


@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_isotropic_constants_are_the_isotropic_sheet(model):
    plain, found = both(PLAIN, with_fibres(**SAME, angle=0.3), model)
    assert found == pytest.approx(plain, rel=1e-8, abs=1e-8 * np.abs(plain).max())


@pytest.mark.parametrize("model", ["plate", "shell", "solid"])
def test_a_quarter_turn_exchanges_the_constants(model):
    swapped = dict(young_1=8e6, young_2=54.5e6, poisson_12=0.35 * 8.0 / 54.5, shear_12=4e6)
    swapped |= dict(shear_13=2e6, shear_23=3e6, young_3=8e6, poisson_13=0.35, poisson_23=0.35)
    turned, found = both(with_fibres(**FIBRES, angle=np.pi / 2), with_fibres(**swapped), model)
    assert found == pytest.approx(turned, rel=1e-8, abs=1e-8 * np.abs(turned).max())


def test_fibres_and_their_mirror_image_move_mirrored():
    """About the diagonal of two clamped edges 30° is 60°."""
    scene = with_fibres(**FIBRES, angle=np.pi / 6)
    one, other = both(scene, with_fibres(**FIBRES, angle=np.pi / 3), "shell")
    mirrored = other[[0, 2, 1, 3]][:, [1, 0, 2]]  # P2 and P3 change places, and x and y
    assert mirrored == pytest.approx(one, abs=1e-7 * np.abs(one).max())


def test_shell_and_solid_agree_on_oblique_fibres():
    """On 8 elements; the solid's are three-dimensional constants, and its sheet can change its thickness."""
    scene = with_fibres(**FIBRES, angle=np.pi / 6)
    shell, solid = (
        fem_reference.solve(scene, model, elements=8).displacement(scene.probe_points())
        for model in ("shell", "solid")
    )
    assert np.abs(shell - solid).max() < 0.005 * np.abs(shell).max()
