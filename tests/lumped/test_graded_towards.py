"""Grids graded towards some edges only: lines, springs of either end, files, what auto takes."""

import numpy as np
import pytest
from cases import OBLONG, SILICONE, relative

import fem_reference
import lumped
from comparisons.models.grading import ONE_SIDED, grading_of, parse_grading
from comparisons.models.spec import Lattice
from comparisons.sweep.differences import error
from lumped.grid_lines import grid_lines
from lumped.spring_constants import of_edge_cells
from sheetbench.answers.solution import Status
from sheetbench.face import solve
from sheetbench.scenes import BadInput, load
from sheetbench.scenes.objects.grading import Grading, as_settings, of_settings, towards
from studies.master_curves.curves import cantilever
from studies.transfer.scenes import transfer_scenes
from studies.transfer.tasks import points

LEFT = Grading(0.6, ("x0",))
TURNED = {"x0": "x1", "x1": "x0"}


def test_lines_towards_one_edge_are_half_of_a_side_twice_as_long():
    doubled = OBLONG.replace(length_x=0.4)
    twice, _ = grid_lines(doubled, (11, 5, 2), 0.6)
    x, y = grid_lines(OBLONG, (6, 5, 2), LEFT)
    assert x.at == pytest.approx(twice.at[:6]) and np.ptp(y.widths) == 0.0
    assert x.tributary.sum() == pytest.approx(0.2)
    right, _ = grid_lines(OBLONG, (6, 5, 2), Grading(0.6, ("x1",)))
    assert right.widths == pytest.approx(x.widths[::-1]) and right.at[0] == 0.0
    both, other = grid_lines(OBLONG, (6, 5, 2), Grading(0.6, ("x0", "x1")))
    whole = grid_lines(OBLONG, (6, 5, 2), 0.6)
    assert np.array_equal(both.at, whole[0].at) and np.ptp(other.widths) == 0.0


def test_what_is_asked_is_read_as_people_write_it():
    assert parse_grading("0.6:x0") == LEFT and str(LEFT) == "0.6:x0" and parse_grading(LEFT) is LEFT
    assert parse_grading("0.5:x1,x0") == Grading(0.5, ("x0", "x1"))
    assert parse_grading("0.5:y1,y0,x0,x1") == 0.5 and parse_grading("0:x0") == 0.0
    assert [parse_grading(text) for text in (None, "auto", "0.25", 1)] == [None, "auto", 0.25, 1.0]
    assert of_settings(as_settings(LEFT), OBLONG.lengths) == LEFT and as_settings(0.5) == {"grading": 0.5}
    for wrong in ("0.5:z0", "0.5:x0;y0", "2:x0", "auto:x0"):
        with pytest.raises(BadInput, match="grading = "):
            parse_grading(wrong)
    with pytest.raises(BadInput, match="towards no edge"):
        towards(0.5, ())


def test_a_sheet_and_its_mirror_image_have_mirrored_answers():
    """Clamped at x0 and graded there, or both at x1: springs of either end know their own edge."""
    left = load("one-edge-clamped")
    right = left.replace(supports=[{"edge": "x1", "kind": "clamped"}])
    at = points(left.sheet)
    turned = np.column_stack([left.sheet.length_x - at[:, 0], at[:, 1]])
    found = []
    for scene, edge, where in ((left, "x0", at), (right, "x1", turned)):
        answer = solve(scene, "lumped", grid=5, calibration="consistent", grading=f"0.6:{edge}")
        found.append(answer.displacement(where))
    assert relative(found[1] * [-1.0, 1.0, 1.0], found[0]) < 1e-9


def test_the_twist_of_either_edge_is_that_of_the_strip_that_begins_with_it():
    """Graded at x0 with only x1 free its cells are the long ones; with both free each end has its own."""
    springs = lumped.calibrate(OBLONG, SILICONE, (6, 5), grading=LEFT).constants
    turned = lumped.calibrate(OBLONG, SILICONE, (6, 5), grading=Grading(0.6, ("x1",))).constants
    grid = (6, 5, 2)
    for edges in ({"x1"}, {"x0", "x1"}, {"x0", "y0"}):
        mirrored = frozenset(TURNED.get(edge, edge) for edge in edges)
        one = of_edge_cells(springs, grid, frozenset(edges))[:, 2].reshape(4, 5)
        other = of_edge_cells(turned, grid, mirrored)[:, 2].reshape(4, 5)
        assert other[:, ::-1] == pytest.approx(one, rel=1e-9)
    alone = of_edge_cells(springs, grid, frozenset({"x1"}))[:, 2].reshape(4, 5)
    assert np.any(alone[:, -1]) and not np.any(alone[:, :-1])


def test_auto_grades_towards_the_one_edge_that_holds_the_sheet():
    """Where that edge is clamped and the load bends the sheet beside it; not where the edge itself is bent,
    which lets the sheet stretch at its other edges too."""
    scenes = transfer_scenes()
    value, why = grading_of(scenes["tenth-of-young-one-edge"], (9, 9, 2), Lattice(grading="auto"))
    assert value == Grading(ONE_SIDED, ("x0",)) and why.endswith("x0 alone holds the sheet")
    assert isinstance(grading_of(scenes["curved-edge"], (9, 9, 2), Lattice(grading="auto"))[0], float)
    nothing_held = scenes["tenth-of-young-one-edge"].replace(supports=())
    assert isinstance(grading_of(nothing_held, (9, 9, 2), Lattice(grading="auto"))[0], float)
    assert isinstance(grading_of(scenes["tenth-of-young"], (9, 9, 2), Lattice(grading="auto"))[0], float)


def test_towards_the_clamp_a_soft_sheet_is_nearer():
    """Over 5 × 5 points of soft-one-edge, 9 masses, `consistent-membrane`: 1.49 % of the largest displacement
    with cells of one size, 1.11 graded towards all edges by 0.3, 0.72 as auto has it."""
    scene = transfer_scenes()["tenth-of-young-one-edge"]
    at = points(scene.sheet)
    truth = fem_reference.solve(scene, model="shell", elements=8).displacement(at)  # within 0.1 % of 16
    springs = {"calibration": "consistent-membrane"}
    off = [error(solve(scene, "lumped", grading=g, **springs).displacement(at), truth) for g in (0.3, "auto")]
    assert off[0] == pytest.approx(0.0111, abs=1e-3) and off[1] == pytest.approx(0.0072, abs=1e-3)


@pytest.mark.parametrize("grading", ["0.9:x0", "0.75:x0"])
def test_cells_that_give_way_and_not_the_sheet_are_said_to(grading):
    """A strip of 33 × 3 masses bent by its weight: beside the clamp cells 30 or 14 times as long as wide, of
    which the longer ones give way; the tip is the same."""
    scene = cantilever(10.0)
    found = solve(scene, "lumped", grid=(33, 3), grading=grading)
    slender = grading == "0.9:x0"
    assert (found.status is Status.UNSTABLE) is slender
    assert ("times as long as wide" in found.message) is slender
    assert found.displacement("tip")[2] == pytest.approx(-0.14012, rel=2e-4)
