"""Drawn sheets answer alike mirrored, turned, upside down and ten times as large, but for rounding."""

import numpy as np
import pytest
from drawn_scenes import CHANGES, Change, draw, points_of

import fem_reference
import lumped
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene

ALIGNED, OBLIQUE = range(30), range(30, 50)  # seeds: of sides along the axes, of any sides
# that differed, some by ties of lines or held masses, others between cells
OFTEN = {"lattice": (3, 9, 13, 14, 24, 28, 35, 45), "shell": (9, 15, 24, 29, 32, 35, 41, 47)}


def lattice(scene):
    return lumped.solve(scene, resolve(scene, Lattice(grid=7)).calibrated())


def shell(scene):
    return fem_reference.solve(scene, "shell", elements=4)


def changed_by(seed, oblique, answer):
    """How far the answers to changed scenes are from the changed answer, in parts of the largest."""
    drawn = draw(seed, oblique)
    scene = Scene(**drawn)
    points = points_of(scene)
    whole = answer(scene)
    assert whole.status is Status.CONVERGED
    own = whole.displacement(points)
    assert np.abs(own).max() > 1e-7
    away = {}
    for kind in CHANGES:
        change = Change(kind, *scene.sheet.lengths)
        found = answer(Scene(**change.scene(drawn))).displacement([change.place(point) for point in points])
        meant = change.size * np.array([change.vector(u) for u in own])
        away[kind] = float(np.abs(found - meant).max() / np.abs(meant).max())
    return away


def seeds(model, drawn):
    return [seed if seed in OFTEN[model] else pytest.param(seed, marks=pytest.mark.nightly) for seed in drawn]


@pytest.mark.parametrize("seed", seeds("lattice", [*ALIGNED, *OBLIQUE]))
def test_a_lattice_answers_alike(seed):
    assert max(changed_by(seed, seed in OBLIQUE, lattice).values()) < 1e-9


@pytest.mark.parametrize("seed", seeds("shell", [*ALIGNED, *OBLIQUE]))
def test_a_shell_answers_alike(seed):
    assert max(changed_by(seed, seed in OBLIQUE, shell).values()) < 1e-9
