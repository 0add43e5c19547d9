"""A sheet of rubber as a lattice, in closed form, for any strain and any ν below ½ (docs/theory.md).

Each of L layers is a membrane of thickness h/L with the energy of the material's law
(`sheetbench.scenes.objects.material`), of its cells' mean sides and with the thickness at which the normal
stress vanishes (`lumped.springs.laws`). The layer distance is h/√(L² − 1), so that Σ z_k² h/L = h³/12 and
bending is D exactly. Upright faces carry the transverse shear, with MacNeal's S* of the grid; the faces over
the cells' diagonals have a share d of it. For a bending wave of wave number q at the angle θ to the grid the
stiffness of square cells is too small by (q l)² sin² 2θ/48 times

    7 + ν² − (21 d − 9 d²)/(1 + t) − 12 d t/(1 + t),    1 + t = 12 D/(S* l²),

and d makes the factor vanish (derived for this project; `lumped.calibration.closed_form` has the formula of
links). Bending of a cell in its plane does not change its mean sides: axial links resist it, E h/3L along
each side, which the cells' law subtracts for equal opposite sides. Vertical links keep their length, kz = 8
D/lz²: bending does not follow the thinning of a stretched sheet. A sheet that is stretched before it bends
has the layer distance t h/√(L² − 1), t = 1/(λ₁ λ₂) the stretch of its thickness. Edges and rims are as in
`lumped.calibration.rim_twist`. Cells may differ, not in thickness: a cell has the layers of a sheet with its
G h and ν.
"""

import math

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.closed_form import diagonals_for_waves, vertical
from lumped.calibration.report import report
from lumped.calibration.rim_twist import with_twist
from lumped.lattice import Grid
from lumped.sections import CellSection
from lumped.spring_constants import Springs, by_direction
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Sheet
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.orthotropy import FIBRES

EQUAL = 1e-9  # relative difference up to which two values of D/A are equal


def hyperelastic(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    cells: CellSection | None = None,
    method: str = "hyperelastic",
) -> Calibration:
    """Return layers with the material's law, neo-Hooke's for a material without a law. cells: sections that
    differ by a factor, or in Young's modulus and Poisson's ratio. method: `neo-hookean` is for a material
    without another law. Raises BadInput for another law, for cells of several thicknesses, and for fibres,
    which rubber does not have."""
    if method == "neo-hookean" and material.law not in (None, method):
        raise BadInput(f"calibration '{method}': the material's law is '{material.law}'; take 'hyperelastic'")
    layers, energy = grid[2], material.energy
    if material.kind == "orthotropic":
        raise BadInput(f"calibration '{method}': {FIBRES}: rubber is isotropic; choose consistent")
    _require_one_thickness(cells)

    grid_cells = each_cell(sheet, material, grid, grading, cells)
    (sides, _), target = grid_cells.present, grid_cells.target
    membrane = 0.5 * (target.membrane[:, 0, 0] + target.membrane[:, 1, 1])
    poisson = target.membrane[:, 0, 1] / membrane
    # thickness of a layer of the material's law with the cell's G h
    thickness = 0.5 * (1.0 - poisson) * membrane / (energy.shear * layers)
    side = 2.0 * (1.0 + poisson) * energy.shear * thickness / 3.0
    square = sheet.thickness**2 / (layers**2 - 1) if layer_distance is None else layer_distance**2
    gap, squares = target.shear / moduli.shear_gaps(layers), sides**2
    share = diagonals_for_waves(target, sides.prod(axis=1), 7.0 + poisson**2)
    diagonal = share * (gap / squares).min(axis=1) * squares.sum(axis=1) / 2.0
    (lx, ly), faces = sides.T, gap.T - 2.0 * diagonal * squares.T / squares.sum(axis=1)
    springs = Springs.made(
        math.sqrt(square),
        axial=by_direction(*grid_cells.on_grid(np.stack([side * ly / lx, side * lx / ly]))),
        vertical=grid_cells.on_grid(vertical(target, sides, square)),
        neo_hookean_shear=grid_cells.on_grid(2.0 * energy.c10 * thickness),
        neo_hookean_volume=grid_cells.on_grid(energy.volume(poisson) * thickness),
        mooney_rivlin=grid_cells.on_grid(energy.c01 * thickness),
        yeoh_square=grid_cells.on_grid(energy.c20 * thickness),
        yeoh_cube=grid_cells.on_grid(energy.c30 * thickness),
        gent_limit=np.full(grid_cells.covered.shape, energy.limit),
        face_shear=by_direction(*grid_cells.on_grid(faces)),
        face_diagonal_shear=grid_cells.on_grid(diagonal),
    )
    cell_moduli = moduli.of_cells(springs, grid_cells.sides, layers)
    springs, notes = with_twist(grid_cells, springs, cell_moduli)
    return report(method, grid_cells, springs, notes, cell_moduli)


def _require_one_thickness(cells: CellSection | None) -> None:
    """Raise BadInput for cells of different D/A: layers have one distance, and no mid-surface adds the rest
    of A."""
    if cells is None:
        return
    covered = cells.per_area > 0.0
    squares = cells.bending[covered, 0, 0] / cells.membrane[covered, 0, 0]
    if np.ptp(squares) > EQUAL * squares.max():
        raise BadInput(
            "calibration 'hyperelastic': needs one thickness all over; choose consistent, for small strains"
        )
