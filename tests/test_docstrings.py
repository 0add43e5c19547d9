"""The examples in the docstrings of public functions give what they say."""

import doctest
import importlib

import pytest

MODULES = [
    "fem_reference",
    "fem_reference.linear_buckling",
    "fem_reference.vibration",
    "lumped.dynamics.runs.simulation",
    "lumped.fitting.methods",
    "lumped.statics.buckling",
    "lumped.statics.solver",
    "lumped.vibration",
    "sheetbench.numerics.direct",
    "sheetbench.numerics.eigenmodes",
    "sheetbench.numerics.kept",
    "sheetbench.numerics.stability",
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_run_as_written(name):
    found = doctest.testmod(importlib.import_module(name))
    assert found.attempted > 0 and found.failed == 0
