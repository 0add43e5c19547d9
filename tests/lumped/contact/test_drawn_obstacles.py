"""Drawn sheets over drawn obstacles: no tracebacks, and none is walked through, by the geometry
afterwards, which finds what is planted."""

import numpy as np
import pytest
from drawn_obstacles import judged

from lumped import contact
from sheetbench.numerics.continuation import stiffening


@pytest.mark.parametrize("number", [2, 22, 39, 59])
def test_drawn_sheet_is_not_walked_through(number):
    assert judged(number)[1] == ""


@pytest.mark.parametrize("number", [22, 59])
def test_geometry_finds_a_ball_between_masses(number, monkeypatch):
    corners = np.eye(4), np.full(4, 0.25)
    monkeypatch.setattr(contact, "points_of_cells", lambda *sides: corners)
    assert "deep in it" in judged(number)[1]


def test_geometry_finds_a_ball_that_came_through_the_sheet(monkeypatch):
    monkeypatch.setattr(contact.Contact, "step_share", lambda *ways: 1.0)
    monkeypatch.setattr(stiffening, "WAY", 1e9)
    assert "below the middle" in judged(2)[1]


@pytest.mark.nightly
def test_a_thousand_drawn_sheets():
    faults = {number: found[1] for number in range(1000) if (found := judged(number))[1]}
    assert not faults
