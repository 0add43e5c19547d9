"""The inverse question: parameters found again, intervals that hold, and where least squares mislead."""

from dataclasses import replace
from math import log
from types import SimpleNamespace

import numpy as np
import pytest
import pyvista
from cases import POINTS, with_material
from scipy.interpolate import CubicSpline

import fem_reference
import lumped
from comparisons.identification import fit as search
from comparisons.identification import surface
from comparisons.identification.fit import Fit, best_search
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements, Surface, read
from comparisons.identification.model import Model, NoAnswer, Prediction, lattice_model
from comparisons.identification.residuals import UNLIKELY, explained, outliers, runs
from comparisons.identification.unknowns import Unknown, unknown
from comparisons.models.grading import lines_on_shapes
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, Lattice
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes import Relaxation
from sheetbench.scenes.meaning.parameters import parameter, put
from sheetbench.scenes.objects.grading import of_settings

SCENE, CANTILEVER = scenes.load("two-edges-clamped"), scenes.load("one-edge-clamped")
TRUE, SOFT = 40e6, 1.23e6
THICK = with_material(SCENE, young=SOFT, density=1070.0).replace(thickness=0.004)
"""A sheet of which nine masses a side put E 4 % too low."""


def lattice(scene, grid=(9, 9)):
    return lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid))


def solved(scene, grid=(3, 3)):
    return lattice(scene, grid).displacement(POINTS)


def noisy(values, draws, share=0.01):
    """With noise of a share of the largest displacement, from a generator or the seed of one."""
    return values + np.random.default_rng(draws).normal(scale=share * np.abs(values).max(), size=values.shape)


@pytest.mark.parametrize(("name", "true"), [("obstacle1.z", -0.024), ("obstacle1.radius", 0.0165)])
def test_where_an_obstacle_is_and_how_thick_are_found_again(name, true):
    scene, points = scenes.load("finger-on-cylinder"), np.array([[0.03, 0.005], [0.06, 0.015], [0.1, 0.01]])
    measured = Displacements(points, lattice(put(scene, name, true), (9, 3)).displacement(points))
    found = identify(scene, measured, [name], Lattice((9, 3, 2)), refine=False)
    assert found.converged and found.unknowns[name].value == pytest.approx(true, rel=1e-6)


@pytest.mark.nightly
def test_the_interval_holds_the_true_value_in_17_of_20_draws():
    """1 % of the largest displacement as noise in every component; the search starts up to 65 % away."""
    rng = np.random.default_rng(11)
    truth = solved(with_material(SCENE, young=TRUE))
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
    with pytest.raises(BadInput, match="for a sheet with an outline or cutouts give displacements"):
        identify(guess, Surface(np.ones((9, 3)) * 1e-3), lattice=Lattice(4))


def test_a_clamps_tilt_is_told_from_young():
    """A turn is straight along the sheet, bending is not; the two are alike, though, and that is said."""
    values = solved(put(with_material(CANTILEVER, young=TRUE), "tilt_x0", 0.03), (9, 9))
    found = identify(CANTILEVER, Displacements(POINTS, values), ["young", "tilt_x0"], Lattice(9))
    assert found.converged and found.explained and np.abs(found.residuals).max() < 1e-9
    assert found.unknowns["young"].value == pytest.approx(TRUE, rel=1e-6)
    assert found.unknowns["tilt_x0"].value == pytest.approx(0.03, abs=1e-7)
    assert found.unknowns["tilt_x0"].unit == "rad"
    assert any("cannot distinguish young from tilt_x0 (correlation +0.98" in said for said in found.warnings)


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


def test_no_answer_with_the_scenes_own_values():
    with pytest.raises(NoAnswer):
        identify(with_material(SCENE, young=1e3), Displacements(POINTS, solved(SCENE)), ["young"])


def fit_of(function, measured, starts_at=1.0):
    """A fit of one unknown above zero to displacements (n, 3) as a function of it and of the rows' times."""

    def predict(unknowns, x, points, time):
        some = Displacements(points, points, time)
        here, *ends = (function(unknowns[0].value(x[0] + step), some) for step in (0.0, -1e-6, 1e-6))
        return Prediction(here, [(ends[1] - ends[0]) / 2e-6])

    one = Unknown("stiffness", "", starts_at, 0.0, np.inf)
    return Fit(measured, (one,), Model({}, (np.zeros(2), np.zeros(2)), predict))


def anything(measured, predicted):
    """Refuse nothing."""


def test_a_deflection_of_the_other_sign_is_refused_with_its_correlation():
    u = np.array([[-2e-3, 1e-5, -9e-3], [-2.2e-3, 0.0, -1e-2], [-2.4e-3, -1e-5, -1.1e-2]])

    def required(measured, predicted):
        fit = Fit(Displacements(POINTS[:3], measured), (), Model({}, (np.zeros(2), np.zeros(2)), anything))
        fit.require_same_way(Prediction(predicted, []))

    required(0.3 * u, u)
    required(-u, 0.0 * u)
    with pytest.raises(BadInput, match=r"uz have the opposite sign of the model's \(correlation −1\.00"):
        required(-2.0 * u, u)


def swing(frequency, measured):
    return np.outer(np.sin(2.0 * np.pi * frequency * measured.time), [0.0, 0.0, 1.0])


def test_a_growing_part_of_a_motion_leads_past_minima_that_are_out_of_step():
    """Twelve periods sought from 0.7 of the frequency on: a plain search ends a few periods off."""
    time = np.linspace(0.0, 12.0, 200)[1:]
    empty = Displacements(np.zeros((199, 2)), np.zeros((199, 3)), time)
    measured = replace(empty, displacement=noisy(swing(1.0, empty), 1))
    fit = fit_of(swing, measured, 0.7)
    assert abs(fit.search(np.zeros(1)).x[0] - log(1 / 0.7)) > 0.05
    best, tried = best_search(fit, lambda one: one.noise < 0.05, anything)
    assert best.x[0] == pytest.approx(log(1 / 0.7), abs=0.002) and tried == 1


@pytest.mark.parametrize("kind", ["space", "time", "surface"])
def test_noise_is_taken_for_noise_and_a_smooth_rest_is_not(kind):
    smooth = np.sin(10.0 * POINTS @ np.array([[1.0, 0.3, 2.0], [0.5, 2.0, 1.0]]))
    measured = Displacements(POINTS, smooth, None)
    if kind == "time":
        measured = Displacements(np.tile(POINTS[:1], (64, 1)), smooth, np.linspace(0, 1, 64))
    if kind == "surface":
        measured, smooth = Surface(np.column_stack([POINTS, smooth[:, 2]])), smooth[:, 2]
    rng = np.random.default_rng(3)
    chances = [runs(measured, rng.normal(size=smooth.shape)).probability for _ in range(300)]
    assert sum(chance < UNLIKELY for chance in chances) <= 3  # 0.3 are to be expected
    assert 0.4 < np.mean(np.array(chances) < 0.5) < 0.65
    found = runs(measured, smooth)
    assert found.along == ("time" if kind == "time" else "space")
    assert found.pairs == smooth.size - smooth.size // 64  # a tree, or a chain, of 64
    assert found.probability < UNLIKELY and not explained(0.01, found) and explained(0.001, found)


def test_a_model_that_lacks_something_is_said_not_to_explain_the_data():
    """A clamp turned by 0.05 rad that the scene does not know of, and 0.1 % noise."""
    data = Displacements(POINTS, noisy(solved(put(CANTILEVER, "tilt_x0", 0.05)), 4, 0.001))
    found = identify(CANTILEVER, data, lattice=Lattice(3), refine=False)
    assert not found.explained and found.starts == search.STARTS + 1
    (said,) = found.warnings
    assert said.startswith("not explained: the best of 7 starts") and "neighbouring points" in said
    assert said[:80] in repr(found).replace("\n" + " " * 11, " ")
    assert identify(CANTILEVER, data, ["young", "tilt_x0"], Lattice(3), refine=False).explained


def test_a_slip_of_the_pen_is_named_by_its_line(tmp_path):
    values = noisy(solved(SCENE), 5)
    clean = identify(SCENE, Displacements(POINTS, values.copy()), lattice=Lattice(3), refine=False)
    assert not clean.outliers and clean.explained and not clean.warnings
    values[16, 2] = 0.15
    file = tmp_path / "m.csv"
    rows = [",".join(f"{v:.6g}" for v in row) for row in np.column_stack([POINTS, values])]
    file.write_text("\n".join(["x,y,ux,uy,uz", *rows]))
    found = identify(SCENE, file, lattice=Lattice(3), refine=False)
    (odd,) = found.outliers
    assert (odd.row, odd.component, odd.measured) == (16, "uz", 0.15)
    assert f"{file}, line 18: uz = 0.15 m" in found.warnings[0]
    assert not any("poor fit" in said for said in found.warnings) and not found.explained
    file.write_text(file.read_text().replace(rows[16], rows[16].rpartition(",")[0] + ","))
    low, high = identify(SCENE, file, lattice=Lattice(3), refine=False).unknowns["young"].interval
    assert low < SCENE.material.young < high and high / low < 1.04


@pytest.mark.parametrize("rows, named", [(16, [3, 7]), (15, [])])
def test_one_row_in_eight_may_be_left_out(rows, named):
    """Two slips, one as large as the other, are distinguished from noise only together."""
    residuals = 1e-3 * np.random.default_rng(1).uniform(-1.0, 1.0, (rows, 3))
    residuals[[3, 7], 2] = 1.0

    class Same(Fit):
        """The same residuals, whatever is left out."""

        def per_point(self, of):
            return of

        def at(self, x):
            return residuals, None

        def search(self, x):
            return SimpleNamespace(x=x)

    measured = Displacements(np.zeros((rows, 2)), np.zeros((rows, 3)))
    same = Same(measured, (), Model({}, (np.zeros(2), np.zeros(2)), lambda some: None))
    assert [found.row for found in outliers(same, SimpleNamespace(residuals=residuals, x=None))] == named


def test_the_fit_chooses_cells_that_are_small_beside_the_noise():
    """Data of a shell with 2 % noise: E of 9 × 9 masses is 4 % too low, its noise's interval ± 2.5 %."""
    values = fem_reference.solve(THICK, elements=8).displacement(POINTS)
    data = Displacements(POINTS, noisy(values, 6, 0.02))
    found = identify(THICK, data)
    young = found.unknowns["young"]
    assert found.grids == ((9, 9, 2), (17, 17, 2)) and found.settings["grid"] == [17, 17, 2]
    assert found.explained and young.interval[0] < SOFT < young.interval[1] < 1.1 * young.interval[0]
    assert "noise and grid" in repr(found)


def test_the_interval_of_a_shell_contains_the_error_of_its_mesh():
    values = fem_reference.solve(CANTILEVER, elements=12).displacement(POINTS)
    found = identify(CANTILEVER, Displacements(POINTS, noisy(values, 2, 1e-4)), model="shell", elements=3)
    young = found.unknowns["young"]
    assert young.noise_interval[1] < CANTILEVER.material.young < young.interval[1] < 1.1 * young.value
    assert found.contains == "noise and mesh" and "noise and mesh" in repr(found)
    assert "mesh's error; take more --elements" in found.warnings[-1]


def test_what_the_data_do_not_determine_is_no_result():
    data = Displacements(POINTS, noisy(solved(SCENE), 8))
    found = identify(SCENE, data, ["E", "rho"], Lattice(3), refine=False)
    assert [*found.unknowns] == ["young", "density"]
    assert all(row[2:6] == (None,) * 4 for row in found.report().tables[0].rows)
    assert "changed together" in repr(found)
    assert any("do not determine a combination of young, density" in said for said in found.warnings)
    young, density = (one.value for one in found.unknowns.values())
    assert young / density == pytest.approx(SCENE.material.young / SCENE.material.density, rel=0.01)
    assert 0.1 < density / SCENE.material.density < 10.0  # it does not wander along what nothing holds
    assert not any(u["determined"] for u in found.document()["unknowns"].values())


@pytest.mark.parametrize(
    ("name", "least", "most"), [("rho", 1.678e-3, 1.678e9), ("h", 3e-9, 0.188), ("nu", -0.99, 0.4999)]
)
def test_bounds_are_a_million_times_the_scenes_value_or_what_makes_sense(name, least, most):
    one = unknown(SCENE, name)
    assert [one.value(x) for x in one.bounds()] == pytest.approx([least, most])


def test_damping_is_sought_from_a_scene_without_any():
    """2 % of critical in the lowest mode, about."""
    undamped = with_material(SCENE, damping_time=0.0, damping_rate=0.0)
    first = float(lumped.modes(undamped, count=1).frequencies[0])
    assert unknown(undamped, "damping_time").start == pytest.approx(0.02 / (np.pi * first), rel=0.05)
    assert unknown(undamped, "damping_rate").start == pytest.approx(0.08 * np.pi * first, rel=0.05)


def test_the_finer_lattice_of_a_drawn_sheet_has_lines_on_shapes_too():
    fin, scene = scenes.load("ray-fin"), Lattice((9, 5, 2))
    chosen = of_settings(lattice_model(fin, scene).settings, fin.sheet.lengths)
    finer = lattice_model(fin, Lattice((17, 9, 2), grading=chosen))
    assert (
        chosen
        == of_settings(finer.settings, fin.sheet.lengths)
        == lines_on_shapes(fin, scene.grid, scene)
        != 0.0
    )


DAMPED = CANTILEVER.replace(loss_factor=0.12, frequency=3.0)


@pytest.mark.nightly
def test_a_reference_follows_a_measured_motion():
    """Within what a hundred steps a period leave, against finer ones."""
    run = fem_reference.simulate(DAMPED, "shell", 0.15, elements=1, step=1e-3)
    at = np.linspace(0.01, 0.15, 20)
    seen = CubicSpline(run.time, run.probes["P4"])(at) * [np.nan, np.nan, 1.0]
    measured = Displacements(np.tile(DAMPED.probes["P4"], (20, 1)), seen, at)
    found = identify(DAMPED.replace(young=50e6), measured, "young", model="shell", elements=1)
    assert found.unknowns["young"].value == pytest.approx(54.5e6, rel=5e-3)
    assert found.settings["elements"] == [1, 1]


def test_branches_are_parameters():
    scene = CANTILEVER.replace(relaxation=(Relaxation(0.2, 0.1), Relaxation(0.1, 1.0)))
    assert parameter(scene, "time_2").value == 1.0
    assert put(scene, "share_1", 0.3).material.relaxation[0].share == 0.3
    still = Displacements(np.array([[0.1, 0.1]] * 3), np.full((3, 3), -1e-3))
    for name, said in (
        ("share_3", "share_3"),
        ("loss_factor", "loss_factor"),
        ("share_1", "does not depend"),
    ):
        with pytest.raises(BadInput, match=said):
            identify(scene, still, name)
