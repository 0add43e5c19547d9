"""An edge moved rigidly, on every reference."""

from __future__ import annotations

import numpy as np
import pytest
from cases import RUBBER, SHEET
from rod_cases import driven, shell

import fem_reference
import lumped
from sheetbench.scenes import EdgeMotion, Gravity, Status


def test_an_edge_moved_rigidly_takes_a_free_sheet_with_it() -> None:
    motion = EdgeMotion(
        kind="motion", edge="y1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.01, -0.02, 0.03)), rotation=((0, 0, 0), (0.5, -0.3, 0.2)),
    )  # fmt: skip
    scene = driven(gravity=None).model_copy(update={"supports": (), "actuators": (motion,)})
    solution = shell(scene, 4)
    assert solution.status is Status.CONVERGED
    assert sum(solution.energies.values()) < 1e-12
    corners = solution.displacement([[0.0, 0.0], [0.188, 0.0], [0.0, 0.188]])
    flat = np.array([[0.0, 0.0, 0.0], [0.188, 0.0, 0.0], [0.0, 0.188, 0.0]])
    assert np.linalg.norm(np.diff(flat + corners, axis=0), axis=1) == pytest.approx(
        np.linalg.norm(np.diff(flat, axis=0), axis=1), rel=1e-9
    )
    middle = solution.displacement([[0.094, 0.188]])[0]
    np.testing.assert_allclose(middle, [0.01, -0.02, 0.03], atol=1e-12)


def test_an_edge_moved_rigidly_agrees_with_the_lattice() -> None:
    motion = EdgeMotion(
        kind="motion", edge="x1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.0, 0.0, 0.01)), rotation=((0, 0, 0), (0.1, -0.1, 0.02)),
    )  # fmt: skip
    scene = driven(motion).model_copy(update={"probes": {"P1": (0.094, 0.094), "P2": (0.094, 0.188)}})
    reference = shell(scene, 12)
    lattice = lumped.solve(scene, lumped.calibrate(SHEET, RUBBER, grid=(17, 17), method="consistent"))
    points = scene.probe_points()
    truth = reference.displacement(points)
    assert np.abs(lattice.displacement(points) - truth).max() < 5e-3 * 0.011
    assert reference.actuators["x1"].shape == (1, 6)
    np.testing.assert_allclose(
        reference.actuators["x1"][0, :3], lattice.actuators["x1"][0, :3], rtol=0.03, atol=0.02
    )


def test_on_the_plate_an_edge_moves_rigidly() -> None:
    """A small motion, as the shell has it; a free sheet is taken along without strain."""
    motion = EdgeMotion(
        kind="motion", edge="x1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.0, 1e-6, 1e-5)), rotation=((0, 0, 0), (1e-4, -1e-4, 2e-6)),
    )  # fmt: skip
    scene = driven(motion, gravity=Gravity(acceleration=(0.0, 0.0, -1e-2)))
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    plate = fem_reference.solve(scene, model="plate", elements=12)
    expected = fem_reference.solve(scene, model="shell", elements=12)
    truth = expected.displacement(points)
    assert np.abs(plate.displacement(points) - truth).max() < 3e-3 * np.abs(truth).max()
    wrench = expected.actuators["x1"]
    np.testing.assert_allclose(plate.actuators["x1"], wrench, atol=5e-3 * np.abs(wrench).max())
    free = fem_reference.solve(scene.model_copy(update={"supports": (), "gravity": None}), model="plate")
    assert sum(free.energies.values()) < 1e-20
    turned = np.cross([1e-4, -1e-4, 2e-6], [-0.188, -0.094, 0.0])
    np.testing.assert_allclose(free.displacement([[0.0, 0.0]])[0] - turned, [0.0, 1e-6, 1e-5], atol=1e-12)


def test_on_the_solid_an_edge_moves_rigidly() -> None:
    motion = EdgeMotion(
        kind="motion", edge="x1", time=(0.0, 1.0),
        displacement=((0, 0, 0), (0.0, 0.0, 0.01)), rotation=((0, 0, 0), (0.1, -0.1, 0.02)),
    )  # fmt: skip
    scene = driven(motion)
    points = np.random.default_rng(0).uniform(0.0, 0.188, (50, 2))
    answer, expected = fem_reference.solve(scene, model="solid", elements=8), shell(scene)
    assert answer.status is Status.CONVERGED
    truth = expected.displacement(points)
    assert np.abs(answer.displacement(points) - truth).max() < 3e-3 * np.abs(truth).max()
    wrench = expected.actuators["x1"]
    np.testing.assert_allclose(answer.actuators["x1"], wrench, atol=2e-2 * np.abs(wrench).max())
    alone = scene.model_copy(update={"supports": (), "gravity": None})
    free = fem_reference.solve(alone, model="solid", elements=2)
    assert sum(free.energies.values()) < 1e-12
