"""Laws of strain in shell and solid: triads, tangents, closed forms, patches, and the lattice beside them."""

from functools import partial

import numpy as np
import pytest
from cases import CLAMP, OBLONG, sheet
from commands import json_of, run
from dynamic_cases import springs
from rubbers import material

import fem_reference
import lumped
from fem_reference.shell.element import Element
from fem_reference.shell.hyperelastic import HyperelasticElement
from fem_reference.shell.laws import LAWS
from fem_reference.shell.transverse_shear import shear_energy
from fem_reference.solid.materials import LAWS as SOLID_LAWS
from fem_reference.surface.materials import plane_stress, section_of, shear_modulus
from fem_reference.verification import verify
from fem_reference.verification.rows import EXACT
from fem_reference.verification.strain_laws import LARGE, RUBBERS, STRAINS, WAYS, pulled
from sheetbench.answers.solution import Status
from sheetbench.choices import STRAIN_LAW, STRAIN_LAWS
from sheetbench.errors import BadInput
from sheetbench.scenes import (
    EdgeLoad,
    FactorTable,
    Gravity,
    Material,
    Pressure,
    Scene,
    outside_model,
    weight_strain,
)
from sheetbench.scenes.objects.material import WORDS

PLAN = np.array([[0, 0], [2, 0.1], [2.1, 1.2], [-0.1, 1], [1, 0.05], [2.05, 0.65], [1, 1.1], [-0.05, 0.5]])
NODES = np.concatenate([PLAN, PLAN[4:].mean(axis=0, keepdims=True)])[None]


@pytest.fixture
def rng():
    return np.random.default_rng(5)


def slopes(function, at, step=1e-6):
    """∂f/∂x by central differences, the last axis that of x (…, n)."""
    moves = step * np.eye(at.shape[-1])
    return np.stack([(function(at + m) - function(at - m)) / (2.0 * step) for m in moves], axis=-1)


MOONEY = Material.model_validate(
    {"law": "mooney-rivlin", "c1": 80e3, "c2": 20e3, "poisson": 0.499, "density": 1070.0}
)


def test_every_model_has_the_laws_that_the_command_line_lists():
    assert [*STRAIN_LAWS, *WORDS] == list(LAWS) and {*LAWS} - {*SOLID_LAWS} == {"biot"}
    assert fem_reference.options("shell")["law"] == fem_reference.options("solid")["law"] == STRAIN_LAW


@pytest.mark.parametrize("poisson", [-0.2, 0.0, 0.3, 0.49])
@pytest.mark.parametrize("law", LAWS)
def test_shell_laws_are_triads_with_hookes_law_at_small_strain(law, poisson, rng):
    of, strain = material(law, poisson), rng.uniform(-0.1, 0.1, (4, 3))
    function = partial(LAWS[law].response, of)
    found = function(strain)
    by_energy = slopes(lambda e: function(e).value, strain)
    by_stress = slopes(lambda e: function(e).first, strain)
    assert found.first == pytest.approx(by_energy, abs=1e-9)
    assert found.second == pytest.approx(by_stress, abs=1e-9)
    tiny = 1e-10 * rng.uniform(-1.0, 1.0, (4, 3))  # to the last digits
    expected = tiny @ plane_stress(of)
    assert function(tiny).first == pytest.approx(expected, rel=1e-8, abs=1e-17)
    assert np.isnan(function(np.array([-0.6, 0.0, 0.0])).first).any() or law == STRAIN_LAW


@pytest.mark.parametrize("law", LAWS)
def test_elements_through_the_thickness_are_energies_with_their_tangents(law, rng):
    element = HyperelasticElement.of(NODES, material(law), 0.2, LAWS[law])
    strain = 0.05 * rng.normal(size=(1, 54))
    energy = lambda e: np.array([sum(element.energies(e).values())])  # noqa: E731
    assert element.stress(strain) == pytest.approx(slopes(energy, strain), rel=1e-6, abs=1e-9)
    assert element.moduli(strain) == pytest.approx(slopes(element.stress, strain), rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("shear", [1e-4, 0.3, 1.0, 3.0])
def test_a_neo_hookean_face_that_slides_stores_what_simple_shear_does(shear):
    """½ G γ² of I₁ = 3 + γ², whatever γ: at a balloon's clamp the director stands, the surface rises."""
    of, law = material("neo-hookean", 0.4999999), LAWS["neo-hookean"]
    strain, leaning = np.array([0.5 * shear**2, 0.0, 0.0]), np.array([shear, 0.0])
    stretched = float(law.response(of, strain).value) / shear_modulus(of)
    energy = stretched + shear_energy(of.poisson, strain, leaning).value
    assert energy == pytest.approx(0.5 * shear**2, rel=1e-6)


def test_the_same_integrals_with_st_venants_law_are_the_linear_element(rng):
    linear = Element.build(NODES, section_of(material(STRAIN_LAW), 0.2))
    through = HyperelasticElement.of(NODES, material(STRAIN_LAW), 0.2, LAWS[STRAIN_LAW])
    strain = rng.normal(size=(1, 54))
    assert through.stress(strain) == pytest.approx(linear.stress(strain), rel=1e-11)
    assert through.moduli(strain) == pytest.approx(linear.stiffness, rel=1e-11, abs=1e-13)
    assert through.energies(strain) == pytest.approx(linear.energies(strain), rel=1e-11)


def test_strips_stretch_as_closed_forms_say_one_way_and_both_ways():
    rows = verify("strain-laws").rows
    assert len(rows) == (2 * len(STRAIN_LAWS) - 1) * len(WAYS) * len(STRAINS)  # Biot's is the shell's
    assert all(row.passed and row.source == EXACT for row in rows)
    assert {row.case for row in rows} == {"strain-laws"}


def test_rubbers_stretch_to_twice_their_length_as_closed_forms_say():
    rows = verify("rubber").rows
    assert len(rows) == 2 * len(RUBBERS) * 3 * len(LARGE) and len(RUBBERS) == 1 + len(WORDS)
    assert all(row.passed for row in rows), [row for row in rows if not row.passed]


def test_a_law_without_its_constants_is_refused_with_what_to_write():
    for model in ("shell", "solid"):
        with pytest.raises(
            BadInput, match=r"'gent'.*lacks its constants.*\[material\] law = 'gent' with shear and"
        ):
            fem_reference.solve(pulled((1.0, 0.0)), model, elements=2, law="gent")


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("model", "law"), [*(("shell", law) for law in LAWS), *(("solid", law) for law in SOLID_LAWS)]
)
def test_a_patch_of_uneven_elements_is_stretched_evenly(model, law):
    even = {"graded": True} if model == "shell" else {"grading": "edges"}
    scene = pulled((1000.0, 300.0), material=material(law, young=1e6))
    points = np.random.default_rng(1).uniform(0.0, 1.0, (9, 2)) * scene.sheet.lengths
    solution = fem_reference.solve(scene, model, elements=(5, 4), law=law, **even)
    corner = solution.displacement(np.array([scene.sheet.lengths]))[0, :2]
    assert solution.status is Status.CONVERGED
    expected = corner * points / scene.sheet.lengths
    assert solution.displacement(points)[:, :2] == pytest.approx(expected, rel=1e-7, abs=1e-12)


def bent(length=0.2):
    """A clamped strip that bends far under its weight."""
    return sheet(length, 0.05, 0.002, 2e6, weight=9.81)


def test_large_rotations_at_small_strain_know_no_law():
    scene = bent()
    tips = {
        law: fem_reference.solve(scene, "shell", elements=2, law=law).displacement(scene.probe_points())
        for law in STRAIN_LAWS
    }
    size = np.abs(tips[STRAIN_LAW]).max()
    assert size > 0.4 * scene.sheet.length_x
    for tip in tips.values():
        assert np.abs(tip - tips[STRAIN_LAW]).max() < 2e-3 * size


def test_the_law_is_an_option_of_the_reference(capsys):
    arguments = ["one-edge-clamped", "--lumped", "5", "--calibration", "consistent", "--elements", "4"]
    reference = json_of(capsys, "compare", *arguments, "--law", "biot")["solutions"][1]
    assert reference["settings"]["law"] == "biot" and 0.0 < reference["stretch"] < 0.01
    for wrong in (["--law", "hooke"], ["--law", "biot", "--reference", "plate"]):
        assert run("compare", *arguments, *wrong) == 2
    with pytest.raises(BadInput, match="a given section needs the law"):
        section = section_of(material(STRAIN_LAW), 0.01)
        fem_reference.solve(bent(), "shell", elements=2, section=section, law="biot")


def blown(thickness, rubber, pressure):
    """A square, clamped all around, under a pressure [Pa]."""
    loads = (Pressure(value=pressure),)
    return sheet(0.1, 0.1, thickness, material=rubber, held="x0 x1 y0 y1", loads=loads)


@pytest.mark.sweep(4)
@pytest.mark.parametrize(
    ("law", "elements", "found"),
    [
        ("neo-hookean", 2, 0.627),
        ("neo-hookean", 4, 0.599),
        ("neo-hookean", 6, 0.594),
        ("mooney-rivlin", 6, 1.0),
    ],
)
def test_a_square_blown_up_is_followed_to_the_load_at_which_it_softens(law, elements, found):
    """Neo-Hooke's has a limit point of inflation, Mooney's with c2 = c1/4 none up to here. On 4 elements the
    first steps overshoot: corrections grow before they shrink."""
    rubber = next(rubber for rubber in RUBBERS if rubber.law == law)
    scene = blown(0.001, rubber, 20e3)
    solution = fem_reference.solve(scene, "shell", elements=elements)
    assert solution.load_factor == pytest.approx(found, abs=0.01)
    assert solution.displacement([[0.05, 0.05]])[0, 2] > 0.25 * 0.1
    assert solution.comparable or f"beyond load factor {solution.load_factor:.4g}" in solution.message


@pytest.mark.nightly
@pytest.mark.parametrize("elements", [12, 20, 24])
def test_a_square_blown_up_to_a_quarter_of_its_side_converges_as_its_mesh_is_refined(elements):
    """Along the clamps it turns by 45° within a thickness. Solid: 25.231 and 25.244 mm on 10 and 16 bricks;
    CalculiX 25.19 on 9 x 9 a quarter. 24 elements have one size, because the sheet bends much."""
    found = fem_reference.solve(blown(0.003, MOONEY, 9e3), "shell", elements=elements)
    assert found.status is Status.CONVERGED
    assert found.displacement([[0.05, 0.05]])[0, 2] == pytest.approx(25.244e-3, rel=3e-3)


SOFT = Material(young=5e3, poisson=0.3, density=1000.0)


def solved(scene, model, **options):
    if model == "lumped":
        return lumped.solve(scene, springs(scene))
    return fem_reference.solve(scene, model=model, elements=4, **options)


def hanging(last):
    """ρ g a/E = 0.39 × the last factor of the weight's history."""
    history = FactorTable(time=(0.0, 1.0), factor=(1.0, last))
    gravity = Gravity(acceleration=(9.81, 0.0, 0.0), history=history)
    return Scene(name="s", sheet=OBLONG, material=SOFT, gravity=gravity, supports=(CLAMP,))


def test_the_weight_strain_is_that_of_the_last_factor():
    assert weight_strain(hanging(-0.5)) == pytest.approx(0.5 * 1000.0 * 9.81 * 0.2 / 5e3)
    assert weight_strain(hanging(1.0).model_copy(update={"gravity": None})) == 0.0
    assert outside_model(hanging(0.12), 0.5) == ""
    assert outside_model(hanging(0.13), 0.0, "link strain") == "ρ g a/E = 0.051, link strain 0"
    assert "stretched by 0.6" in outside_model(hanging(0.0), 0.6)


@pytest.mark.parametrize(
    "model", ["lumped", pytest.param("plate", marks=pytest.mark.nightly), "shell", "solid"]
)
def test_every_model_judges_the_weight_alike(model):
    light, heavy = solved(hanging(1e-3), model), solved(hanging(0.2), model)
    assert light.status is Status.CONVERGED
    assert heavy.status is Status.STRAIN_OUTSIDE_MODEL and "ρ g a/E = 0.0785" in heavy.message
    assert heavy.load_factor == 1.0 and heavy.comparable


@pytest.mark.parametrize("model", ["lumped", "plate", "shell", "solid"])
def test_every_model_sees_that_it_is_stretched_by_more_than_half(model):
    """ν = 0 and a pull along x: E = 1.3, so that 1 + stretch is the root of q = E h (s + 3 s²/2 + s³/2)."""
    material = Material(young=5e4, poisson=0.0, density=1000.0)
    for stretch, outside in ((0.4, False), (0.6, True)):
        linear = model in ("plate", "lumped")
        pull = stretch if linear else stretch + 1.5 * stretch**2 + 0.5 * stretch**3
        force = (pull * material.young * OBLONG.thickness, 0.0, 0.0)
        loads = (EdgeLoad(edge="x1", force_per_length=force),)
        scene = Scene("s", OBLONG, material, supports=(CLAMP,), loads=loads)
        found = solved(scene, model)
        end = found.displacement(np.array([[0.2, 0.05]]))[0, 0] / 0.2
        assert end == pytest.approx(stretch, rel=0.05)
        assert found.status is (Status.STRAIN_OUTSIDE_MODEL if outside else Status.CONVERGED)


def test_a_law_for_large_strains_is_not_judged_as_a_linear_one():
    assert solved(hanging(0.2), "solid", law="neo-hookean").status is Status.CONVERGED


def made_of(young=200e9, **changed):
    """A sheet under its weight, of a stiff material unless layers or patches have their own."""
    return sheet(1.0, 1.0, 0.08, young, weight=9.81, **changed)


def test_the_weight_strain_is_that_of_the_layers_and_patches():
    """One soft sheet written in three ways, and a laminate of two plies: the mean density over the mean E."""
    soft = {"young": 1e5, "poisson": 0.3}
    alone = weight_strain(made_of(1e5))
    layers = [{"thickness": 0.08, **soft}]
    everywhere = {"rectangle": {"x": [0.0, 1.0], "y": [0.0, 1.0]}}
    assert alone == pytest.approx(9.81e-2)
    assert weight_strain(made_of(layer=layers)) == pytest.approx(alone)
    patches = [{"shape": everywhere, "young": 1e5}]
    assert weight_strain(made_of(patch=patches)) == pytest.approx(alone)
    heavy = {"thickness": 0.02, "young": 3e5, "poisson": 0.3, "density": 3000.0}
    three = weight_strain(made_of(layer=[heavy, {"thickness": 0.04, **soft}, heavy]))
    assert three == pytest.approx(2000.0 * 9.81 / 2e5)


def test_a_soft_layer_over_a_stiff_material_is_outside_the_model():
    layers = [{"thickness": 0.08, "young": 1e5, "poisson": 0.3}]
    scene = made_of(layer=layers)
    for found in (lumped.solve(scene), solved(scene, "shell")):
        assert found.status is Status.STRAIN_OUTSIDE_MODEL
