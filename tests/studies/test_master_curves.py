"""Curves without units: the elastica beside published values, a lattice on it, strips on edge."""

import pytest

from studies.master_curves import study
from studies.master_curves.twist import tip


def test_a_lattice_lies_on_the_curve(monkeypatch):
    for name, value in (("LOADS", (1.0,)), ("WIDTHS", ()), ("TWISTING", ())):
        monkeypatch.setattr(study, name, value)
    drops = {drop.model: drop.error for drop in study.measure(lambda _: None).drops}
    assert abs(drops["lattice 9"]) < 0.01 > 10 * abs(drops["shell 16"])


def test_a_strip_that_is_not_turned_is_the_elastica():
    along, aside, drop = tip(1.0, 0.3, 0.0)
    assert -drop / (1.0 + along) == pytest.approx(-study.elastica(1.0), rel=1e-5) and abs(aside) < 1e-8


def test_a_shell_lies_on_the_turned_strips_curve(monkeypatch):
    """One of a twentieth is off by (width/length)² and (h/width)²: 0.2 % each."""
    for name, value in (("LOADS", ()), ("WIDTHS", ()), ("TWISTING", (3.16,))):
        monkeypatch.setattr(study, name, value)
    monkeypatch.setattr(study, "TWISTED", {"shell 16": {"model": "shell", "elements": (16, 1)}})
    (found,) = study.measure(lambda _: None).twisted
    assert found.error < 5e-3
