"""What data tell of parameters: intervals, and which cannot be told apart."""

import numpy as np
import pytest

from lumped import identifiability


def test_intervals_of_a_straight_line():
    """y = a + b x with known noise: the textbook's t interval (Bates and Watts 1988, 1.2)."""
    rng = np.random.default_rng(5)
    x = np.linspace(0, 1, 20)
    jacobian = np.stack([np.ones(20), x], axis=1)
    hits = 0
    for _ in range(400):
        noise = rng.standard_normal(20)
        estimate = np.linalg.lstsq(jacobian, noise, rcond=None)[0]
        known = identifiability(["a", "b"], jacobian, noise - jacobian @ estimate)
        hits += abs(estimate[1]) < known.half_widths["b"]
    assert hits / 400 == pytest.approx(0.95, abs=0.03)


def test_what_cannot_be_told_apart_is_said():
    x = np.linspace(0, 1, 20)
    noise = np.random.default_rng(1).standard_normal(20)
    same = identifiability(["a", "b", "c"], np.stack([x, x, 1 - x], axis=1), noise)
    assert same.half_widths["a"] == same.half_widths["b"] == np.inf and np.isfinite(same.half_widths["c"])
    assert "a, b" in same.warnings[0]
    close = identifiability(["a", "b"], np.stack([x, x + 0.05 * x**2], axis=1), noise)
    assert any("cannot tell a from b" in warning for warning in close.warnings)
