"""One run of every verb's small command and one comparison, which all tests judge that would make them again;
coarse limits."""

import pytest
from verbs import keep, write_inputs

from comparisons.codes import coefficients, setup
from comparisons.comparison.comparison import compare
from comparisons.models.spec import Lattice


@pytest.fixture(scope="session")
def kept(tmp_path_factory):
    """Return a name's kept run, made where it is first wanted."""
    base, found = tmp_path_factory.mktemp("verbs"), {}
    write_inputs(base)

    def kept(name):
        if name not in found:
            if name == "report":
                kept("stability")  # the folder that it reads
            found[name] = keep(name, base)
        return found[name]

    return kept


@pytest.fixture(scope="session")
def compared():
    """Habibi et al.'s first test by 5 × 5 × 2 masses and by a shell of 6 elements."""
    return compare("two-edges-clamped", Lattice(5), elements=6)


@pytest.fixture
def coarse_limits(monkeypatch):
    """The error of however fine a mesh is found on 2 × 2 elements: for tests of what else a set-up holds."""
    monkeypatch.setattr(setup, "limit_errors", lambda scene: coefficients.limit_errors(scene, 2))
