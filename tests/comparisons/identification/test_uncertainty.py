"""Standard deviations of measured numbers, one number, rounded ones, and values far from the scene's."""

from dataclasses import replace
from math import log

import numpy as np
import pytest
from cases import POINTS, with_material

import lumped
from comparisons.identification.identification import identify
from comparisons.identification.measurements import Displacements
from comparisons.identification.residuals import grid_notes
from comparisons.models.spec import Lattice
from sheetbench import scenes
from sheetbench.errors import BadInput

SCENE, TRUE = scenes.load("two-edges-clamped"), 40e6


def solved(scene):
    springs = lumped.calibrate(scene.sheet, scene.material, (3, 3))
    return lumped.solve(scene, springs).displacement(POINTS)


STIFF = with_material(SCENE, young=TRUE * 1e3)
"""A sheet that bends in proportion to 1/E."""


def test_one_number_has_a_value_and_with_its_uncertainty_an_interval():
    """In closed form x ± 1.96 σ/|u|, of n equally accurate numbers over √n, as u ∝ 1/E."""
    known = solved(STIFF)[[16]] * [np.nan, np.nan, 1.0]
    one = Displacements(POINTS[[16]], known)
    guess, sag = with_material(STIFF, young=0.8 * STIFF.material.young), abs(known[0, 2])
    found = identify(guess, one, lattice=Lattice(3), refine=False)
    assert found.unknowns["young"].value == pytest.approx(STIFF.material.young, rel=1e-6)
    assert found.document()["unknowns"]["young"]["interval"] is None and "(no interval)" in found.result()
    assert "one measured number fixes young but no interval" in found.notes()[-1]
    with pytest.raises(BadInput, match="1 measured number cannot determine 2 unknowns"):
        identify(guess, one, ["young", "density"], Lattice(3))
    rows = Displacements(POINTS[[16, 16]], np.tile(known, (2, 1)), deviation=np.full(2, 0.03 * sag))
    for measured, count in ((replace(one, deviation=np.array([0.03 * sag])), 1), (rows, 2)):
        low, high = identify(guess, measured, lattice=Lattice(3), refine=False).unknowns["young"].interval
        assert log(high / low) / 2 == pytest.approx(1.96 * 0.03 / count**0.5, rel=1e-3)
    with pytest.raises(BadInput, match="has a column sd"):
        identify(guess, rows, uncertainty=1e-3)
    with pytest.raises(BadInput, match="uncertainty = 0 m: must be greater than 0"):
        identify(guess, one, uncertainty=0.0)


@pytest.mark.nightly  # forty fits
def test_rows_count_by_their_standard_deviations():
    """Half of the rows ten times as accurate: intervals hold, and are narrower than without weights."""
    rng, truth = np.random.default_rng(5), solved(with_material(SCENE, young=TRUE))
    size = np.where(np.arange(len(POINTS)) % 2, 0.02, 0.002) * np.abs(truth).max()
    hits, widths = 0, []
    for _ in range(20):
        values = truth + size[:, None] * rng.normal(size=truth.shape)
        both = [
            identify(SCENE, Displacements(POINTS, values, deviation=of), lattice=Lattice(3), refine=False)
            for of in (size, None)
        ]
        (low, high), (least, most) = (one.unknowns["young"].interval for one in both)
        hits += low <= TRUE <= high
        widths.append((high - low) / (most - least))
    assert hits >= 17 and np.median(widths) < 0.3


def test_what_is_far_from_the_scene_rounded_or_done_already_is_said():
    """A value 40 times the scene's is the first note; numbers that are all alike are rounded ones."""
    places = np.array([[0.188, 0.188], [0.188, 0.18], [0.18, 0.188]])
    measured = Displacements(places, np.full((3, 3), [np.nan, np.nan, -0.013]))
    guess = with_material(SCENE, young=1e6)
    first, second, *_ = identify(guess, measured, lattice=Lattice(3), refine=False).warnings
    assert "times the scene's 1 MPa, with which uz = −" in first and "where −13 mm were measured" in first
    assert "the 3 measured numbers are equal" in second and "--uncertainty" in second
    known = identify(SCENE, measured, lattice=Lattice(3), uncertainty=1e-3, refine=False)
    assert not known.warnings and known.explained
    young = known.unknowns["young"]
    wide = {"young": replace(young, noise_interval=(0.999 * young.value, 1.001 * young.value))}
    (given,), (chosen,) = (grid_notes(wide, "lumped", True, grid) for grid in (None, (39, 17, 2)))
    assert (
        "leave the grid to the fit" in given and "take more masses than the fit did, --lumped 77x33" in chosen
    )


def test_a_point_off_the_sheet_by_rounding_is_on_its_edge():
    at = np.array([[0.1880004, 0.1], [0.1, 0.188 + 1.8e-5], [0.1, 0.1]])
    found = identify(SCENE, Displacements(at, np.full((3, 3), -1e-3)), lattice=Lattice(3), refine=False)
    np.testing.assert_allclose(found.measured.points, [[0.188, 0.1], [0.1, 0.188], [0.1, 0.1]], rtol=1e-15)
