"""Two chains on one sheet: stiff joints meet, and the lattice agrees with the shell."""

import numpy as np
import scipy.sparse as sp

from sheetbench.numerics.saddle_point import CORRECTIONS, minimal_residual


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
