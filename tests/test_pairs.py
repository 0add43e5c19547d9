"""Pairs of kinds of objects in a scene, at rest, in motion and in modes, on small grids of every model."""

from itertools import combinations_with_replacement

import numpy as np
import pytest
from cases import sheet

import fem_reference
import lumped
from comparisons.models.resolve import resolve
from comparisons.models.solve import simulate, solve
from comparisons.models.spec import Elements, Lattice
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput

HISTORY = {"time": [0.0, 5e-4], "factor": [0.0, 1.0]}
PART = {"rectangle": {"x": (0.02, 0.09), "y": (0.0, 0.05)}}
BOX = {"rectangle": {"x": (0.02, 0.04), "y": (0.02, 0.04)}}
DISC = {"circle": {"centre": (0.08, 0.05), "radius": 0.015}}
RUBBER = {"young": 5e6, "poisson": 0.4, "density": 1e3}
ROD = {"kind": "chain", "segments": 4, "bending_stiffness": 1e-4, "line_density": 0.02, "radius": 0.002}
BENT = {"natural": {"curvature": (9.0, 0.0, 0.0), "history": HISTORY}}
KINDS = {  # table and rows: of the first of a pair, and of the second; obstacles are touched at 0.8 ms
    "chain": ("actuators", ROD | {"edge": "x1", "curvature": 3.0}, ROD | {"edge": "y1", "curvature": 1.0}),
    "obstacle": (
        "obstacles",
        {"kind": "plane", "position": (0.0, 0.0, -0.001503)},
        {"kind": "sphere", "position": (0.06, 0.04, -0.031503), "radius": 0.03},
    ),
    "payload": ("masses", {"mass": 0.001, "where": PART}, {"mass": 0.001, "at": (0.12, 0.08)}),
    "natural": ("patches", {"shape": BOX, "natural": {"strain": (2e-3, 0.0, 0.0)}}, {"shape": PART} | BENT),
    "cutout": ("cutouts", {"shape": DISC}, {"shape": BOX}),
    "patch": ("patches", {"shape": BOX, "young": 2e7}, {"shape": DISC, "young": 4e6, "thickness": 0.002}),
    "pressure": (
        "loads",
        {"kind": "pressure", "value": 5.0},
        {"kind": "pressure", "value": 5.0, "where": PART, "history": HISTORY},
    ),
    "air": ("air", {"drag": 1.2}),
    "relaxation": ("material", RUBBER | {"relaxation": [{"share": 0.2, "time": 0.05}]}),
    "point support": (
        "supports",
        {"kind": "point", "at": (0.08, 0.08), "components": ("z",)},
        {"kind": "point", "at": (0.06, 0.0)},
    ),
}
PAIRS = [
    (a, b) for a, b in combinations_with_replacement(KINDS, 2) if a != b or a not in ("air", "relaxation")
]


def scene(*objects):
    """A clamped sheet under its weight with objects, each a table and a row of it."""
    found = sheet(0.12, 0.08, 0.003, weight=9.81, probes={}, material=RUBBER)
    for table, row in objects:
        there = getattr(found, table)
        found = found.replace(**{table: (*there, row) if isinstance(there, tuple) else row})
    return found


def rest(scene, spec):
    found = solve(resolve(scene, spec))
    assert found.balance.holds
    return found.status


def motion(scene, spec):
    """With friction, in five steps of one length, which an error does not shorten."""
    rough = scene.replace(obstacles=[one.replace(friction=0.2) for one in scene.obstacles])
    return simulate(resolve(rough, spec, "motion"), 1e-3, step=2e-4).status


def modes(scene, spec, about="flat"):
    if isinstance(spec, Lattice):
        found = lumped.modes(scene, resolve(scene, spec).springs, 2, about=about)
    else:
        found = fem_reference.modes(scene, spec.kind, elements=2, count=2, about=about)
    return Status.CONVERGED if np.all(found.frequencies > 0.0) else found.frequencies


def deformed(scene, spec):
    return modes(scene, spec, "deformed")


LATTICE, PLATE, SHELL, SOLID = Lattice(4), *(Elements(kind, 2) for kind in ("plate", "shell", "solid"))
QUESTIONS = [
    *((rest, spec) for spec in (LATTICE, PLATE, SHELL, SOLID)),
    *((modes, spec) for spec in (LATTICE, PLATE, SHELL, SOLID)),
    *((ask, spec) for ask in (motion, deformed) for spec in (LATTICE, SHELL)),
]


def rows():
    """Every pair with every question; those of chain and obstacle in motion, and one in 37, always."""
    every = [(pair, *question) for pair in PAIRS for question in QUESTIONS]
    for number, (pair, ask, spec) in enumerate(every):
        usual = number % 37 == 0 or (pair == ("chain", "obstacle") and ask is motion and spec is LATTICE)
        marks = () if usual else pytest.mark.nightly
        yield pytest.param(pair, ask, spec, id=f"{ask.__name__} {spec.model} {'+'.join(pair)}", marks=marks)


def refused(ask, spec, *objects):
    """Whether a question is refused; else the answer is there."""
    try:
        assert ask(scene(*objects), spec) is Status.CONVERGED
    except BadInput:
        return True
    return False


@pytest.mark.parametrize(("pair", "ask", "spec"), list(rows()))
def test_a_pair_has_an_answer_unless_one_of_it_alone_has_none(pair, ask, spec):
    (table, first, *_), (other, *_, second) = (KINDS[name] for name in pair)
    if refused(ask, spec, (table, first), (other, second)):
        assert refused(ask, spec, (table, first)) or refused(ask, spec, (other, second))
