"""The comparison with peers: its arithmetic, its report, and the equations that SciPy is given."""

import numpy as np
import pytest

from sheetbench.scenes import load
from studies.peers import settling
from studies.peers.row import PeerRow, faster, repeated
from studies.peers.study import Peers

ROWS = [
    PeerRow("statics", "lattice", "5 × 5", True, 3e-3, (0.001, 0.003, 0.002), "converged"),
    PeerRow("statics", "shell", "8 × 8", True, 1e-3, (0.05,), "converged"),
    PeerRow("statics", "theirs", "16 × 16", False, 2e-3, (0.5,), "converged"),
    PeerRow("statics", "theirs", "32 × 32", False, 5e-4, (5.0,), "converged"),
    PeerRow("statics", "absent", "4 × 4", False, None, (), "absent: needs luck"),
    PeerRow("settling", "lattice, quick", "default", True, 1e-3, (0.1,), "converged"),
]


def test_ours_is_faster_only_where_it_is_as_good():
    assert [faster(row, ROWS) for row in ROWS] == [None, None, pytest.approx(10.0), None, None, None]


def test_quick_solves_are_repeated_and_long_ones_are_not():
    quick, long = iter([0.5, 0.4, 0.3, 0.4, 9.9]), iter([2.0])
    assert repeated(lambda: next(quick)) == (0.4, 0.3, 0.4)
    assert repeated(lambda: next(long)) == (2.0,)


def test_a_table_a_question():
    found = Peers(ROWS).report()
    assert [table.name for table in found.tables] == ["statics", "settling"]
    (row,) = [row for row in found.document["rows"] if row["size"] == "16 × 16"]
    assert row["faster"] == pytest.approx(10.0) and row["median"] == 0.5
    assert "absent: needs luck" in found.to_markdown()


def test_scipy_is_given_the_lattices_own_jacobian():
    """Against central differences of the right-hand side, in a bent state at rest: of dampers that turn
    the matrices of an implicit step leave the turning out."""
    equations = settling.Equations(load(settling.SCENE))
    rng = np.random.default_rng(3)
    y = 1e-4 * rng.standard_normal(2 * equations.count)
    y[equations.count :] = 0.0
    along = rng.standard_normal(2 * equations.count)
    h = 1e-8
    slope = (equations.rate(0.1, y + h * along) - equations.rate(0.1, y - h * along)) / (2 * h)
    exact = equations.jacobian(0.1, y) @ along
    np.testing.assert_allclose(slope, exact, atol=1e-5 * np.abs(exact).max())
