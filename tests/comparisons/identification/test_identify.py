"""The inverse question: known parameters found again, intervals that hold what they promise, and bad data."""

import numpy as np
import pytest
import pyvista
from cases import POINTS, with_material

import lumped
from comparisons.identification import surface
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements, Surface, read
from comparisons.identification.model import NotReached
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.parameters import put

SCENE = scenes.load("two-edges-clamped")
CANTILEVER = scenes.load("one-edge-clamped")
TRUE = 40e6


def lattice(scene, grid=(9, 9)):
    return lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid))


@pytest.fixture(scope="module")
def truth():
    """Displacement (64, 3) of the lattice with E = 40 MPa."""
    return lattice(with_material(SCENE, young=TRUE)).displacement(POINTS)


def noisy(values, rng, share=0.01):
    return values + rng.normal(scale=share * np.abs(values).max(), size=values.shape)


def test_exact_data_give_the_value_back(truth):
    found = identify(SCENE, Displacements(POINTS, truth), ["young"], Lattice(9))
    assert found.converged and found.explained and np.abs(found.residuals).max() < 1e-9
    assert found.unknowns["young"].value == pytest.approx(TRUE, rel=1e-6)


@pytest.mark.parametrize(("name", "true"), [("obstacle1.z", -0.024), ("obstacle1.radius", 0.0165)])
def test_where_an_obstacle_is_and_how_thick_are_found_again(name, true):
    scene, points = scenes.load("finger-on-cylinder"), np.array([[0.03, 0.005], [0.06, 0.015], [0.1, 0.01]])
    measured = Displacements(points, lattice(put(scene, name, true), (9, 3)).displacement(points))
    found = identify(scene, measured, [name], Lattice((9, 3, 2)), refine=False)
    assert found.converged and found.unknowns[name].value == pytest.approx(true, rel=1e-6)


def test_the_interval_holds_the_true_value_in_17_of_20_draws():
    """1 % of the largest displacement as noise in every component; the search starts up to 65 % away."""
    rng = np.random.default_rng(11)
    truth = lattice(with_material(SCENE, young=TRUE), (3, 3)).displacement(POINTS)
    hits, widths = 0, []
    for _ in range(20):
        start = with_material(SCENE, young=TRUE * float(np.exp(rng.uniform(-0.5, 0.5))))
        measured = Displacements(POINTS, noisy(truth, rng))
        found = identify(start, measured, ["young"], Lattice((3, 3, 2)), refine=False)
        low, high = found.unknowns["young"].interval
        hits += low <= TRUE <= high
        widths.append((high - low) / TRUE)
    assert hits >= 17
    assert 0.005 < np.median(widths) < 0.05


@pytest.mark.sweep(2)
@pytest.mark.parametrize("model", ["lumped", "shell"])
def test_constants_of_patches_are_found_again(model):
    """Of a sheet with a hole, from the model's own answer."""

    def part(x, y=(0.0, 0.188)):
        return {"shape": {"rectangle": {"x": x, "y": y}}}

    patches = [{**part((0.0, 0.06)), "young": 2e8}, {**part((0.12, 0.188)), "thickness": 0.002}]
    true = CANTILEVER.replace(cutouts=[part((0.08, 0.1), (0.06, 0.12))], patches=patches)
    guess = put(put(true, "patch1.young", 1.5e8), "patch2.thickness", 0.0022)
    at = POINTS[(POINTS[:, 0] < 0.08) | (POINTS[:, 0] > 0.1)]
    spec = Lattice(4) if model == "lumped" else Elements("shell", 4)
    measured = Displacements(at, solve(resolve(true, spec)).displacement(at))
    size = {"lattice": spec} if model == "lumped" else {"model": spec}
    found = identify(guess, measured, ["patch1.young", "patch2.thickness"], refine=False, **size)
    values = [found.unknowns[name].value for name in ("patch1.young", "patch2.thickness")]
    assert values == pytest.approx([2e8, 0.002], rel=1e-3)
    with pytest.raises(BadInput, match=r"row 0, .* x, y = 0.09, 0.09 is off the sheet"):
        identify(guess, Displacements(np.array([[0.09, 0.09]]), np.full((1, 3), 1e-3)), lattice=Lattice(4))
    with pytest.raises(BadInput, match="of a sheet with an outline or cutouts give displacements"):
        identify(guess, Surface(np.ones((9, 3)) * 1e-3), lattice=Lattice(4))


def test_a_clamps_tilt_is_told_from_young():
    """A turn is straight along the sheet, bending is not; the two are alike, though, and that is said."""
    values = lattice(put(with_material(CANTILEVER, young=TRUE), "tilt_x0", 0.03)).displacement(POINTS)
    found = identify(CANTILEVER, Displacements(POINTS, values), ["young", "tilt_x0"], Lattice(9))
    assert found.converged and np.abs(found.residuals).max() < 1e-9
    assert found.unknowns["young"].value == pytest.approx(TRUE, rel=1e-6)
    assert found.unknowns["tilt_x0"].value == pytest.approx(0.03, abs=1e-7)
    assert found.unknowns["tilt_x0"].unit == "rad"
    assert any("cannot tell young from tilt_x0 (correlation +0.98" in said for said in found.warnings)


def test_a_scanned_surface(tmp_path):
    """Scattered points of a finer lattice's deformed top face, without knowing which is which."""
    rng = np.random.default_rng(6)
    plan = rng.uniform(0.0, 0.188, (300, 2))
    axes = surface.plan_grid((0.188, 0.188), (17, 17))
    deformed = lattice(with_material(SCENE, young=TRUE), (17, 17)).displacement(surface.plan_points(axes))
    field = surface.Field(axes, deformed)
    on = np.column_stack([plan, np.zeros(300)]) + field.at(plan)
    feet = surface.feet(axes, field, on)
    assert np.abs(feet.distances).max() < 1e-9 and np.abs(feet.points - plan).max() < 1e-6
    top = on + 0.0015 * feet.normals + rng.normal(scale=2e-5, size=on.shape)
    for suffix in (".ply", ".vtp"):
        path = tmp_path / f"scan{suffix}"
        pyvista.PolyData(top).save(path)
        measured = read(path, SCENE)
        assert isinstance(measured, Surface) and len(measured.points) == 300
    found = identify(SCENE, measured, ["young"], Lattice((17, 17, 2)), offset=0.0015)
    low, high = found.unknowns["young"].interval
    assert low < TRUE < high and high / low < 1.02
    assert found.noise == pytest.approx(2e-5, rel=0.15)


def test_no_answer_with_the_scenes_own_values(truth):
    with pytest.raises(NotReached):
        identify(with_material(SCENE, young=1e3), Displacements(POINTS, truth), ["young"])
