"""Grids of drawn sheets: lines on the sides of shapes, and what an edge's support holds there."""

import numpy as np
import pytest

from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from lumped.assembly import Assembly
from lumped.coverage import held_crossings
from lumped.grid_lines import grid_lines
from lumped.supports import constrain
from sheetbench.scenes import Sheet, load
from sheetbench.scenes.meaning.region import sides_of_shapes
from sheetbench.scenes.objects.grading import (
    as_settings,
    lines_for_all,
    of_settings,
    places_with_lines,
    through,
)
from sheetbench.scenes.objects.shapes import Shape

SHEET = Sheet(length_x=0.16, length_y=0.04, thickness=1e-3)


@pytest.mark.parametrize(
    ("places", "on_lines"),
    [
        ((0.035, 0.04, 0.06), (0.035, 0.04, 0.06)),  # two in one cell
        ((0.035, 0.0351), (0.035,)),  # too close for a line each
        ((0.0001, 0.1599), ()),  # too close to the edges
        (tuple(np.linspace(0.01, 0.15, 20)), ()),  # too many for the lines
    ],
)
def test_lines_are_moved_to_places(places, on_lines):
    x, y = grid_lines(SHEET, (17, 5, 2), through((places, ()), SHEET.lengths))
    even = grid_lines(SHEET, (17, 5, 2))
    assert len(x.at) == 17 and x.at[[0, -1]] == pytest.approx([0.0, 0.16]) and x.widths.min() > 1e-3
    assert np.abs(np.subtract.outer(on_lines, x.at)).min(axis=1, initial=1.0) == pytest.approx(
        np.zeros(len(on_lines)), abs=1e-15
    )
    assert on_lines or np.array_equal(x.at, even[0].at)
    assert np.array_equal(y.at, even[1].at)


def test_lines_grow_with_the_sheet():
    """All of the growth was the last cell's."""
    grown, grading = SHEET.replace(length_x=0.9 * SHEET.length_x), through(((0.035, 0.06), ()), SHEET.lengths)
    drawn, at_rest = (grid_lines(each, (17, 5, 2), grading)[0] for each in (SHEET, grown))
    assert at_rest.widths == pytest.approx(0.9 * drawn.widths, rel=1e-12)


@pytest.mark.parametrize(
    "places",
    [
        (0.035, 0.0351, 0.08),  # two in one cell, one in the middle
        (0.045, 0.105),  # halfway between lines of 17 and of 9
        (0.045, 0.055, 0.13),
        (0.0795, 0.0805),  # too close for a line each, and as far from both ends
        (0.065, 0.0651, 0.0652, 0.07),
        (0.08,),  # in the middle: of an odd number of cells neither line is the nearest
    ],
)
@pytest.mark.parametrize("count", [8, 9, 17])
def test_lines_are_moved_alike_from_either_end(places, count):
    grid, length = (count, 5, 2), SHEET.length_x
    there, back = (
        grid_lines(SHEET, grid, through((each, ()), SHEET.lengths))[0].at
        for each in (places, tuple(length - place for place in reversed(places)))
    )
    assert length - there[::-1] == pytest.approx(back, abs=1e-12)


def test_a_support_holds_the_masses_on_its_border_whatever_the_rounding():
    """Its corner a last bit before a crossing of lines, which was then left free."""
    sheet = Sheet(0.1, 0.1, 3e-3)
    lines = grid_lines(sheet, (6, 6, 2))
    corner = np.nextafter(lines[0].at[2], 0.0)
    held = Shape.model_validate({"rectangle": {"x": (0.0, corner), "y": (0.0, corner)}})
    assert held_crossings(lines, held).sum() == 9


@pytest.mark.parametrize(("reach", "columns"), [(0.035, 2), (0.039, 3)])
def test_a_support_holds_masses_of_whose_surroundings_it_takes_two_fifths(reach, columns):
    """A quarter and 0.45 of the ten millimetres on either side of the third column."""
    shape = Shape.model_validate({"rectangle": {"x": (0.0, reach), "y": (0.0, 0.1)}})
    assert held_crossings(grid_lines(Sheet(0.1, 0.1, 3e-3), (6, 6, 2)), shape).sum() == 6 * columns


def test_the_places_are_the_sides_of_shapes_and_the_ends_of_edges_and_are_written_with_springs():
    strip = load("kirigami-strip")
    x, y = places = sides_of_shapes(strip)
    assert x == (0.035, 0.04, 0.06, 0.065, 0.085, 0.09, 0.11, 0.115) and y == (0.01, 0.03)
    assert sides_of_shapes(load("ray-fin")) == ((), (0.02, 0.08))
    assert sides_of_shapes(load("pouch"))[0] == (0.0125, 0.025, 0.075, 0.0875)
    grading = through(places, strip.sheet.lengths)
    assert of_settings(as_settings(grading), strip.sheet.lengths) == grading


def test_a_slit_narrower_than_a_cell_is_open():
    """Of 5 mm, with cells of 10 mm: it is as wide a column of cells that are not there."""
    strip = load("kirigami-strip")
    springs = resolve(strip, Lattice(grid=5)).springs
    lines, _ = grid_lines(strip.sheet, springs.grid, springs.grading)
    slit = int(np.argmin(np.abs(lines.at - 0.035)))
    assert lines.at[slit + 1] == pytest.approx(0.04)
    assert not springs.present[1:, slit].any() and springs.present[0, slit]


def test_an_edge_holds_the_masses_where_the_sheet_reaches_it():
    """And one that lies within half a cell of there: all of an edge made octagons 5 % too stiff."""
    corner = 0.045
    outline = [(0, corner), (corner, 0), (0.15, 0), (0.15, 0.15), (0, 0.15)]
    scene = load("one-edge-clamped").replace(sheet=Sheet(0.15, 0.15, 3e-3, outline=outline), probes={})
    for grading, expected in ((None, corner), (0.0, 0.046875)):
        springs = resolve(scene, Lattice(grid=17, grading=grading)).springs
        lattice = Assembly(scene.sheet, springs).lattice
        masses, _ = constrain(scene, lattice).holders["x0"]
        assert lattice.positions[masses, 1].min() == pytest.approx(expected)


def test_cells_that_the_rim_of_a_clamp_cuts_are_stiffer_in_every_verb():
    """Of a plain sheet held where a disc says, which is 22 % too soft without."""
    scene = load("one-edge-clamped").replace(
        supports=[{"kind": "clamped", "where": {"circle": {"centre": (0.1, 0.1), "radius": 0.03}}}], probes={}
    )
    springs = resolve(scene, Lattice(grid=9)).springs
    assert springs.cells is not None
    factors = springs.cells.bending[..., 0, 0]
    assert factors.max() > 1.1 * factors.min()


def test_a_slit_that_is_not_open_is_named_with_the_grid_that_opens_it():
    """Of 0.2 mm, in a strip of 160 mm."""
    slit = {"shape": {"rectangle": {"x": (0.06, 0.0602), "y": (0.0, 0.03)}}}
    strip = load("kirigami-strip").replace(cutouts=[slit])
    reason = resolve(strip, Lattice(grid=9)).reasons["grading_reason"]
    assert "sides at x = 60.2 mm lie within cells, where a slit is not open: that takes 81 masses" in reason
    assert "lie within" not in resolve(strip, Lattice(grid=(81, 21))).reasons["grading_reason"]


@pytest.mark.parametrize(
    ("places", "lines", "kept"),
    [
        ([0.09], 5, []),  # a tenth of a mean cell from an end, of 1
        ([0.11], 5, [0.11]),
        (
            [0.6, 1.2, 2.0, 2.8, 3.4],
            8,
            [0.6, 1.2, 2.8, 3.4],
        ),  # of an odd number of cells none is in the middle
        ([0.6, 2.0, 3.4], 8, [0.6, 3.4]),
        ([0.6, 2.0, 3.4], 9, [0.6, 2.0, 3.4]),
    ],
)
def test_places_that_have_a_line(places, lines, kept):
    assert places_with_lines(places, 4.0, lines) == kept


@pytest.mark.parametrize(
    ("places", "lines"),
    [([0.08, 1.9], 6), ([0.08, 2.0, 3.92], 7), ([1.0, 2.0, 3.0], 5)],  # one in the middle: an odd number
)
def test_lines_that_are_enough_for_all_places(places, lines):
    assert lines_for_all(places, 4.0) == lines
    assert places_with_lines(places, 4.0, lines) == places
