"""Several equilibria in one comparison, and grids so coarse that they look like another branch."""

import numpy as np
import pytest
from cases import sheet
from fake_solutions import solution

from comparisons.comparison import branches
from comparisons.comparison.comparison import compare
from comparisons.comparison.far_apart import far_apart_note
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench.answers.contact import ContactState
from sheetbench.answers.solution import Status
from sheetbench.scenes import Clamped, Curved, EdgeLoad, Pressure

BENT = sheet(
    *(0.15, 0.15, 0.002, 1e7, 0.45, 912.0), weight=9.81, supports=(Curved(edge="x0", curvature=-8.0),),
    probes={"P3": (0.15, 0.075)},
)  # fmt: skip
COLUMN = sheet(
    *(0.1, 0.05, 0.001, 5e6, 0.0, 1100.0), loads=(EdgeLoad(edge="x1", force_per_length=(-0.13, 0.0, 0.0)),)
)


def test_the_model_that_has_both_equilibria_is_shown_on_the_others_branch():
    found = compare(BENT, Lattice(9), elements=8, uncertainty=False, companion=False)
    lattice, shell = found.solutions
    assert lattice.status is shell.status is Status.CONVERGED
    assert found.several and "different branches of equilibria" in found.disagreement
    assert found.error(lattice) < 0.5
    document = found.document()["solutions"]
    assert {one["branch"] for one in document} == {"path", "of lumped"}
    assert np.abs(found.probes(shell)["P3"][2]) < 0.015  # not hanging down


def test_models_that_stay_on_different_branches_get_no_error(monkeypatch):
    """Neither begun in the other's shape, the lattice is 70 % off, on any grid."""
    monkeypatch.setattr("comparisons.comparison.comparison.branches.on_one_branch", lambda *_: None)
    found = compare(BENT, Lattice(9), elements=8, companion=False)
    lattice, shell = found.solutions
    assert lattice.status is shell.status is Status.CONVERGED
    assert "they lie on different branches of equilibria" in found.disagreement
    assert found.error(lattice) is None
    document = found.document()
    assert [one["branch"] for one in document["solutions"]] == ["own", "own"]
    assert [one["error"] for one in document["errors"]] == [None]


@pytest.mark.parametrize("branch", ["path", "buckled"])
def test_a_perfect_column_has_no_error_until_it_is_let_buckle(branch):
    found = compare(COLUMN, Lattice(3, branch=branch), elements=2, companion=False)
    lattice, shell = found.solutions
    assert {one["branch"] for one in found.document()["solutions"]} == {branch} or branch == "buckled"
    if branch == "path":
        assert lattice.status is shell.status is Status.UNSTABLE
        assert found.error(lattice) is None and found.bar is None
        assert all(difference.relative is None for difference in found.differences)
        assert "--branch buckled" in lattice.status.advice
    else:
        assert lattice.status is shell.status is Status.CONVERGED
        assert found.error(lattice) < 0.2
        assert any("the stable equilibrium shown" in note for note in found.report().notes)


TILTED = tuple(Clamped(edge=edge, tilt=0.3) for edge in ("x0", "x1"))
SCENE = sheet(0.188, 0.06, 0.001, 54.5e6, 0.4, supports=TILTED, load=(Pressure(value=40.0),))
LATTICE = Lattice((5, 3), "consistent")


def test_pressure_on_a_few_masses_between_tilted_clamps():
    """5 × 3 masses are 261 % off the shell, 9 × 5 are 92 %."""
    found = compare(SCENE, Lattice((5, 3), "consistent"), elements=(8, 3), uncertainty=False)
    assert found.disagreement.startswith("lumped and shell both converged, 26")
    assert "the grid is too coarse, on 9×5×2 masses it is 9" in found.disagreement
    assert found.document()["apart"] == found.disagreement
    report = found.report()
    assert found.disagreement in report.complaints
    assert "both converged" in report.to_markdown()
    assert found.succeeded and found.error(found.solutions[0]) > 2.6  # the error of too coarse a grid stands


def said(first, finer, lattice=LATTICE, **known):
    """Of a lattice whose corner moves by `first` [m], where the shell's moves by −10 mm."""
    grid = {"settings": {"grid": [5, 3, 2]}}
    both = (solution(SCENE, size=first, **grid), solution(SCENE, "shell", **known.pop("shell", {})))
    return far_apart_note(resolve(SCENE, lattice), both, known.pop("bar", None), lambda other: finer)[0]


def fine(size, **changes):
    return solution(SCENE, size=size, settings={"grid": [9, 5, 2]}, **changes)


def test_what_is_near_or_no_equilibrium_says_nothing():
    assert said(-0.0119, fine(-0.01)) == ""
    assert said(0.01, fine(0.01), shell={"status": Status.UNSTABLE}) == ""


def test_an_obstacle_that_one_model_alone_touches_is_no_other_branch(monkeypatch):
    monkeypatch.setattr("lumped.solve", None)  # nor is one looked for
    felt = {"contacts": {"obstacle 1": ContactState(1e-6, 1e3, 1e-5, 3, 0)}}
    found = said(0.01, fine(0.0101), bar=0.01, shell=felt)
    assert "200 % apart: obstacle 1: only one of them touches it" in found and "branch" not in found
    both = solution(SCENE, size=0.01), solution(SCENE, "shell", **felt)
    assert branches.on_one_branch(resolve(SCENE, LATTICE), None, *both) is None


def test_a_difference_that_a_finer_grid_keeps_is_another_branch():
    found = said(0.01, fine(0.0101), bar=0.01)
    assert "200 % apart: they lie on different branches of equilibria, for on 9×5×2 masses" in found
    assert "if the shell's mesh is fine enough" in said(0.01, fine(0.0101))


@pytest.mark.parametrize(
    ("finer", "stretch", "calibration", "known"),
    [
        (-0.0049, 0.001, "consistent", True),
        (-0.0055, 0.001, "consistent", True),  # first order ahead it would be 40 % off still
        (-0.006, 0.001, "consistent", False),  # and here 30 %
        (-0.008, 0.001, "consistent", False),
        (-0.0049, 0.2, "consistent", False),  # laws of strain
        (-0.0049, 0.001, "uniform", False),
    ],
)
def test_up_to_100_percent_only_what_would_tend_to_the_reference_is_on_another_branch(
    finer, stretch, calibration, known
):
    """A lattice that is 50 % off, and what a finer grid says."""
    settings = {"grid": [5, 3, 2], "calibration": calibration}
    both = (solution(SCENE, size=-0.005, settings=settings), solution(SCENE, "shell", stretch=stretch))
    lattice = LATTICE.but(calibration=calibration)
    note, other_branch = far_apart_note(resolve(SCENE, lattice), both, 0.01, lambda other: fine(finer))
    assert "50 % apart" in note
    assert other_branch is known


@pytest.mark.parametrize(
    "finer, bar, expected",
    [
        (fine(0.007), 0.01, "different branches of equilibria, or too coarse a grid: on 9×5×2"),
        (fine(0.0101), 0.8, "the shell's error bar is ± 80 %"),
        (fine(0.0101, status=Status.DIVERGED), 0.01, "twice as many cells per side the lattice is diverged"),
        (None, 0.01, "different branches of equilibria, or too coarse a grid or mesh"),
    ],
)
def test_undecided_reasons_of_a_difference_are_named(finer, bar, expected):
    assert expected in said(0.01, finer, bar=bar)
