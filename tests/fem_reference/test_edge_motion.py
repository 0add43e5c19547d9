"""An edge moved rigidly, on every reference and the lattice."""

import numpy as np
import pytest
from cases import RUBBER, SHEET
from rod_cases import driven

import fem_reference
import lumped
from sheetbench.answers.solution import Status
from sheetbench.scenes import EdgeMotion


def motion(displacement, rotation, edge="x1"):
    still = (0.0, 0.0, 0.0)
    return EdgeMotion(
        kind="motion",
        edge=edge,
        time=(0.0, 1.0),
        displacement=(still, displacement),
        rotation=(still, rotation),
    )


@pytest.mark.parametrize(("model", "scale"), [("shell", 1.0), ("solid", 1.0), ("plate", 1e-4)])
def test_an_edge_moved_rigidly_takes_a_free_sheet_with_it(model, scale):
    """Without strain; the plate by a small motion, in which nothing is longer to first order."""
    shift, turn = scale * np.array([0.01, -0.02, 0.03]), scale * np.array([0.5, -0.3, 0.2])
    moved = motion(tuple(shift), tuple(turn), "y1")
    scene = driven(gravity=None).model_copy(update={"supports": (), "actuators": (moved,)})
    solution = fem_reference.solve(scene, model, elements=3)
    assert solution.status is Status.CONVERGED
    assert sum(solution.energies.values()) < 1e-12 * scale**2
    flat = np.array([[0.0, 0.0, 0.0], [0.188, 0.0, 0.0], [0.0, 0.188, 0.0]])
    corners = flat + solution.displacement(flat[:, :2])
    sides = np.linalg.norm(np.diff(flat, axis=0), axis=1)
    assert np.linalg.norm(np.diff(corners, axis=0), axis=1) == pytest.approx(
        sides, rel=max(1e-9, 1e-8 / scale * (scale < 1))
    )
    np.testing.assert_allclose(solution.displacement([[0.094, 0.188]])[0], shift, atol=1e-12)


def lattice(scene):
    return lumped.solve(scene, lumped.calibrate(SHEET, RUBBER, grid=(17, 17), method="consistent"))
