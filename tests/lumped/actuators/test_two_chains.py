"""Two chains on one sheet: stiff joints meet, and the lattice agrees with the shell."""

import numpy as np
import pytest
import scipy.sparse as sp

import fem_reference
import lumped
from sheetbench.answers.solution import Status
from sheetbench.numerics.saddle_point import CORRECTIONS, minimal_residual
from sheetbench.scenes import Chain, Clamped, Gravity, Material, Scene, Sheet

WEIGHT = Gravity(acceleration=(0.0, 0.0, -9.81))
SOFT = Material(young=20e6, poisson=0.0, density=1200.0)
STIFF_CHAIN = dict(segments=24, bending_stiffness=3e-3, line_density=0.03, radius=1.5e-3)


def strip(base, curvatures, width):
    """A strip clamped at x0 with a chain on each long edge, a segment a cell."""
    chains = [
        Chain(edge=edge, base=base, curvature=curvature, **STIFF_CHAIN)
        for edge, curvature in zip(("y0", "y1"), curvatures, strict=True)
    ]
    return Scene(
        name="two-chains", sheet=Sheet(length_x=0.2, length_y=width, thickness=0.002), material=SOFT,
        gravity=WEIGHT, supports=(Clamped(edge="x0"),), actuators=tuple(chains),
    )  # fmt: skip


@pytest.mark.sweep
@pytest.mark.parametrize("base", ["start", "free"])
@pytest.mark.parametrize("curvatures", [(9.0, 9.0), (9.0, -9.0)], ids=["equal", "antagonistic"])
@pytest.mark.parametrize(("width", "rows"), [(0.016, 3), (0.1, 13)], ids=["narrow", "wide"])
def test_the_lattice_agrees_with_the_shell(base, curvatures, width, rows):
    scene = strip(base, curvatures, width)
    springs = lumped.calibrate(scene.sheet, scene.material, grid=(25, rows), method="consistent")
    found = lumped.solve(scene, springs)
    shell = fem_reference.solve(scene, model="shell", elements=4)
    assert (found.status, shell.status) == (Status.CONVERGED, Status.CONVERGED), found.message
    points = np.array([(x, y) for x in (0.1, 0.2) for y in (0.0, 0.5 * width, width)])
    truth = shell.displacement(points)
    assert np.abs(found.displacement(points) - truth).max() < 0.01 * np.abs(truth).max()


def test_nearly_dependent_constraints_take_a_few_corrections():
    """Factors of a matrix close by miss three eigenvalues by a factor of 40: plain refinement gains a digit
    in some ninety steps, minimal residuals take a step for each."""
    draw = np.random.default_rng(0)
    n = 60
    own, _ = np.linalg.qr(draw.standard_normal((n, n)))
    eigenvalues = np.linspace(1.0, 2.0, n)
    close_by = eigenvalues.copy()
    close_by[[5, 20, 40]] *= 40.0
    matrix, b = sp.csc_array(own @ np.diag(eigenvalues) @ own.T), draw.standard_normal(n)
    calls = []

    def solve(right):
        calls.append(1)
        return own @ ((own.T @ right) / close_by)

    x, miss = minimal_residual(matrix, solve, b)
    assert miss < 1e-14
    assert len(calls) <= 6 < CORRECTIONS
    np.testing.assert_allclose(matrix @ x, b, atol=1e-13 * np.abs(b).max())
    assert minimal_residual(matrix, solve, np.zeros(n))[1] == 0.0
