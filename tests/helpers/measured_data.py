"""Measured data by others, in `../shared/data` of a checkout: tests that need a file skip without it."""

from pathlib import Path

import pytest


def measured_data(name: str) -> Path:
    """The file of this name below `shared/data`, which stands beside the checkout or above it."""
    for above in Path(__file__).parents[2].parents:
        if (found := above / "shared" / "data" / name).is_file():
            return found
    pytest.skip(f"../shared/data/{name} is not there")
