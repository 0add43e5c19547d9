"""A sheet of rubber as a lattice, in closed form, for any strain and any ν below ½ (docs/theory.md).

Each of L layers is a membrane of thickness h/L with the energy of the material's law
(`sheetbench.scenes.objects.material`), of its cells' mean sides and with the thickness at which nothing pulls
(`lumped.springs.laws`). Layers are h/√(L² − 1) apart, so that Σ z_k² h/L = h³/12 and bending is D exactly.
Transverse shear is the upright faces', with S* of the grid, MacNeal's; a share d of it has the faces over the
cells' diagonals. Against a bending wave of wave number q at the angle θ to the grid the stiffness of square
cells is too small by (q l)² sin² 2θ/48 times

    7 + ν² − (21 d − 9 d²)/(1 + t) − 12 d t/(1 + t),    1 + t = 12 D/(S* l²),

and d is such that it vanishes (derived here; `lumped.calibration.closed_form` has the links' like). A cell
bent in its own plane, which mean sides do not see, is the axial links': E h/3L along each side, which the
cells' law takes off again where opposite sides are as long. Vertical links keep their length, kz = 8 D/lz²:
bending does not follow the thinning of a sheet that is stretched. One that is stretched before it bends has
the layer distance t h/√(L² − 1), t = 1/(λ₁ λ₂) the stretch of its thickness.
Edges and rims are as in `lumped.calibration.rim_twist`. Cells may differ, not in thickness: such a one has
the layers of a sheet with its G h and ν.
"""

from __future__ import annotations

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

ALIKE = 1e-9  # of D/A, that of one thickness


def hyperelastic(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
    cells: CellSection | None = None,
    method: str = "hyperelastic",
) -> Calibration:
    """Layers of the material's law, of a material without one neo-Hooke's. cells: their sections, where they
    differ: by a factor, or in Young's modulus and Poisson's ratio. method: `neo-hookean` is for a material
    without another law. Raise BadInput for such a law, for other thicknesses, and for fibres, which rubber
    does not have."""
    if method == "neo-hookean" and material.law not in (None, method):
        raise BadInput(f"calibration '{method}': the material's law is '{material.law}'; take 'hyperelastic'")
    layers, energy = grid[2], material.energy
    if material.kind == "orthotropic":
        raise BadInput(f"calibration '{method}': {FIBRES}: rubber is isotropic; choose consistent")
    _require_one_thickness(cells)

    each = each_cell(sheet, material, grid, grading, cells)
    (sides, _), target = each.present, each.target
    membrane = 0.5 * (target.membrane[:, 0, 0] + target.membrane[:, 1, 1])
    poisson = target.membrane[:, 0, 1] / membrane
    # that of a layer whose law is the material's, with the cell's G h
    thickness = 0.5 * (1.0 - poisson) * membrane / (energy.shear * layers)
    side = 2.0 * (1.0 + poisson) * energy.shear * thickness / 3.0
    square = sheet.thickness**2 / (layers**2 - 1) if layer_distance is None else layer_distance**2
    gap, squares = target.shear / moduli.shear_gaps(layers), sides**2
    share = diagonals_for_waves(target, sides.prod(axis=1), 7.0 + poisson**2)
    diagonal = share * (gap / squares).min(axis=1) * squares.sum(axis=1) / 2.0
    (lx, ly), faces = sides.T, gap.T - 2.0 * diagonal * squares.T / squares.sum(axis=1)
    springs = Springs.made(
        math.sqrt(square),
        axial=by_direction(*each.placed(np.stack([side * ly / lx, side * lx / ly]))),
        vertical=each.placed(vertical(target, sides, square)),
        neo_hookean_shear=each.placed(2.0 * energy.c10 * thickness),
        neo_hookean_volume=each.placed(energy.volume(poisson) * thickness),
        mooney_rivlin=each.placed(energy.c01 * thickness),
        yeoh_square=each.placed(energy.c20 * thickness),
        yeoh_cube=each.placed(energy.c30 * thickness),
        gent_limit=np.full(each.there.shape, energy.limit),
        face_shear=by_direction(*each.placed(faces)),
        face_diagonal_shear=each.placed(diagonal),
    )
    whole = moduli.of_cells(springs, each.sides, layers)
    springs, notes = with_twist(each, springs, whole)
    return report(method, each, springs, notes, whole)


def _require_one_thickness(cells: CellSection | None) -> None:
    """Raise BadInput where D/A differs: layers are one distance apart, and have no mid-surface to make up for
    it."""
    if cells is None:
        return
    there = cells.per_area > 0.0
    squares = cells.bending[there, 0, 0] / cells.membrane[there, 0, 0]
    if np.ptp(squares) > ALIKE * squares.max():
        raise BadInput(
            "calibration 'hyperelastic': a lattice of rubber is as thick all over, and this sheet's "
            "thickness differs; choose consistent, whose strains are small"
        )
