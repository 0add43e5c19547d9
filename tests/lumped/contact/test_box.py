"""A box as an obstacle: its faces are planes, its edges cylinders, in lattice and shell."""

from functools import partial

import numpy as np
import pytest
from cases import equilibrium
from contact_cases import (
    FALLEN,
    FALLING,
    OBSTACLES,
    THICKNESS,
    WEIGHT,
    bent_elastica,
    bent_over,
    heavy_elastica,
    laid_strip,
)

import lumped
from comparisons.codes.lattice import lattice_files
from sheetbench.answers.solution import Status
from sheetbench.scenes import Box, SceneError
from sheetbench.scenes.meaning.distances import near


def box_below(top, middle=(0.5, 0.05), size=(3.0, 1.0, 1.0), radius=0.1):
    return Box(position=(*middle, top - 0.5 * size[2]), size=size, radius=radius)


@pytest.mark.parametrize(
    ("model", "most"), [("lumped", 95), pytest.param("shell", 180, marks=pytest.mark.nightly)]
)
def test_strip_on_a_face_lies_as_on_a_plane(model, most):
    """By the integrals of edges, that take three to seven times as many factorisations there."""
    scene = laid_strip(0.05, obstacles=(box_below(-0.05 - THICKNESS / 2),))
    solution = equilibrium(scene, model, (41, 3), (10, 1), graded=False)
    assert solution.status is Status.CONVERGED and solution.iterations <= most
    _, carried, _ = heavy_elastica(0.05)
    assert solution.reactions["x0"][2] / WEIGHT == pytest.approx(carried, rel=1e-3)
    assert sum(f[2] for f in solution.reactions.values()) == pytest.approx(WEIGHT, rel=1e-7)


@pytest.mark.parametrize(("model", "within"), [("lumped", 6e-4), ("shell", 3e-3)])
def test_strip_over_an_edge_is_bent_as_over_a_cylinder(model, within):
    scene, at = bent_over(), 0.4
    rod = scene.obstacles[0].radius
    edge = box_below(-0.15 + rod, (at, 0.05), (2.0 * rod, 1.0, 2.0), rod)
    solution = equilibrium(scene.replace(obstacles=(edge,)), model, (41, 3), (10, 1), graded=False)
    force = np.linalg.norm(solution.reactions["obstacle 1"])
    assert force == pytest.approx(bent_elastica(at), rel=within)


@pytest.mark.parametrize("body", [box_below(0.1, (0.0, 0.0), (0.6, 0.4, 0.2), 0.06), OBSTACLES["cylinder"]])
def test_ways_end_before_they_lead_deeper_than_half_the_radius(body):
    """Against the first of many points of each way that is."""
    beside = partial(near, body, offset=np.array(0.0), at=(1.0, None))
    hits, steps = 0, np.linspace(0, 1, 4001)
    ends = np.random.default_rng(3).normal(scale=0.4, size=(2, 400, 3)) + body.position
    for first, last in zip(*ends, strict=True):
        deep = beside(first + steps[:, None] * (last - first)).depth > 0.5 * body.radius
        found = beside(last).free_share(beside(first))
        if deep[0] or not deep.any():
            assert found >= 0.99
        else:
            hits += 1
            assert found == pytest.approx(0.99 * steps[deep.argmax()], abs=3e-4)
    assert hits > 30


def test_strip_that_falls_over_an_edge_keeps_its_energy():
    """With conserving steps, whose mean normals follow the nearest points of the core."""
    edge = box_below(-0.006, (0.05, 0.025), (0.1, 0.045, 0.05), 0.02)
    springs = lumped.calibrate(FALLING.sheet, FALLING.material, grid=(7, 3, 2))
    scene = FALLING.replace(obstacles=(edge,))
    history = lumped.simulate(scene, springs, 0.06, integrator="midpoint", step=2e-3)
    assert history.status is Status.CONVERGED
    assert history.reactions["obstacle 1"][:, 2].max() > 0.0
    assert np.abs(history.balance - history.balance[0]).max() < 1e-8 * FALLEN


@pytest.mark.parametrize("code", [None, "c", "matlab"])
def test_files_for_other_programs_refuse_a_box_by_name(code):
    scene = laid_strip(0.05, obstacles=(box_below(-0.1),))
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(5, 3, 2))
    with pytest.raises(SceneError, match="obstacle 1: an exported lattice has no contact with a box"):
        lattice_files(scene, springs, code)
