"""How the sheet's mass is shared out among the lumped masses.

tributary  each mass takes the sheet around it: ½ on edges, ¼ at corners. The trapezoidal rule for the
           inertia, whose error at a free edge is l²/12 times the slope of what is integrated: frequencies
           come out too low.
gregory    Gregory's end-corrected weights 5/12, 13/12, 1, … along each side: the same total, the leading
           error of the edges gone. On the seed's sheet at 9×9×2 the first three frequencies are within 1 %
           instead of 3.5 % (tests/test_vibration.py).

Loads stay tributary: static deflections were calibrated with them. With "gregory" weight and inertia are
therefore shared out differently, and a sheet that falls freely would bend a little.
Source: Gregory's quadrature, e.g. Hildebrand, Introduction to Numerical Analysis, 5.9.
"""

from __future__ import annotations

import numpy as np

from lumped.lattice import Lattice
from sheetbench.scenes import Scene
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.springs import Distribution


def masses(scene: Scene, lattice: Lattice, distribution: Distribution = "tributary") -> np.ndarray:
    """Mass of every lumped mass, (n,) [kg]; they add up to the sheet's.

    Raises BadInput for an unknown distribution or, with "gregory", fewer than four masses a side or unequal
    cells.
    """
    lx, ly, _ = lattice.spacing
    nx, ny, layers = lattice.grid
    per_cell = scene.material.density * scene.sheet.thickness * lx * ly / layers
    if distribution == "tributary":
        return per_cell * lattice.share
    if distribution != "gregory":
        raise BadInput(f"masses = {distribution!r}: choose from tributary, gregory")
    if any(np.ptp(side.widths) for side in lattice.lines):
        raise BadInput("masses = 'gregory' is for cells of one size: take tributary masses on a graded grid")
    plan = np.outer(_gregory(ny), _gregory(nx)).ravel()
    return per_cell * np.repeat(plan, layers)


def _gregory(n: int) -> np.ndarray:
    if n < 4:
        raise BadInput(f"masses = 'gregory' needs at least 4 masses a side, not {n}")
    weights = np.ones(n)
    weights[[0, -1]], weights[[1, -2]] = 5.0 / 12.0, 13.0 / 12.0
    return weights
