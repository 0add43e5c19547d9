"""Large lattices from smaller ones: where the corrections of one start is the equilibrium of the lattice of
half as many cells a side, and so on down, interpolated by cubic splines.

Two factorisations are left for each lattice, one to correct with (`numerics.direct.iterated`) and one of the
equilibrium's own tangent, which tells its stability. The branch is the smaller lattice's: only from a path
that neither snapped nor ended early, to a stable equilibrium that there is no doubt about. Anything else, and
a start from which the corrections fail or that leads to an unstable equilibrium, goes the whole path as small
lattices do. The smaller lattices have `consistent` springs, whose answers hardly depend on the grid; so must
the lattice's own be.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from lumped.calibration import Calibration
from lumped.calibration.consistent import consistent
from lumped.lattice import Lattice
from sheetbench.scenes import Scene

METHOD = "consistent"
FROM = 5_000  # unknowns from which smaller lattices cost less than the factorisations they spare


def halved(scene: Scene, calibration: Calibration) -> Calibration | None:
    """Springs of the lattice with half as many cells a side; None where there is none to start from."""
    nx, ny, layers = calibration.grid
    other = calibration.method != METHOD or calibration.cells is not None
    if other or layers != 2 or scene.actuators:
        return None
    grid = (nx // 2 + 1, ny // 2 + 1, layers)
    if min(grid[:2]) < 5:
        return None
    coarser = consistent(scene.sheet, scene.material, grid, grading=calibration.grading)
    return replace(coarser, masses=calibration.masses)


def refined(coarse: Lattice, u: np.ndarray, fine: Lattice) -> np.ndarray:
    """Displacement (n, 3) [m] of the fine lattice's masses from that of the coarse one's: the mid-surface,
    and the layers' distances from it in proportion."""
    columns = u[: coarse.mass_count].reshape(coarse.grid[1], coarse.grid[0], 2, 3)
    ratio = fine.layer_distance / coarse.layer_distance
    middle = _splined(coarse, columns.mean(axis=2), fine)
    half = _splined(coarse, 0.5 * ratio * (columns[:, :, 1] - columns[:, :, 0]), fine)
    return np.stack([middle - half, middle + half], axis=2).reshape(-1, 3)


def _splined(coarse: Lattice, field: np.ndarray, fine: Lattice) -> np.ndarray:
    """A field (ny, nx, 3) at the coarse grid's lines at those of the fine one."""
    from scipy.interpolate import make_interp_spline

    for axis, which in ((0, 1), (1, 0)):
        field = make_interp_spline(coarse.lines[which].at, field, k=3, axis=axis)(fine.lines[which].at)
    return field
