"""Sheets with fibres in every model: isotropic constants are the isotropic sheet, and models agree."""

import numpy as np
import pytest
from cases import calibrated, relative

import fem_reference
import lumped
import lumped.plies
from fem_reference.surface import plies
from sheetbench.answers.solution import Status
from sheetbench.scenes import Material, SceneError, load
from sheetbench.scenes.objects.orthotropy import Ply

PLAIN = load("two-edges-clamped")
FIBRES = dict(young_1=54.5e6, young_2=8e6, poisson_12=0.35, shear_12=4e6, shear_13=3e6, shear_23=2e6)


def with_fibres(scene=PLAIN, **constants):
    return scene.replace(material=Material(kind="orthotropic", density=scene.material.density, **constants))


def answer(scene, model):
    """Of 9 × 9 masses, or 4 elements."""
    if model == "lumped":
        return lumped.solve(scene)
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
    for mine, theirs in zip(found, (membrane, bending, shear), strict=True):
        assert mine == pytest.approx(theirs, rel=1e-12, abs=1e-12 * np.abs(theirs).max())


@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 2])
def test_the_energy_of_even_strains_in_the_plane_is_the_sheets(angle):
    """Of all springs together, the thickness free to change: ½ ε·A ε of the area, for any strain."""
    scene = with_fibres(**FIBRES, angle=angle)
    problem = lumped.build_problem(scene, calibrated(scene, 5))
    x = problem.assembly.lattice.positions
    area = scene.sheet.length_x * scene.sheet.length_y
    membrane = lumped.sections_of(scene, (5, 5, 2)).membrane[0, 0]

    def stored(strain, thinning):
        gradient = np.array(
            [[strain[0], 0.5 * strain[2], 0], [0.5 * strain[2], strain[1], 0], [0, 0, thinning]]
        )
        return problem.assembly.force(1e-6 * x @ gradient)[0] * 1e12

    for strain in (*np.eye(3), np.array([1.0, -0.7, 0.4])):
        at = np.array([stored(strain, thinning) for thinning in (-1.0, 0.0, 1.0)])
        least = at[1] - (at[2] - at[0]) ** 2 / (8.0 * (at[0] - 2.0 * at[1] + at[2]))
        # Green's strains have a square of 1e-6 in them
        assert least == pytest.approx(0.5 * area * strain @ membrane @ strain, rel=1e-5)


STRONG = dict(young_1=200e6, young_2=8e6, poisson_12=0.3, shear_12=4e6)
WOVEN = dict(young_1=50e6, young_2=50e6, poisson_12=0.2, shear_12=2e6)
CROSS = [{"thickness": 7.5e-4, "angle": angle} for angle in (0.0, np.pi / 2, np.pi / 2, 0.0)]
ANGLED = [{"thickness": 7.5e-4, "angle": angle} for angle in (0.5, -0.8, -0.8, 0.5)]
SANDWICH = [{"thickness": 5e-4}, {"thickness": 2e-3, "young": 1e6, "poisson": 0.3}, {"thickness": 5e-4}]
SHEETS = {
    **{f"{name} at {angle:.2g}": with_fibres(**fibres, angle=angle)
       for name, fibres in (("rubber", FIBRES), ("strong", STRONG), ("woven", WOVEN))
       for angle in (0.0, np.pi / 6, np.pi / 4)},
    **{name: with_fibres(**FIBRES).replace(layers=layers)
       for name, layers in (("cross-ply", CROSS), ("angles", ANGLED), ("sandwich", SANDWICH))},
}  # fmt: skip


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", SHEETS)
def test_lattice_and_shell_agree(name):
    scene = SHEETS[name]
    springs = calibrated(scene, 17)
    assert all(abs(row["miss"]) < 1e-9 for row in springs.moduli)
    found, shell = lumped.solve(scene, springs), fem_reference.solve(scene, "shell", elements=12)
    points = scene.probe_points()
    assert found.balance.holds and relative(found.displacement(points), shell.displacement(points)) < 0.02


@pytest.mark.parametrize(
    ("layers", "said"),
    [
        (CROSS[:3], "layer: thicknesses add up to 0.00225 m; the sheet's is 0.003 m"),
        ([CROSS[0], CROSS[1], CROSS[0], CROSS[1]], "layer: 1 is not 4 from the other face"),
        ([{"thickness": 3e-3, "young": 1e6}], "young and poisson: an isotropic layer has both"),
        ([{"thickness": 3e-3, "shear_12": 1e6}], "young_1, young_2, poisson_12 missing"),
    ],
)
def test_what_is_no_laminate_is_refused(layers, said):
    with pytest.raises(SceneError, match=said):
        with_fibres(**FIBRES).replace(layers=layers)


def test_the_solid_has_a_brick_or_more_for_every_layer():
    """Bent and vibrating as the shell, whose shear stiffness is that of cylindrical bending."""
    scene = with_fibres(load("one-edge-clamped"), **FIBRES).replace(layers=CROSS)
    found, shell = (fem_reference.solve(scene, model, elements=4) for model in ("solid", "shell"))
    assert found.status is Status.CONVERGED and found.balance.holds and found.settings["layers"] == 4
    moved, expected = (each.displacement(scene.probe_points()) for each in (found, shell))
    assert np.abs(moved - expected).max() < 0.01 * np.abs(expected).max()
    own, known = (
        fem_reference.modes(scene, model, elements=4, count=3).frequencies for model in ("solid", "shell")
    )
    assert np.allclose(own, known, rtol=0.01)
    uneven = [{"thickness": h, "angle": 0.1 * h} for h in (0.00095, 0.0011, 0.00095)]
    with pytest.raises(ValueError, match="layer: the solid has 12 bricks of one height at most"):
        fem_reference.solve(scene.replace(layers=uneven), "solid", elements=2)
