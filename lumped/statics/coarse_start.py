"""Starts of large lattices from smaller ones: the equilibrium of the lattice with half as many cells a side,
computed from a smaller one in turn, and interpolated by cubic splines.

Each lattice needs two factorisations, one for the corrections (`numerics.direct.iterated`) and one of the
equilibrium's tangent, whose signs decide its stability. The branch is the smaller lattice's, used only after
a path that neither snapped nor ended early, to a stable equilibrium without notes. Otherwise, and if the
corrections fail or lead to an unstable equilibrium, the whole path is traced as on small lattices. The
smaller lattices have `consistent` springs, whose answers hardly depend on the grid; so must the large one.
"""

from dataclasses import replace

import numpy as np

from lumped.calibration import Calibration
from lumped.calibration.consistent import consistent
from lumped.lattice import Lattice
from sheetbench.scenes import Scene

METHOD = "consistent"
FROM = 5_000  # unknowns from which smaller lattices cost less than the factorisations they save


def coarser_springs(scene: Scene, calibration: Calibration) -> Calibration | None:
    """Return springs of the lattice with half as many cells a side, None if it cannot serve as a start."""
    nx, ny, layers = calibration.grid
    other = calibration.method != METHOD or calibration.cells is not None
    if other or layers != 2 or scene.actuators:
        return None
    grid = (nx // 2 + 1, ny // 2 + 1, layers)
    if min(grid[:2]) < 5:
        return None
    coarser = consistent(scene.sheet, scene.material, grid, grading=calibration.grading)
    return replace(coarser, masses=calibration.masses)


def interpolated_displacement(coarse: Lattice, u: np.ndarray, fine: Lattice) -> np.ndarray:
    """Return the displacement (n, 3) [m] of the fine lattice's masses from the coarse lattice's: the
    mid-surface's by splines, and the layers' distances from it in proportion."""
    columns = u[: coarse.mass_count].reshape(coarse.grid[1], coarse.grid[0], 2, 3)
    ratio = fine.layer_distance / coarse.layer_distance
    middle = _interpolated_field(coarse, columns.mean(axis=2), fine)
    half = _interpolated_field(coarse, 0.5 * ratio * (columns[:, :, 1] - columns[:, :, 0]), fine)
    return np.stack([middle - half, middle + half], axis=2).reshape(-1, 3)


def _interpolated_field(coarse: Lattice, field: np.ndarray, fine: Lattice) -> np.ndarray:
    """Return a field (ny, nx, 3) on the coarse grid's lines, interpolated to the fine grid's lines."""
    from scipy.interpolate import make_interp_spline

    for axis, which in ((0, 1), (1, 0)):
        field = make_interp_spline(coarse.lines[which].at, field, k=3, axis=axis)(fine.lines[which].at)
    return field
