"""Several equilibria in one comparison: one branch for all, unstable answers, buckled branches."""

import numpy as np
import pytest
from cases import sheet

from comparisons.comparison.comparison import compare
from comparisons.models.spec import Lattice
from sheetbench.answers.solution import Status
from sheetbench.scenes import Curved, EdgeLoad

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
    monkeypatch.setattr("comparisons.comparison.comparison.branches.joined", lambda *_: None)
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
        assert any("stable equilibrium that it comes to" in note for note in found.report().notes)
