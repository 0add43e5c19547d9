"""Habibi et al.'s displacement tables in the axes of our scenes, without obvious misprints.

The frame of the published test 1 has y pointing the other way, so there −uy is taken. That test is its own
mirror image about the diagonal of the sheet, which exchanges x and y, P2 and P3: a uy whose sign is not that
of the mirrored ux is a misprint, and left out.
"""

from __future__ import annotations

from functools import cache

import numpy as np

from sheetbench.answers.habibi import PROBES, published_displacements, published_inputs
from sheetbench.scenes import Scene, load
from sheetbench.scenes.meaning.parameters import put

COMPONENTS = ("ux", "uy", "uz")
SOURCES = ("model", "experiment")
DIGIT = 1e-5  # m, the last one printed: a value is within half of it
SCENES = {1: "two-edges-clamped", 2: "curved-edge"}
_MIRRORED = [0, 2, 1, 3]  # the probes of test 1 beyond its diagonal


def scene(test: int, sense: int = 1) -> Scene:
    """Return the scene of a test with the published inputs; sense: 1 where the rod of test 2 lifts its ends,
    or -1: only the size of its curvature is published."""
    loaded = load(SCENES[test])
    return put(loaded, "curvature_x0", sense * published_inputs()["curvature"]) if test == 2 else loaded


@cache
def printed(test: int, source: str) -> np.ndarray:
    """Displacements (4, 3) [m] of the probes as printed, in the published axes."""
    given = published_displacements()
    return np.array([[given[test, source, component, probe] for component in COMPONENTS] for probe in PROBES])


def published(test: int, source: str) -> np.ndarray:
    """Displacements (4, 3) [m] of the probes in the scene's axes, nan where the print cannot be meant."""
    table = printed(test, source).copy()
    if test == 1:
        table[:, 1] *= -1.0
        table[table[:, 1] * table[_MIRRORED, 0] < 0.0, 1] = np.nan
    return table
