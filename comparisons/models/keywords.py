"""Flat keywords: the settings of a `Lattice` as functions take them one by one."""

from __future__ import annotations

from typing import TypedDict

from comparisons.models.grids import GridLike
from comparisons.models.spec import GradingLike


class SpringKeywords(TypedDict, total=False):
    """The flat keywords of functions that list grids and calibrations."""

    k: float | None
    layer_distance: float | None
    grading: GradingLike


class LatticeKeywords(SpringKeywords, total=False):
    """The flat keywords of every function that takes a `Lattice`."""

    grid: GridLike
    calibration: str | None


class ModesKeywords(LatticeKeywords, total=False):
    """The flat keywords of natural frequencies."""

    masses: str | None


class StaticKeywords(LatticeKeywords, total=False):
    """The flat keywords of functions that solve statics; references follow them."""

    linear: bool
    symmetry: bool
    branch: str
