"""What a reference leaves out on every mesh: the bounds beside what solids and other laws answer."""

from dataclasses import replace

import fake_solutions
import pytest
from cases import relative, sheet

import fem_reference
from comparisons.comparison.comparison import compare
from comparisons.models.spec import Lattice
from comparisons.sweep.model_error import ModelError, model_error
from fem_reference.verification.strain_laws import pulled
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, Hinged, Material, Pressure, Sheet, Symmetric, load

THICK = sheet(0.1, 0.1, 0.015, 1e6, 0.45, 1100.0, held="x0 y0 y1", load=(Pressure(value=-560.0),))

# h/a, ν, clamped; largest stretch and share of stretching in the energy of the shell of 16 elements; how far
# the solid of 10 elements is from it with the same clamp, how far that is from the solid whose clamp holds
# the whole face, and how far the shells with Biot's and neo-Hooke's law are, whichever is farther.
MEASURED = {
    "three-edges-thick": (0.15, 0.45, True, 1.58e-4, 4.46e-4, 0.0118, 0.0826, 5.8e-4),
    "cantilever-thick": (0.12, 0.45, True, 4.1e-4, 3.34e-4, 0.0023, 0.0267, 1.05e-3),
    "cantilever-cork": (0.12, 0.0, True, 2.33e-4, 1.02e-4, 0.0013, 3.1e-4, 9.2e-4),
    "three-edges": (0.05, 0.45, True, 7.8e-4, 0.0115, 0.0014, 0.0243, 2.74e-3),
    "four-edges": (0.1, 0.45, True, 1.54e-6, 1.47e-5, 0.0089, 0.0592, 8.9e-6),
    "four-edges-stiff": (0.1, 0.3, True, 1.78e-6, 1.65e-5, 0.0009, 0.029, 8.6e-6),
    "four-hinged": (0.1, 0.45, False, 1.47e-5, 4.02e-4, 0.0090, 0.0, 9.2e-5),
    "bridge": (0.05, 0.45, True, 6.91e-4, 0.0163, 0.0015, 0.0238, 2.87e-3),
    "two-edges-clamped": (0.016, 0.48, True, 1.26e-3, 0.177, 5.3e-4, 0.0056, 8.4e-4),
    "one-edge-clamped": (0.016, 0.48, True, 1.18e-3, 0.0077, 2.2e-4, 0.0080, 9.8e-5),
    "curved-edge": (0.016, 0.48, True, 5.38e-3, 0.148, 0.0012, 0.0017, 3.71e-3),
    "blown-up": (0.0125, 0.45, True, 0.0126, 0.721, 0.0011, 0.0062, 0.0134),
}


def of_numbers(slenderness, poisson, clamped, stretch, share):
    edge = Clamped(edge="x0") if clamped else Hinged(edge="x0")
    scene = sheet(0.1, 0.2, 0.1 * slenderness, 1e6, poisson, supports=(edge,))
    sheared = (1.0 - share) * slenderness**2  # of the side; these sheets bend over 0.17 to 0.87 of it
    energies = {"membrane": share, "bending": 1.0 - share, "shear": sheared}
    return model_error(scene, fake_solutions.solution(scene, "shell", stretch=stretch, energies=energies))


@pytest.mark.parametrize("name", MEASURED)
def test_it_bounds_what_solids_other_laws_and_other_clamps_answer(name):
    """Without being fifteen times as large."""
    *numbers, solid, clamp, law = MEASURED[name]
    found = of_numbers(*numbers)
    assert max(solid, law) <= found.value
    assert clamp <= found.clamp + found.value
    assert found.value < 15.0 * max(solid, law)


def strip(poisson, **load):
    return sheet(0.1, 0.02, 0.01, 1e6, poisson, loads=(load,))


@pytest.mark.parametrize(
    "scene",
    [
        strip(0.45, kind="edge", edge="x1", moment_per_length=1e-3),
        strip(0.0, kind="pressure", value=1.0),
        strip(0.3, kind="point", at=(0.1, 0.02), force=(0.0, 0.0, 1e-4)),
    ],
    ids=["bent", "pressed", "twisted"],
)
def test_a_strip_is_as_slender_as_it_is_long(scene):
    """Off the solid by 0.06 to 0.5 of the bound, which by its width would be four times as large or more."""
    shell, solid = (fem_reference.solve(scene, model, elements=(10, 2)) for model in ("shell", "solid"))
    off = relative(*(each.displacement(scene.probe_points()) for each in (solid, shell)))
    bound = model_error(scene, shell)
    by_width = (1.2 + 1.3 * scene.material.poisson**2) * 0.5**2
    assert bound is not None and off <= bound.value and bound.thickness < min(0.25 * by_width, 20.0 * off)


def test_a_long_strip_under_its_load_is_within_a_thousandth():
    """h/L = 0.01 and h/b = 0.1: 1.2 % by its width, 1.6e-4 = 1.2 · 4/3 (h/L)² by the energy of its shear."""
    scene = sheet(10.0, 1.0, 0.1, 1.2e9, 0.0, loads=(Pressure(value=20.0),))
    found = model_error(scene, fem_reference.solve(scene, "shell", elements=(10, 1)))
    assert found is not None and found.thickness == pytest.approx(1.6e-4, rel=0.02)


@pytest.mark.parametrize(("clamp", "low", "high"), [("shell-like", 0.005, 0.027), ("full", 0.03, 0.12)])
def test_the_solid_is_within_the_shells_model_error(clamp, low, high):
    """Elements of 25 mm: within a per cent of the measured ones of 10 mm."""
    points = THICK.probe_points()
    shell = fem_reference.solve(THICK, model="shell", elements=8)
    solid = fem_reference.solve(THICK, model="solid", elements=4, clamp=clamp)
    off = relative(solid.displacement(points), shell.displacement(points))
    bound = model_error(THICK, shell)
    assert bound is not None and low < off < high
    assert off < bound.value + (bound.clamp if clamp == "full" else 0.0)


def test_of_plates_and_unstable_answers_nothing_is_said():
    def said(**changes):
        answer = fake_solutions.solution(THICK, "shell", stretch=0.001)
        return model_error(THICK, replace(answer, **changes))

    assert said() is not None
    nothing = ({"model": "plate"}, {"status": Status.UNSTABLE}, {"stretch": None})
    assert [said(**changes) for changes in nothing] == [None] * 3
    solid = said(model="solid")
    assert solid.thickness == 0.0 and solid.strain_law == pytest.approx(2.3e-3)


def test_compare_names_both_parts(compared):
    bar = compared.document()["solutions"][1]["uncertainty"]
    assert bar["mesh"] == bar["error"] and bar["model"] == sum(bar["model_parts"].values()) > 0.0
    assert bar["clamp"] == pytest.approx(0.75 * 0.48 / 0.52 * 0.003 / 0.188)
    said = [note for note in compared.report().notes if note.startswith("shell: ")]
    assert "mesh error ±" in said[0] and "6, 4 and 3 elements" in said[0]
    assert "model error ±" in said[1] and "thickness 0.038 %" in said[1] and "clamp" in said[1]


def test_a_law_of_strain_that_the_user_chose_is_no_error_of_the_model():
    """Both sheets neo-Hookean, pulled to over 1.5 lengths; with the default law it is part of the bound."""
    scene = pulled((2400.0, 0.0), Sheet(length_x=0.1, length_y=0.1, thickness=0.005))
    chosen = compare(scene, Lattice(3, "hyperelastic"), elements=3, law="neo-hookean")
    assert chosen.reference.stretch is not None and chosen.reference.stretch > 0.5
    assert chosen.error(chosen.solutions[0]) == pytest.approx(0.0, abs=1e-3)
    assert chosen.model_error == ModelError(pytest.approx((1.2 + 1.3 * 0.3**2) * 0.05**2), 0.0, 0.0)
    assert not any("law of strain" in note for note in chosen.report().notes)
    mild = pulled((200.0, 0.0), Sheet(length_x=0.1, length_y=0.1, thickness=0.005))
    assert "law of strain" in str(compare(mild, Lattice(3), elements=3).model_error)


def test_a_law_that_the_material_states_is_no_part_of_the_error():
    rubber = Material(young=1e6, poisson=0.49, density=1000.0, law="neo-hookean")
    scene = pulled((3000.0, 0.0), material=rubber)
    for law, part in (("neo-hookean", False), ("biot", True)):
        found = model_error(scene, fem_reference.solve(scene, "shell", elements=2, law=law))
        assert found is not None and (found.strain_law > 0.1) is part


TILTED = tuple(Clamped(edge=edge, tilt=0.3) for edge in ("x0", "x1"))
CORNERED = (Clamped(edge="x0"), Hinged(edge="y0"))
LOADED = [
    sheet(0.15, 0.15, 0.003, 1e6, 0.4, weight=9.81, supports=TILTED, name="arch"),
    sheet(0.16, 0.16, 0.002, 1e6, -0.3, supports=CORNERED, loads=[Pressure(value=-60.0)], name="corner"),
    # bends far and hardly stretches: the first step alone is five times too far
    sheet(0.12, 0.08, 0.0025, 8e5, 0.45, 1100.0, weight=9.81, name="hanging"),
    load("two-edges-clamped"),
    load("curved-edge"),
]


@pytest.mark.sweep(2)
@pytest.mark.parametrize("scene", LOADED, ids=lambda scene: scene.name)
def test_the_law_of_strain_is_weighed_where_the_probes_answer_comes_from(scene):
    """The largest stretch, in a corner, had said eight times as much."""
    shell, *others = (
        fem_reference.solve(scene, elements=4, law=law)
        for law in ("st-venant-kirchhoff", "biot", "neo-hookean")
    )
    assert all(found.status is Status.CONVERGED for found in (shell, *others))
    points = scene.probe_points()
    off = max(relative(found.displacement(points), shell.displacement(points)) for found in others)
    bound = model_error(scene, shell)
    assert bound is not None and off <= bound.strain_law < 1.3 * 1.2 * off


def of_rubber(law, poisson, **constants):
    return Material.model_validate({"law": law, "poisson": poisson, "density": 1070.0, **constants})


MOONEY = of_rubber("mooney-rivlin", 0.499, c1=80e3, c2=20e3)
NEO_HOOKE = of_rubber("neo-hookean", 0.45, young=6e5)
YEOH = of_rubber("yeoh", 0.49, c1=1e5, c2=2e3, c3=1e2)
INFLATED = {  # half the span, thickness [m], pressure [Pa]: a quarter of a square, or half of a wide strip
    "strip-mooney": (MOONEY, 0.002, 4e3, True),
    "strip-yeoh": (YEOH, 0.004, 8e3, True),
    "square-mooney-mildly": (MOONEY, 0.003, 3e3, False),
    "square-neo-hooke": (NEO_HOOKE, 0.003, 8e3, False),
    "square-yeoh": (YEOH, 0.003, 9e3, False),
}
DAILY = "strip-mooney"


@pytest.mark.parametrize(
    "name", [one if one == DAILY else pytest.param(one, marks=pytest.mark.nightly) for one in INFLATED]
)
def test_a_sheet_blown_up_so_far_that_it_turns_within_a_thickness_is_within_it(name):
    """0.4 to 1.1 % off solids whose clamps hold the mean; (h/a)² is a seventh of that, or less."""
    material, thickness, pressure, strip = INFLATED[name]
    held = ("x0", "y0")[: 1 if strip else 2]
    width, planes = (0.02, ("x1", "y0", "y1")) if strip else (0.05, ("x1", "y1"))
    supports = (*(Clamped(edge=edge) for edge in held), *(Symmetric(edge=edge) for edge in planes))
    given = {"supports": supports, "loads": (Pressure(value=pressure),), "probes": {"top": (0.05, width)}}
    scene = sheet(0.05, width, thickness, material=material, **given)
    points = scene.probe_points()
    shell = fem_reference.solve(scene, "shell", elements=(8, 1) if strip else 6)
    solid = fem_reference.solve(scene, "solid", elements=(8, 1) if strip else 5, clamp="mean")
    off = relative(solid.displacement(points), shell.displacement(points))
    bound = model_error(scene, shell)
    assert bound is not None and bound.strain_law == 0.0
    assert 1.5 * (thickness / 0.1) ** 2 < off <= bound.value < 3.0 * off
