"""Topology of the lattice: neighbours, weights, families, per-direction and unequal spacings."""

import numpy as np
import pytest
from cases import SHEET

from lumped.lattice import STEPS, build
from sheetbench.scenes import Sheet

pytestmark = pytest.mark.smoke

OBLONG = Sheet(length_x=0.2, length_y=0.3, thickness=0.003)


def neighbours(lattice):
    count = np.zeros(lattice.mass_count, int)
    np.add.at(count, lattice.links.nodes.ravel(), 1)
    return count


def families(lattice):
    """Name, direction, nodes, offsets, rest lengths and weights of the links of each row of STEPS."""
    links = lattice.links
    for number, (name, direction, _) in enumerate(STEPS):
        of = links.step == number
        yield (
            name,
            direction,
            links.nodes[of],
            links.offset[of],
            links.rest_length[of],
            links.shares[:, of].sum(axis=0),
        )


def test_neighbour_counts_of_the_seed():
    lattice = build(SHEET, (9, 9, 2), 0.003)
    count = neighbours(lattice)[lattice.columns()]
    assert (count[1:-1, 1:-1] == 17).all()
    assert (count[[0, -1], 1:-1] == 11).all() and (count[1:-1, [0, -1]] == 11).all()
    assert (count[[0, 0, -1, -1], [0, -1, 0, -1]] == 7).all()


def test_middle_layer_of_three_has_both_sides():
    lattice = build(SHEET, (5, 5, 3), 0.0015)
    assert neighbours(lattice)[lattice.columns()][2, 2].tolist() == [17, 26, 17]


def test_spacing_and_rest_lengths_of_an_oblong_grid():
    lattice = build(OBLONG, (9, 13, 2), 0.004)
    lx, ly, lz = lattice.spacing
    assert (lx, ly, lz) == pytest.approx((0.025, 0.025, 0.004))
    lattice = build(OBLONG, (5, 13, 2), 0.004)
    lx, ly, lz = lattice.spacing
    expected = {
        ("axial", "x"): lx,
        ("axial", "y"): ly,
        ("diagonal", ""): np.hypot(lx, ly),
        ("vertical", ""): lz,
        ("cross", "x"): np.hypot(lx, lz),
        ("cross", "y"): np.hypot(ly, lz),
        ("cross_diagonal", ""): np.sqrt(lx**2 + ly**2 + lz**2),
    }
    for name, direction, nodes, offset, rest_length, _ in families(lattice):
        ends = lattice.positions[nodes]
        assert np.allclose(ends[:, 1] - ends[:, 0], offset, atol=1e-15)
        assert np.allclose(rest_length, expected[name, direction])


def test_tributary_weights():
    lattice = build(SHEET, (5, 5, 2), 0.003)
    assert lattice.share.sum() == pytest.approx(16 * 2)  # cells × layers
    for name, direction, nodes, _, _, weight in families(lattice):
        if name in ("diagonal", "cross_diagonal"):
            assert (weight == 1.0).all()
        elif name == "vertical":
            assert sorted(set(weight)) == [0.25, 0.5, 1.0]
        else:
            along = 1 if direction == "x" else 0  # boundary lines of x links are at the ends of y
            line = lattice.positions[nodes[:, 0], along]
            outer = np.isclose(line, 0.0) | np.isclose(line, 0.188)
            assert (weight == np.where(outer, 0.5, 1.0)).all()


def test_full_weights_are_the_seeds_equal_masses():
    lattice = build(SHEET, (9, 9, 2), 0.003, weights="full")
    assert np.ptp(lattice.share) == 0.0
    mass = 1678.0 * 0.188**2 * 0.003 / 2 / 64 * lattice.share[0]
    assert mass == pytest.approx(0.0010982, rel=1e-4)
    assert (lattice.links.shares.sum(axis=0) == 1.0).all()


def test_too_small_a_grid_is_refused():
    with pytest.raises(ValueError, match=r"1x9x2"):
        build(SHEET, (1, 9, 2), 0.003)
