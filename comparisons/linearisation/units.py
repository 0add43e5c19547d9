"""Units of a linearised lattice's inputs, by the last word of their names."""

from __future__ import annotations

FACTOR = "factor"  # of a load or the weight, as the scene has it
UNITS = {"fx": "N", "fy": "N", "fz": "N", "curvature": "1/m", "x": "m", "y": "m", "z": "m"}


def unit_of(name: str) -> str:
    """Return the unit of an input, FACTOR for a load and gravity."""
    return UNITS.get(name.split()[-1], FACTOR)
