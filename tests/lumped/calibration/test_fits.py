"""The fitted calibrations: against data a lattice made, against the shell, and what data cannot tell."""

import numpy as np
import pytest
from cases import POINTS

import fem_reference
import lumped
from lumped import ModalTarget, StaticTarget, identifiability
from lumped.vibration import frequency_slopes
from sheetbench import scenes

TRAINING = [scenes.load(name) for name in ("one-edge-clamped", "two-edges-clamped")]
SHEET, MATERIAL = TRAINING[0].sheet, TRAINING[0].material


@pytest.fixture(scope="module")
def shell():
    """Displacement fields and frequencies of the shell on the training scenes."""
    fields = {s.name: fem_reference.solve(s, model="shell", elements=12) for s in TRAINING}
    modes = {
        s.name: fem_reference.modes(s, model="shell", elements=12, count=4).frequencies for s in TRAINING
    }
    return fields, modes


def test_fit_static_recovers_the_springs_that_made_the_data():
    made = lumped.calibrate(SHEET, MATERIAL, (5, 5))
    for name, factor in (("axial", 1.1), ("diagonal", 0.9), ("area", 1.2)):
        made = made.with_constant(name, factor * made.constants.value(name))
    true = made.springs
    targets = [StaticTarget(s, POINTS, lumped.solve(s, made).displacement(POINTS)) for s in TRAINING]
    fitted = lumped.calibrate(SHEET, MATERIAL, (5, 5), "fit-static", targets=targets)
    assert fitted.residual < 1e-4
    for name in ("axial", "diagonal", "area"):
        assert getattr(fitted.springs, name) == pytest.approx(getattr(true, name), rel=0.02), name


def test_fit_static_to_the_shell(shell):
    fields, _ = shell
    targets = [StaticTarget(s, POINTS, fields[s.name].displacement(POINTS)) for s in TRAINING]
    fitted = lumped.calibrate(SHEET, MATERIAL, (9, 9), "fit-static", targets=targets)
    for scene in TRAINING:
        points = scene.probe_points()
        right = fields[scene.name].displacement(points)
        found = lumped.solve(scene, fitted).displacement(points)
        assert np.abs(found - right).max() < 0.003 * np.abs(right).max()
    known = fitted.identifiability
    assert known.half_widths["axial"] < 0.05 and known.half_widths["mid_area"] == np.inf
    assert any("mid_area" in note for note in fitted.remarks)


def test_fit_modal_to_the_shell(shell):
    fields, modes = shell
    targets = [ModalTarget(s, modes[s.name]) for s in TRAINING]
    fitted = lumped.calibrate(SHEET, MATERIAL, (9, 9), "fit-modal", targets=targets)
    assert fitted.masses == "gregory"
    for scene in TRAINING:
        found = lumped.modes(scene, fitted, 3).frequencies
        assert np.abs(found / modes[scene.name][:3] - 1).max() < 0.01
        points = scene.probe_points()
        right = fields[scene.name].displacement(points)
        still = lumped.solve(scene, fitted).displacement(points)
        assert np.abs(still - right).max() < 0.02 * np.abs(right).max()


def test_frequency_slopes_against_differences():
    scene = TRAINING[1]
    springs = lumped.calibrate(SHEET, MATERIAL, (5, 7)).with_constant("mid_area", 0.0)
    names = ["axial_x", "axial_y", "diagonal", "cross_x", "area"]
    _, slopes = frequency_slopes(scene, springs, ["mid_area", *names], 3)
    assert not slopes["mid_area"].any()
    for name in names:
        k = springs.constants.value(name)
        moved = [springs.with_constant(name, k * (1 + sign * 1e-4)) for sign in (1, -1)]
        sides = [lumped.modes(scene, one, 3, "tributary").frequencies for one in moved]
        expected = (sides[0] - sides[1]) / (2e-4 * k)
        assert slopes[name] == pytest.approx(expected, rel=1e-5, abs=1e-9 * sides[0][0] / k)


def test_intervals_of_a_straight_line():
    """y = a + b x with known noise: the textbook's t interval (Bates and Watts 1988, 1.2)."""
    rng = np.random.default_rng(5)
    x = np.linspace(0, 1, 20)
    jacobian = np.stack([np.ones(20), x], axis=1)
    hits = 0
    for _ in range(400):
        noise = rng.standard_normal(20)
        estimate = np.linalg.lstsq(jacobian, noise, rcond=None)[0]
        known = identifiability(["a", "b"], jacobian, noise - jacobian @ estimate)
        hits += abs(estimate[1]) < known.half_widths["b"]
    assert hits / 400 == pytest.approx(0.95, abs=0.03)


def test_undetermined_parameters_are_named():
    x = np.linspace(0, 1, 20)
    noise = np.random.default_rng(1).standard_normal(20)
    same = identifiability(["a", "b", "c"], np.stack([x, x, 1 - x], axis=1), noise)
    assert same.half_widths["a"] == same.half_widths["b"] == np.inf and np.isfinite(same.half_widths["c"])
    assert "a, b" in same.warnings[0]
    close = identifiability(["a", "b"], np.stack([x, x + 0.05 * x**2], axis=1), noise)
    assert any("cannot distinguish a from b" in warning for warning in close.warnings)


@pytest.mark.parametrize("method", ["fit-static", "fit-modal"])
def test_missing_or_wrong_targets_are_refused(method):
    with pytest.raises(ValueError, match="needs targets"):
        lumped.calibrate(SHEET, MATERIAL, (5, 5), method)
    modal, static = ModalTarget(TRAINING[0], np.ones(1)), StaticTarget(TRAINING[0], POINTS, 0.0 * POINTS)
    wrong = [modal if method == "fit-static" else static]
    with pytest.raises(ValueError, match="all of them"):
        lumped.calibrate(SHEET, MATERIAL, (5, 5), method, targets=wrong)
    with pytest.raises(ValueError, match="takes no targets"):
        lumped.calibrate(SHEET, MATERIAL, (5, 5), targets=wrong)
