"""What an identification does where a plain least squares fit from one start goes wrong without a word."""

from dataclasses import replace
from math import log
from types import SimpleNamespace

import numpy as np
import pytest
from cases import POINTS, with_material

import fem_reference
import lumped
from comparisons.identification import fit as search
from comparisons.identification.fit import Fit, nearest
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements, Surface
from comparisons.identification.model import Model, Prediction, lattice_model
from comparisons.identification.residuals import UNLIKELY, explained, outliers, runs
from comparisons.identification.unknowns import Unknown, unknown
from comparisons.models.grading import lines_on_shapes
from comparisons.models.spec import Lattice
from sheetbench import scenes
from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.parameters import put
from sheetbench.scenes.objects.grading import of_settings

SEED = scenes.load("two-edges-clamped")
TRUE = 1.23e6
SOFT = with_material(SEED, young=TRUE, density=1070.0)
THICK, THIN = (SOFT.replace(sheet=SOFT.sheet.replace(thickness=h)) for h in (0.004, 0.002))
"""Sheets of which nine masses a side put E 4 % and 38 % too low."""


def solved(scene, grid=3):
    springs = lumped.calibrate(scene.sheet, scene.material, (grid, grid))
    return lumped.solve(scene, springs).displacement(POINTS)


def noisy(values, seed, share=0.01):
    rng = np.random.default_rng(seed)
    return values + rng.normal(scale=share * np.abs(values).max(), size=values.shape)


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
    best, tried = nearest(fit, lambda one: one.noise < 0.05, anything)
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
    cantilever = scenes.load("one-edge-clamped")
    data = Displacements(POINTS, noisy(solved(put(cantilever, "tilt_x0", 0.05)), 4, 0.001))
    found = identify(cantilever, data, lattice=Lattice(3), refine=False)
    assert not found.explained and found.starts == search.STARTS + 1
    (said,) = found.warnings
    assert said.startswith("not explained: the best of 7 starts") and "neighbouring points" in said
    assert said[:80] in repr(found).replace("\n" + " " * 11, " ")
    assert identify(cantilever, data, ["young", "tilt_x0"], Lattice(3), refine=False).explained


def test_a_slip_of_the_pen_is_named_by_its_line(tmp_path):
    values = noisy(solved(SEED), 5)
    clean = identify(SEED, Displacements(POINTS, values.copy()), lattice=Lattice(3), refine=False)
    assert not clean.outliers and clean.explained and not clean.warnings
    values[16, 2] = 0.15
    file = tmp_path / "m.csv"
    rows = [",".join(f"{v:.6g}" for v in row) for row in np.column_stack([POINTS, values])]
    file.write_text("\n".join(["x,y,ux,uy,uz", *rows]))
    found = identify(SEED, file, lattice=Lattice(3), refine=False)
    (odd,) = found.outliers
    assert (odd.row, odd.component, odd.measured) == (16, "uz", 0.15)
    assert f"{file}, line 18: uz = 0.15 m" in found.warnings[0]
    assert not any("poor fit" in said for said in found.warnings) and not found.explained
    file.write_text(file.read_text().replace(rows[16], rows[16].rpartition(",")[0] + ","))
    low, high = identify(SEED, file, lattice=Lattice(3), refine=False).unknowns["young"].interval
    assert low < SEED.material.young < high and high / low < 1.04


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
    assert found.explained and young.interval[0] < TRUE < young.interval[1] < 1.1 * young.interval[0]
    assert "noise and grid" in repr(found)


def test_the_interval_of_a_shell_contains_the_error_of_its_mesh():
    scene = scenes.load("one-edge-clamped")
    values = fem_reference.solve(scene, elements=12).displacement(POINTS)
    found = identify(scene, Displacements(POINTS, noisy(values, 2, 1e-4)), model="shell", elements=3)
    young = found.unknowns["young"]
    assert young.noise_interval[1] < scene.material.young < young.interval[1] < 1.1 * young.value
    assert found.contains == "noise and mesh" and "noise and mesh" in repr(found)
    assert "mesh's error; take more --elements" in found.warnings[-1]


def test_what_the_data_do_not_determine_is_no_result():
    data = Displacements(POINTS, noisy(solved(SEED), 8))
    found = identify(SEED, data, ["E", "rho"], Lattice(3), refine=False)
    assert [*found.unknowns] == ["young", "density"]
    assert all(row[2:6] == (None,) * 4 for row in found.report().tables[0].rows)
    assert "changed together" in repr(found)
    assert any("do not see a combination of young, density" in said for said in found.warnings)
    young, density = (one.value for one in found.unknowns.values())
    assert young / density == pytest.approx(SEED.material.young / SEED.material.density, rel=0.01)
    assert 0.1 < density / SEED.material.density < 10.0  # it does not wander along what nothing holds
    assert not any(u["determined"] for u in found.document()["unknowns"].values())


@pytest.mark.parametrize(
    ("name", "least", "most"), [("rho", 1.678e-3, 1.678e9), ("h", 3e-9, 0.188), ("nu", -0.99, 0.4999)]
)
def test_bounds_are_a_million_times_the_scenes_value_or_what_makes_sense(name, least, most):
    one = unknown(SEED, name)
    assert [one.value(x) for x in one.bounds()] == pytest.approx([least, most])


def test_damping_is_sought_from_a_scene_without_any():
    """2 % of critical in the lowest mode, about."""
    undamped = with_material(SEED, damping_time=0.0, damping_rate=0.0)
    first = float(lumped.modes(undamped, count=1).frequencies[0])
    assert unknown(undamped, "damping_time").start == pytest.approx(0.02 / (np.pi * first), rel=0.05)
    assert unknown(undamped, "damping_rate").start == pytest.approx(0.08 * np.pi * first, rel=0.05)


def test_the_finer_lattice_of_a_drawn_sheet_has_lines_on_shapes_too():
    fin, scene = scenes.load("ray-fin"), Lattice((9, 5, 2))
    chosen = of_settings(lattice_model(fin, scene).settings)
    finer = lattice_model(fin, Lattice((17, 9, 2), grading=chosen))
    assert chosen == of_settings(finer.settings) == lines_on_shapes(fin, scene.grid, scene) != 0.0
