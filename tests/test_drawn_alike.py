"""Drawn sheets answer alike mirrored, turned, upside down and ten times as large, and in other words of the
same meaning, but for rounding."""

import numpy as np
import pytest
from drawn_sheets import CHANGES, WORDS, Change, draw, furnish

import fem_reference
import lumped
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from sheetbench.answers.solution import Status
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.region import off_sheet


def points_of(scene: Scene) -> np.ndarray:
    """Plan points [m] on the sheet: on lines of a grid of 7, between them, and anywhere."""
    even = np.linspace(0.0, 1.0, 13)
    anywhere = np.random.default_rng(5).random((40, 2))
    places = np.concatenate([np.stack(np.meshgrid(even, even), axis=-1).reshape(-1, 2), anywhere])
    return np.array([point for point in places * scene.sheet.lengths if not off_sheet(scene, tuple(point))])


ALIGNED, OBLIQUE = range(30), range(30, 50)  # seeds: of sides along the axes, of any sides
# that differed, some by ties of lines or held masses, others between cells
OFTEN = {"lattice": (3, 14, 28, 45), "shell": (9, 24, 32, 47)}
# 7.5 cells of a lattice of 6 along one side, of a shell of 5 likewise
HALVES = {"lattice": (4, 18), "shell": (4, 39)}


def lattice(scene, grid=7):
    return lumped.solve(scene, resolve(scene, Lattice(grid=grid)).springs)


def shell(scene, elements=4):
    return fem_reference.solve(scene, "shell", elements=elements)


def solid(scene):
    return fem_reference.solve(scene, "solid", elements=2)


def by_turns(part, n):
    """Points of a square of side 1 about its middle, and more numbers, of n sectors."""
    turned = [(complex(x, y) * 1j ** (4 * k // n), more) for k in range(n) for x, y, *more in part]
    return [(0.5 + at.real, 0.5 + at.imag, *more) for at, more in turned]


# parts of a square of side 1 that are their own image across a diagonal or more lines, or by a turn alone
OWN_IMAGES = {
    "triangle": {"outline": [(0, 0), (1, 0), (0, 1)]},
    "cut corner": {"outline": [(0, 0), (1, 0), (1, 0.6), (0.6, 1), (0, 1)]},
    "two holes": {"holes": [(0.3, 0.7, 0.1), (0.7, 0.3, 0.1)]},
    "hole in the middle": {"holes": [(0.5, 0.5, 0.2)]},
    "parallelogram": {"outline": by_turns([(-0.5, -0.5), (0.5, -0.2)], 2)},
    "pinwheel of holes": {"holes": by_turns([(-0.2, -0.1, 0.1)], 4)},
    "pinwheel about a hole": {"holes": [*by_turns([(-0.25, -0.15, 0.08)], 4), (0.5, 0.5, 0.12)]},
    "four holes in a row": {"holes": by_turns([(-0.3, -0.2, 0.1), (-0.1, -0.15, 0.07)], 2)},
}


def square(outline=(), holes=()):
    """A drawn sheet 100 mm wide, clamped at x0."""
    scene = {**draw(0), "supports": [{"kind": "clamped", "edge": "x0"}], "loads": []}
    scene = {key: part for key, part in scene.items() if key not in ("cutouts", "patches")}
    scene["sheet"] = {"length_x": 0.1, "length_y": 0.1, "thickness": 3e-3}
    if outline:
        scene["sheet"]["outline"] = [[0.1 * x, 0.1 * y] for x, y in outline]
    circles = [{"centre": [0.1 * x, 0.1 * y], "radius": 0.1 * radius} for x, y, radius in holes]
    return {**scene, "cutouts": [{"shape": {"circle": circle}} for circle in circles]}


def changed_by(drawn, answer):
    """How far the answers to changed scenes are from the changed answer, in parts of the largest."""
    scene = Scene(**drawn)
    points = points_of(scene)
    whole = answer(scene)
    assert whole.status is Status.CONVERGED
    own = whole.displacement(points)
    assert np.abs(own).max() > 1e-7
    away = {}
    for kind in CHANGES:
        change = Change(kind, *scene.sheet.lengths)
        found = answer(Scene(**change.scene(drawn))).displacement(change.places(points))
        meant = own @ change.map.T
        away[kind] = float(np.abs(found - meant).max() / np.abs(meant).max())
    return away


def said_otherwise(drawn, answer):
    """How far the answers to the scene in other words are from its own, in parts of the largest."""
    scene = Scene(**drawn)
    points, own = points_of(scene), answer(scene)
    expected = own.displacement(points)
    away = {}
    for name, say in WORDS.items():
        found = answer(Scene(**{**drawn, **say(drawn)})).displacement(points)
        away[name] = float(np.abs(found - expected).max() / np.abs(expected).max())
    return away


MODELS = {"lattice": (lattice, 7, 6), "shell": (shell, 4, 5)}  # and sizes, one that leaves half a cell over


def rows():
    """A model, a seed and whether half a cell is left over; by day those that differed."""
    for model, often in OFTEN.items():
        for seed in (*ALIGNED, *OBLIQUE):
            yield pytest.param(model, seed, False, marks=() if seed in often else pytest.mark.nightly)
        yield from ((model, seed, True) for seed in HALVES[model])


@pytest.mark.parametrize(("model", "seed", "half"), list(rows()))
def test_a_drawn_sheet_answers_alike(model, seed, half):
    answer, *sizes = MODELS[model]
    changes = changed_by(draw(seed, seed in OBLIQUE), lambda scene: answer(scene, sizes[half]))
    assert max(changes.values()) < 1e-9


@pytest.mark.sweep(2)
@pytest.mark.parametrize("plan", OWN_IMAGES)
def test_a_shell_that_is_its_own_image_answers_alike(plan):
    """They were 1e-4 to 1e-3 off: chance chose between two like triangulations."""
    assert max(changed_by(square(**OWN_IMAGES[plan]), shell).values()) < 1e-9


FURNISHED = {"lattice": 100, "shell": 32, "solid": 24}  # so many seeds
CROSSING = 189  # a hole and a patch; its mirrored mesh was another, 9e-5
ASIDE = {  # unstable, alone or beside an obstacle that is far off; a point without a line; contact of minutes
    "lattice": {20, 21, 36, 37, 40, 70},
    "shell": {11, 20, 21},
    "solid": {12, 20, 21},
}


def furnished():
    """Models and seeds; the solid's of sheets as thick all over."""
    yield "shell", CROSSING
    for model, count in FURNISHED.items():
        for seed in sorted(set(range(count)) - ASIDE[model]):
            stepped = any("thickness" in patch for patch in furnish(seed).get("patches", []))
            if not (model == "solid" and stepped):
                yield model, seed


@pytest.mark.nightly
@pytest.mark.parametrize(("model", "seed"), list(furnished()))
def test_a_sheet_with_everything_answers_alike_changed_and_in_other_words(model, seed):
    """Lines on a point were those of the sheet that had not grown: 0.4 %."""
    answers = {
        "lattice": lambda scene: lattice(scene, 5),
        "shell": lambda scene: shell(scene, 3),
        "solid": solid,
    }
    drawn, answer = furnish(seed), answers[model]
    assert max((changed_by(drawn, answer) | said_otherwise(drawn, answer)).values()) < 1e-7
