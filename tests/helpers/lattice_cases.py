"""A small lattice of every spring family at once, for the tests of energy, force and tangent."""

import numpy as np
import scipy.sparse as sp

from lumped.assembly import Assembly
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.report import report
from lumped.spring_constants import Springs
from sheetbench.scenes import Material, PerDirection, Sheet, SpringSet

SHEET = Sheet(length_x=0.2, length_y=0.3, thickness=0.01)
MATERIAL = Material(young=1e6, poisson=0.3, density=1000.0)
NONE = {"axial": 0.0, "diagonal": 0.0, "vertical": 0.0, "cross": 0.0, "cross_diagonal": 0.0}
TERMS = [*NONE, "area", "mid_area", "shear", "stretch", "mid_shear", "mid_stretch"]
ALL = {
    **dict.fromkeys(NONE, 90.0),
    "axial": PerDirection(x=100.0, y=70.0),
    "area": 40.0,
    "mid_area": -8.0,
    "shear": 30.0,
    "stretch": PerDirection(x=35.0, y=15.0),
    "mid_shear": 20.0,
    "mid_stretch": 25.0,
}


def assembly_of(grid=(3, 4, 2), **springs):
    table = SpringSet(**{**NONE, **springs}, layer_distance=0.02 / (grid[2] - 1))
    return Assembly(SHEET, report("test", each_cell(SHEET, MATERIAL, grid), Springs.read(table)))


def dense(assembly, blocks):
    pattern = assembly.pattern
    return sp.bsr_array((blocks, pattern.indices, pattern.indptr)).toarray()


def state(assembly, size=0.02, seed=1):
    return size * np.random.default_rng(seed).standard_normal((assembly.lattice.mass_count, 3))


def derivative(function, u, h=1e-6):
    """Return central differences of a function (n, 3) → (…), one column per component of u."""
    columns = []
    for i in range(u.size):
        step = np.zeros(u.size)
        step[i] = h
        step = step.reshape(u.shape)
        columns.append((np.ravel(function(u + step)) - np.ravel(function(u - step))) / (2 * h))
    return np.stack(columns, axis=-1)
