"""Rubber lattices of every law against closed forms of homogeneous stretches."""

import warnings
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from rubbers import LAWS, rubber, stored
from scipy.optimize import brentq

import fem_reference
import lumped
from lumped import System, build_problem, step_limit
from lumped.assembly import Assembly
from lumped.statics import validity
from sheetbench import scenes
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Scene, Sheet, load

EXAMPLES = Path(__file__).parents[3] / "examples" / "rubber"

THICKNESS, SIDES = 2e-3, (0.2, 0.1)
SHEET = Sheet(*SIDES, THICKNESS)


def slopes(material, stretches):
    """∂W/∂λ of the three principal stretches [Pa], by a complex step."""
    return np.imag(stored(material, np.asarray(stretches) + 1e-30j * np.eye(3))) / 1e-30


def thickness(material, one, other):
    """The third stretch, with which nothing pulls through the thickness."""
    return brentq(lambda t: slopes(material, (one, other, t))[2], 0.05, 2.5, xtol=1e-15, rtol=1e-14)


def forces(material, one, other):
    """Forces per length [N/m] that hold two stretches."""
    return THICKNESS * slopes(material, (one, other, thickness(material, one, other)))[:2]


def alone(material, stretch):
    """The stretch across, where nothing pulls across."""
    return brentq(lambda w: forces(material, stretch, w)[1], 0.6, 1.4, xtol=1e-15, rtol=1e-14)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("poisson", [0.3, 0.4999])
@pytest.mark.parametrize("way", ["uniaxial", "pure shear", "equibiaxial"])
@pytest.mark.parametrize("stretch", [0.7, 1.01, 1.3, 2.0])
def test_a_stretched_lattice_pulls_as_the_law_does(law, poisson, way, stretch):
    """Two stretches imposed on all masses: the forces on two edges."""
    material = rubber(law, poisson)
    across = {"uniaxial": alone, "pure shear": lambda *_: 1.0, "equibiaxial": lambda _, one: one}[way](
        material, stretch
    )
    springs = lumped.calibrate(SHEET, material, grid=(4, 3), method="hyperelastic")
    assembly = Assembly(SHEET, springs)
    x, y, _ = assembly.lattice.positions.T
    u = np.zeros_like(assembly.lattice.positions)
    u[:, 0], u[:, 1] = (stretch - 1.0) * x, (across - 1.0) * y
    force = assembly.force(u)[1]
    along = force[np.isclose(x, SIDES[0]), 0].sum() / SIDES[1]
    beside = force[np.isclose(y, SIDES[1]), 1].sum() / SIDES[0]
    wanted = forces(material, stretch, across)
    assert np.allclose((along, beside), wanted, rtol=1e-9, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("law", LAWS)
def test_every_modulus_is_met_at_small_strains(law):
    for options in ({}, {"grid": (4, 6, 3)}, {"grading": 0.5}):
        springs = lumped.calibrate(
            SHEET, rubber(law, 0.49), **{"grid": (5, 4), **options}, method="hyperelastic"
        )
        assert max(abs(row["miss"]) for row in springs.moduli) < 1e-11


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("name", "law", "truth"),
    [  # mm: solid of 12 elements; extrapolated from 6, 8 and 12 the square is at 25.629 and 25.199
        ("inflated-square", {"law": "neo-hookean"}, 25.630),
        ("inflated-square", {"law": "mooney-rivlin", "c1": 133779.26, "c2": 33444.816}, 25.199),
        ("strip", {"law": "neo-hookean"}, 199.987),
        ("strip", {"law": "mooney-rivlin", "c1": 668896.3, "c2": 167224.08}, 233.555),
    ],
)
def test_seventeen_masses_are_the_solid_at_large_stretch(name, law, truth):
    """A clamped square blown up to a quarter of its side; a clamped strip pulled to twice its length."""
    with warnings.catch_warnings(action="error"):
        scene = load(EXAMPLES / f"{name}.toml")
    material = scene.material.model_dump(
        include={"poisson", "density"} | ({"young"} if len(law) == 1 else set())
    )
    scene = scene.replace(material=Material(**material, **law))
    solution = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, 17, "hyperelastic"))
    assert solution.status is Status.CONVERGED
    moved = np.abs(solution.displacement(scene.probe_points()[:1])).max()
    assert 1e3 * moved == pytest.approx(truth, rel=1e-3)


@pytest.mark.parametrize("solve", [lumped.solve, partial(fem_reference.solve, elements=(2, 1))])
def test_a_strip_moved_beyond_gents_limit_is_told_with_the_limit(solve):
    far = {"time": [0.0, 1.0], "displacement": [[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]]}
    held = [{"edge": "x0", "kind": "clamped"}, {"edge": "x1", "kind": "clamped", "motion": far}]
    scene = Scene(name="far", sheet=SHEET, material=rubber("gent", 0.49).replace(limit=2.0), supports=held)
    found = solve(scene)
    assert found.status is Status.NON_FINITE and 0.5 < found.load_factor < 1.0
    assert "to limit = 2" in found.message


def test_neo_hookean_is_hyperelastic_of_a_material_without_another_law():
    linear = load("one-edge-clamped").material
    plain, own = (lumped.calibrate(SHEET, linear, grid=5, method=m) for m in ("neo-hookean", "hyperelastic"))
    assert plain.springs == own.springs and plain.method == "neo-hookean"
    with pytest.raises(BadInput, match="the material's law is 'gent'; take 'hyperelastic'"):
        lumped.calibrate(SHEET, rubber("gent"), grid=5, method="neo-hookean")


def strip(supports, loads=(), **others):
    """200 × 100 × 2 mm of silicone."""
    return Scene("strip", SHEET, Material(5e6, 0.45, 1000.0, **others), supports=supports, loads=loads)


def lattice(scene, grid=(4, 3), **options):
    return lumped.calibrate(scene.sheet, scene.material, grid=grid, method="hyperelastic", **options)


def test_bending_on_habibis_sheet_is_of_second_order_at_least():
    """uz of the corner P4 with two edges clamped: −13.518 mm by neo-Hookean shells of 8 and 16 elements a
    side. With all shear in the faces on the cells' sides 9 masses are 1.3 % off, and 17 masses 0.3 %."""
    scene = scenes.load("two-edges-clamped")
    errors = []
    for masses in (9, 17):
        found = lumped.solve(scene, lattice(scene, masses)).displacement(np.array([scene.probes["P4"]]))
        errors.append(abs(1e3 * found[0, 2] / -13.518 - 1.0))
    assert errors[0] < 5e-3 and errors[1] < 1e-3


def test_the_largest_frequency_does_not_grow_under_stretch():
    """Upright faces resist their director's turning alone; by the chord's length too it would double."""
    scene = strip([{"edge": "x0", "kind": "clamped"}])
    system = System(scene, build_problem(scene, lattice(scene, (5, 4))))
    x = system.assembly.lattice.positions
    at_rest = step_limit(system, np.zeros_like(x)).frequency
    for across in (2.0**-0.45, 1.0, 2.0):
        u = x * [1.0, across - 1.0, 0.0]
        assert 0.9 * at_rest < step_limit(system, u).frequency < 1.01 * at_rest


def test_midpoint_steps_far_too_long_are_a_status_not_a_traceback():
    """200 % of strain in three steps: numbers overflow, and with dampers in the tangent too."""
    load = {"kind": "edge", "edge": "x1", "force_per_length": [4000.0, 0.0, 0.0]}
    scene = strip([{"edge": "x0", "kind": "clamped"}], [load], damping_time=2e-4)
    history = lumped.simulate(scene, lattice(scene, (9, 5)), duration=0.02, integrator="midpoint")
    assert history.status is Status.DIVERGED and "at 0 s" in history.message


def test_what_the_law_cannot_do_is_refused_by_name():
    scene = strip([{"edge": "x0", "kind": "clamped"}])
    with pytest.raises(ValueError, match="cannot have area, stretch and shear"):
        scenes.SpringSet.model_validate({**lattice(scene).springs.model_dump(), "area": 1.0})


def test_layers_that_shear_alike_hold_all_the_energy_in_their_mean_stretch():
    """Links along sides have no energy of a shear along them; layers displaced oppositely have no mean."""
    sheet = Sheet(length_x=0.1, length_y=0.1, thickness=1e-3)
    material = Material(young=1e6, poisson=0.45, density=1000.0)
    assembly = Assembly(sheet, lumped.calibrate(sheet, material, grid=5, method="hyperelastic"))
    points, height = assembly.lattice.positions, assembly.lattice.positions[:, 2:]
    alike = 0.02 * points[:, [1, 0, 2]] * [1.0, 1.0, 0.0]
    for u, share in ((alike, 1.0), (alike * np.sign(height), 0.0)):
        found = assembly.survey(u)
        assert found.energies["axial"] < 0.01 * found.energies["rubber"]
        assert validity._stretch_share(assembly, u, found) == pytest.approx(share, abs=0.01)
