"""Sheets with fibres in every model: isotropic constants are the isotropic sheet, and models agree."""

import numpy as np
import pytest
from cases import calibrated, relative, sheet

import fem_reference
import lumped
import lumped.plies
from comparisons.codes.setup import setup
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from fem_reference.surface import plies
from sheetbench.answers.solution import Status
from sheetbench.scenes import Material, Scene, SceneError, load
from sheetbench.scenes.meaning.composition import of_sheet
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
    found = lumped.plies.section(layers, thickness)
    for mine, theirs in zip(found, plies.section(layers, thickness), strict=True):
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
UNLIKE = [{"thickness": 1.5e-3, "angle": angle} for angle in (0.0, np.pi / 2)]
TWISTING = [{"thickness": 1.5e-3, "angle": angle} for angle in (np.pi / 6, -np.pi / 6)]
FILM = [
    {"thickness": 2.9e-3, "young": 1e7, "poisson": 0.45},
    {"thickness": 1e-4, "young": 1e9, "poisson": 0.3, "density": 5e3},
]
SHEETS = {
    **{f"{name} at {angle:.2g}": with_fibres(**fibres, angle=angle)
       for name, fibres in (("rubber", FIBRES), ("strong", STRONG), ("woven", WOVEN))
       for angle in (0.0, np.pi / 6, np.pi / 4)},
    **{name: with_fibres(**FIBRES).replace(layers=layers)
       for name, layers in (("cross-ply", CROSS), ("angles", ANGLED), ("sandwich", SANDWICH),
                            ("0/90", UNLIKE), ("30/-30", TWISTING), ("film", FILM))},
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
        ([{"thickness": 3e-3, "young": 1e6}], "young and poisson: an isotropic layer has both"),
        ([{"thickness": 3e-3, "shear_12": 1e6}], "young_1, young_2, poisson_12 missing"),
    ],
)
def test_what_is_no_laminate_is_refused(layers, said):
    with pytest.raises(SceneError, match=said):
        with_fibres(**FIBRES).replace(layers=layers)


TWO = [  # of different stiffness, without Poisson's effect: beams
    {"thickness": 0.0008, "young": 3e6, "poisson": 0.0, "density": 2e3},
    {"thickness": 0.0012, "young": 1e6, "poisson": 0.0, "density": 1e3},
]
ENDS = np.array([-0.001, -0.0002, 0.001])
A, B, D = ((np.array([3e6, 1e6]) * np.diff(ENDS**n)).sum() / n for n in (1, 2, 3))
MASS, MOMENT = ((np.array([2e3, 1e3]) * np.diff(ENDS**n)).sum() / n for n in (1, 2))
LONG, ALONE = 0.12, D - B**2 / A  # and D where nothing pulls


def of_two_layers(held, **more):
    supports = tuple({"kind": kind, "edge": edge} for edge, kind in held.items())
    probes = {"middle": (0.5 * LONG, 0.01), "end": (LONG, 0.01)}
    return sheet(LONG, 0.02, 0.002, 1e6, 0.0, supports=supports, layers=TWO, probes=probes, **more)


HINGES, CLAMP = {"x0": "hinged", "x1": "hinged"}, {"x0": "clamped"}
BEAMS = {  # a scene and the rise of its middle or its end [m], of lamination theory with shear left out
    "two hinges at the middle of the thickness": (
        of_two_layers(HINGES, loads=({"kind": "pressure", "value": 2e-4},)),
        0,  # whose thrust B q L²/12 D turns each end back by B/A of it
        5 * 2e-4 * LONG**4 / (384 * ALONE) - B**2 / A * 2e-4 * LONG**4 / (96 * D * ALONE),
    ),
    "pulled at the middle of the thickness": (
        of_two_layers(CLAMP, loads=({"kind": "edge", "edge": "x1", "force_per_length": (1e-4, 0, 0)},)),
        1,
        B * 1e-4 * LONG**2 / (2 * (A * D - B**2)),
    ),
    "weight along it, whose centre is not at the middle": (
        of_two_layers(CLAMP, gravity={"acceleration": (1e-3, 0.0, 0.0)}),
        1,  # pulled by ρh g (L − x) at B/A from where that would not bend it, and turned by g ∫ρz dz
        1e-3 * LONG**3 / (3 * ALONE) * (MASS * B / A - MOMENT),
    ),
}


@pytest.mark.filterwarnings("ignore::sheetbench.scenes.Implausible")
@pytest.mark.parametrize("model", ["lumped", "shell", "plate", "solid"])
@pytest.mark.parametrize("name", BEAMS)
def test_layers_that_are_not_symmetric_are_held_and_pulled_at_the_middle_of_the_thickness(name, model):
    scene, probe, exact = BEAMS[name]
    found = (
        lumped.solve(scene, calibrated(scene, (25, 5)))
        if model == "lumped"
        else (fem_reference.solve(scene, model, elements=(12, 2)))
    )
    assert found.balance.holds
    assert found.displacement(scene.probe_points())[probe, 2] == pytest.approx(exact, rel=3e-3)


def test_masses_of_unlike_layers_vibrate_about_the_sheets_centre_of_mass():
    """Shell and lattice as the solid; masses of the lattice cannot balance outside of its layers."""
    scene = of_two_layers(CLAMP)
    lattice = lumped.modes(scene, calibrated(scene, (25, 5)), count=2).frequencies
    shell, solid = (
        fem_reference.modes(scene, model, elements=(12, 2), count=4).frequencies
        for model in ("shell", "solid")
    )
    beam = np.sqrt(ALONE / MASS) * 1.8751**2 / (2 * np.pi * LONG**2)
    assert lattice[0] == pytest.approx(beam, rel=1e-3)
    np.testing.assert_allclose(lattice, solid[:2], rtol=1e-3)
    np.testing.assert_allclose(shell, solid, rtol=1e-3)
    heavy = [{"thickness": 0.0002, "density": 1e6}, {"thickness": 0.0018}]
    odd = [
        {"thickness": 1e-3, "angle": -np.pi / 3},
        {"thickness": 3e-4, "angle": 0.0},
        {"thickness": 7e-4, "angle": np.pi / 2},
    ]
    strong = with_fibres(scene.replace(layers=()), **{**FIBRES, "young_1": 800e6}).replace(layers=odd)
    with pytest.raises(ValueError, match="no springs with 2 layers match the laminate"):
        calibrated(strong, (9, 3))
    with pytest.raises(ValueError, match=r"the centre of mass is 0\.891 mm from the middle"):
        lumped.solve(scene.replace(layers=heavy, gravity={"acceleration": (0.0, 0.0, -1.0)}))


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
    with pytest.raises(ValueError, match="layer: up to 12 equal bricks"):
        fem_reference.solve(scene.replace(layers=uneven), "solid", elements=2)


FABRIC = {
    "name": "fabric",
    "sheet": {"length_x": "30 mm", "length_y": "30 mm"},
    "material": {
        "kind": "stiffness",
        "membrane": {"x": 1e4, "y": 1e4, "shear": 1e3},
        "bending": {"x": "2 µN·m", "y": 1e-6},
        "area_density": "150 g/m²",
        "damping_rate": 2.0,
    },
    "gravity": {"acceleration": (0.0, 0.0, -9.81)},
    "support": [{"kind": "clamped", "edge": "x0"}],
}


SOLID = {"kind": "isotropic", "young": 1e6, "poisson": 0.3, "density": 1e3}


def fabric(thickness=None, **material):
    sheet = FABRIC["sheet"] | ({} if thickness is None else {"thickness": thickness})
    return Scene(**FABRIC | {"sheet": sheet, "material": FABRIC["material"] | material})


@pytest.mark.parametrize(
    ("thickness", "own"),
    [
        (None, {}),
        ("0.4 mm", {}),
        (None, {"membrane": 1e4, "bending": 1e-6, "poisson": 0.3}),  # one layer is both
        ("0.3 mm", {"bending": {"x": 2e-6, "y": 1e-6, "coupling": 4e-7, "shear": 3e-7}}),
    ],
)
def test_a_sheet_has_the_stiffnesses_that_it_is_given_by(thickness, own):
    """The laminate's A and D by both derivations are those of the file, B is 0 and the mass is right."""
    scene, material = fabric(thickness, **own), Material(**FABRIC["material"] | own)
    constants = of_sheet(scene)
    for derived in (lumped.plies, plies):
        membrane, bending, _, mixed = derived.section(constants.plies, constants.thickness)
        for found, key in ((membrane, "membrane"), (bending, "bending")):
            wanted = material.stiffness(key)
            assert found == pytest.approx(wanted, rel=1e-9, abs=1e-9 * wanted.max())
        assert np.abs(mixed).max() < 1e-12 * membrane.max()
    assert constants.per_area == pytest.approx(0.15, rel=1e-12) and scene.material.damping_rate == 2.0
    assert len(scene.layers) == (0 if "poisson" in own else 3)
    assert Scene.model_validate(scene.document()) == scene


def test_a_fabric_is_refused_with_the_numbers_of_another_solver():
    """A11, A22 and A66 as they are given, and A12 where there is one."""
    for membrane, said in (({}, "10000, 10000, 1000 N/m$"), ({"coupling": 2e3}, "N/m, .* A12 = 2000 N/m$")):
        scene = fabric(membrane=FABRIC["material"]["membrane"] | membrane)
        with pytest.raises(SceneError, match=f"Newton's Style3D solver takes tri_aniso_ke = .*{said}"):
            setup(scene, "newton")


@pytest.mark.parametrize(
    ("thickness", "own", "said"),
    [
        ("50 µm", {}, "too thin for that bending stiffness.*at least 9.21e-05 m"),
        (None, {"membrane": {"x": 1e4, "y": 1e4, "coupling": 2e4}}, r"material\.membrane: coupling² must be"),
        ("1 mm", {"bending": None}, "kind = 'stiffness': bending missing"),
        ("1 mm", {"bending": "3 N"}, r"material\.bending = '3 N': must be a number"),
        ("1 mm", SOLID, "membrane, bending, area_density: for kind"),
    ],
)
def test_stiffnesses_of_no_sheet_are_refused(thickness, own, said):
    with pytest.raises(SceneError, match=said):
        fabric(thickness, **own)


@pytest.mark.nightly
@pytest.mark.parametrize(("side", "grading"), [("30 mm", None), ("55 mm", 0.5)])
def test_a_hanging_fabric_is_alike_in_lattice_and_shell(side, grading):
    """It bends within (D/ρgh)^⅓ = 11 mm of the clamp. At 55 mm even cells are 4.3, 1.07 and 0.34 % off on 9,
    17 and 33 masses, second order in the cell over that length; smaller ones there 0.6 % on 17."""
    scene = Scene(**FABRIC | {"sheet": {"length_x": side, "length_y": side}})
    points = scene.probe_points()
    springs = resolve(scene, Lattice(17, grading=grading)).springs
    lattice = lumped.solve(scene, springs).displacement(points)
    shell = fem_reference.solve(scene, "shell", elements=16).displacement(points)
    assert np.abs(lattice - shell).max() < 0.01 * np.abs(shell).max()
