"""The best lattice of links alone, for simulators without area springs: a sheet with Cauchy's relation.

Central springs give a layer C12 = C66, so that D12 and D66 cannot both be matched unless ν = 1/3. Required is

    D11 = a D,  D12 = D66 = b D,  A11 = c A,  A12 = A66 = (b/a) c A,  S = S*,

with a, b, c of ν from a table, trained to minimise the largest error of a set of scenes
(`lumped.calibration.central_table`, `make central`); at ν = 1/3 they are 1, 1/3, 1. Then no solve is needed:
for σ = Σ z_k²/lz² of layers, σ' of gaps, G11 lz² = S*x lx²/s, G12 lz² = p of a gap and r = lx/ly,

    C66 lz² = (b D − σ' p)/σ,   C11 lz² = (a D − σ' G11 lz²)/σ,   p = (b/a) G11 lz²,

diagonals carry C66, axial links the rest of C11, C11 − r² C66, cross-layer links along the cell G11 − r² G12,
and lz matches A11. Cells of r² > a/b would need negative axial links: there the diagonals' stiffness is the
one that makes the axial links zero, and D66 is missed.

The method `cauchy` has 1, 1/3, 1 for all ν: the isotropic central-force lattice, ka = 2 kd on square cells,
for which it is meant; its lz makes A66 a third of A, and A11 is matched but for δ.
"""

from collections.abc import Callable

import numpy as np

from lumped import moduli
from lumped.calibration.cell_by_cell import GridCells
from lumped.calibration.central_table import ROWS
from lumped.spring_constants import Springs, by_direction
from sheetbench.errors import BadInput

STEPS = 30  # of the layer distance: δ is small and depends little on it


def coefficients(poisson: float) -> np.ndarray:
    """Return a, b, c at a Poisson's ratio; the largest errors on the training scenes that bend and that
    stretch, and the largest error of `cauchy` on scenes that bend. Linear between the table's rows, constant
    beyond them."""
    from scipy.interpolate import make_interp_spline

    at, *columns = np.array(ROWS).T
    return make_interp_spline(at, np.transpose(columns), k=1)(np.clip(poisson, at[0], at[-1]))


def central(grid_cells: GridCells) -> tuple[Springs, list[str]]:
    """Return a lattice of links alone, and a note of its errors. Raises BadInput if a link would be negative:
    many layers of cells much wider than the sheet is thick."""
    a, b, c, bent, stretched, cauchys = coefficients(grid_cells.material.poisson).tolist()
    cost = (
        f"largest errors on the training scenes: {bent:.1%} in bending, {stretched:.1%} in stretching; "
        f"of 'cauchy' {cauchys:.1%} in bending"
    )
    return _links("central", grid_cells, a, b, c, lambda got: np.sqrt(got[0, 0] * got[1, 1])), [cost]


def cauchy(grid_cells: GridCells) -> Springs:
    """Return the isotropic central-force lattice. Raises BadInput on cells that are not square, and if a link
    would be negative."""
    lx, ly = grid_cells.sides[0, 0]
    if abs(lx - ly) > 1e-9 * lx:
        raise BadInput("calibration 'cauchy' is for square cells only")
    return _links("cauchy", grid_cells, 1.0, 1.0 / 3.0, 1.0, lambda got: 3.0 * got[2, 2])


def _links(
    method: str,
    grid_cells: GridCells,
    a: float,
    b: float,
    c: float,
    stretching_of: Callable[[np.ndarray], float],
) -> Springs:
    """Return the links with D11 = a D, D12 = D66 = b D and S*; stretching_of: the stiffness, of A (3, 3),
    that is matched to c A."""
    sides, layers, target = grid_cells.sides[0, 0], grid_cells.grid[2], grid_cells.target
    rigidity, stretching = target.bending[0, 0, 0], target.membrane[0, 0, 0]
    sigma, sigma_gap = moduli.second_moment(layers), moduli.second_moment(layers - 1)
    squares, area, across = sides**2, sides.prod(), sides[::-1] / sides
    ratios = squares / squares[::-1]

    gap = target.shear[0] * squares / moduli.shear_gaps(layers)  # G11 lz², G22 lz² [N·m]
    p = min(b / a * np.sqrt(gap.prod()), *(gap / ratios))
    layer = (a * rigidity - sigma_gap * gap) / sigma  # C11 lz², C22 lz²
    twist = min((b * rigidity - sigma_gap * p) / sigma, *(layer / ratios))
    if twist <= 0.0:
        raise BadInput(f"calibration '{method}': {layers} layers need cells as small as the sheet is thick")
    lz2 = 4.0 * rigidity / stretching
    for _ in range(STEPS):
        springs = Springs.made(
            axial=by_direction(*(layer - twist * ratios) / lz2 * across),
            diagonal=twist * squares.sum() / (2.0 * area * lz2),
            vertical=8.0 * rigidity / lz2 * area / squares.min(),
            cross=by_direction(*(gap - p * ratios) / 2.0 * (squares + lz2) / (squares * lz2) * across),
            cross_diagonal=p * (squares.sum() + lz2) / (4.0 * area * lz2),
            layer_distance=np.sqrt(lz2),
        )
        got = moduli.of_cells(springs, grid_cells.sides, layers).membrane[0, 0]
        lz2 *= stretching_of(got) / (c * stretching)
    return springs
