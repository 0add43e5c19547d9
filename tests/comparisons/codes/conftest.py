"""What the tests of codes share: an error in the limit that is found on a coarse mesh."""

import pytest

from comparisons.codes import coefficients, setup


@pytest.fixture
def coarse_limits(monkeypatch):
    """The error of however fine a mesh is found on 2 × 2 elements: for tests of what else a set-up holds."""
    monkeypatch.setattr(setup, "limit_error", lambda *given: coefficients.limit_error(*given, elements=2))
