"""What benchmarks hold ours against is given the same equations."""

import runpy
from pathlib import Path

import numpy as np

BENCHMARKS = Path(__file__).parent.parent / "benchmarks"


def test_scipy_is_given_the_lattices_own_jacobian(monkeypatch):
    """Against central differences of the right-hand side, in a bent state at rest."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    system, rate, jacobian = runpy.run_path(str(BENCHMARKS / "settling.py"))["equations"]()
    n, rng, h = system.reduced_mass.shape[0], np.random.default_rng(3), 1e-8
    y, along = np.zeros(2 * n), rng.standard_normal(2 * n)
    y[:n] = 1e-4 * rng.standard_normal(n)
    slope = (rate(0.1, y + h * along) - rate(0.1, y - h * along)) / (2 * h)
    exact = jacobian(0.1, y) @ along
    np.testing.assert_allclose(slope, exact, atol=1e-5 * np.abs(exact).max())
