"""What uses a lattice, on a graded grid of few masses: chains, files, frequencies, motion, fits."""

import meshio
import numpy as np
import pytest

import lumped
from comparisons.pictures.array_files import write_mesh
from lumped.fitting.fits import StaticTarget
from lumped.grid_lines import grid_lines
from sheetbench.answers.solution import Status
from sheetbench.scenes import load

GRADING = 0.6
SCENE = load("two-edges-clamped")


def springs_of(scene, grid=5, grading=GRADING):
    return lumped.calibrate(scene.sheet, scene.material, grid, grading=grading)


def test_a_chain_is_bound_where_the_lines_are():
    """Four segments whose joints lie between the lines: forces balance, the clamp carries all."""
    scene = load("actuated-edge")
    chain = scene.actuators[0].model_copy(update={"segments": 4})
    scene = scene.model_copy(update={"actuators": (chain,)})
    found = lumped.solve(scene, springs_of(scene))
    assert found.status is Status.CONVERGED and found.balance is not None and found.balance.holds
    weight = 9.81 * (1678.0 * 0.188**2 * 0.003 + 0.05 * 0.188)
    assert found.reactions["x0"][2] == pytest.approx(weight, rel=1e-6)


def test_a_file_of_the_answer_has_the_lines_places(tmp_path):
    springs = springs_of(SCENE)
    found = lumped.solve(SCENE, springs)
    write_mesh(tmp_path / "graded.vtu", found.mesh)
    points = meshio.read(tmp_path / "graded.vtu").points
    for axis, lines in enumerate(grid_lines(SCENE.sheet, springs.grid, GRADING)):
        assert np.unique(points[:, axis].round(9)) == pytest.approx(lines.at, abs=1e-8)


def test_a_fit_finds_the_springs_it_was_shown():
    """Displacements of a graded lattice are met by one of the same grading."""
    points = SCENE.probe_points()
    shown = springs_of(SCENE, 3)
    target = StaticTarget(SCENE, points, lumped.solve(SCENE, shown).displacement(points))
    found = lumped.calibrate(SCENE.sheet, SCENE.material, 3, "fit-static", targets=[target], grading=GRADING)
    assert isinstance(found, lumped.FittedCalibration) and found.grading == GRADING
    assert found.residual < 1e-4
