"""A sheet of rubber as a lattice, in closed form, for any strain and any ν below ½ (docs/theory.md).

Each of L layers is a membrane of thickness h/L with the energy of the material's law
(`sheetbench.scenes.material`), of its cells' mean sides and with the thickness at which nothing pulls
(`lumped.springs.laws`); `neo-hookean` has neo-Hooke's whatever linear material it is given. Layers are
h/√(L² − 1) apart, so that Σ z_k² h/L = h³/12 and bending is D exactly. Transverse shear is the upright
faces', with S* of the grid, MacNeal's; a share d of it has the faces over the cells' diagonals. Against a
bending wave of wave number q at the angle θ to the grid the stiffness of square cells is too small by (q l)²
sin² 2θ/48 times

    7 + ν² − (21 d − 9 d²)/(1 + t) − 12 d t/(1 + t),    1 + t = 12 D/(S* l²),

and d is such that it vanishes (derived here; `lumped.calibration.closed_form` has the links' like). A cell
bent in its own plane, which mean sides do not see, is the axial links': E h/3L along each side, which the
cells' law takes off again where opposite sides are as long. Vertical links keep their length, kz = 8 D/lz²:
bending does not follow the thinning of a sheet that is stretched. One that is stretched before it bends has
the layer distance t h/√(L² − 1), t = 1/(λ₁ λ₂) the stretch of its thickness.
Edges are as in `lumped.calibration.edge_twist`. Cells may differ.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from lumped import moduli
from lumped.calibration.calibration import Calibration, by_direction, plan_spacing
from lumped.calibration.cell_by_cell import Sides, cell_by_cell
from lumped.calibration.closed_form import diagonals_for_waves, vertical
from lumped.calibration.edge_twist import with_edges
from lumped.calibration.report import report
from lumped.lattice import Grid
from lumped.sections import Section
from sheetbench.errors import BadInput
from sheetbench.scenes import Constants, Material, Sheet, SpringSet
from sheetbench.scenes.grading import Graded


def neo_hookean(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
) -> Calibration:
    """Neo-Hookean layers with the moduli of the sheet at small strains. Raises BadInput for a material of
    another law."""
    if material.law not in (None, "neo-hookean"):
        raise BadInput(
            f"calibration 'neo-hookean': the material's law is '{material.law}'; take 'hyperelastic'"
        )
    return _rubber("neo-hookean", sheet, material, grid, layer_distance, grading)


def hyperelastic(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    grading: Graded = 0.0,
) -> Calibration:
    """Layers of the material's law, of a material without one neo-Hooke's."""
    return _rubber("hyperelastic", sheet, material, grid, layer_distance, grading)


def _rubber(
    method: str,
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None,
    grading: Graded,
) -> Calibration:
    layers, energy = grid[2], material.energy
    thickness = sheet.thickness / layers

    def of_cell(sides: Sides, section: Section, distance: float | None = layer_distance) -> SpringSet:
        lx, ly = sides
        asked = moduli.of_section(section, sides)
        side = material.young * thickness / 3.0
        square = sheet.thickness**2 / (layers**2 - 1) if distance is None else distance**2
        gap, squares = asked.shear / moduli.shear_gaps(layers), np.array([lx * lx, ly * ly])
        share = diagonals_for_waves(asked, lx * ly, 7.0 + material.poisson**2)
        diagonal = share * float((gap / squares).min() * squares.sum() / 2.0)
        return SpringSet(
            axial=by_direction(side * ly / lx, side * lx / ly),
            diagonal=0.0,
            vertical=vertical(asked, sides, square),
            cross=0.0,
            cross_diagonal=0.0,
            neo_hookean_shear=2.0 * energy.c10 * thickness,
            neo_hookean_volume=energy.volume(material.poisson) * thickness,
            mooney_rivlin=energy.c01 * thickness,
            yeoh_square=energy.c20 * thickness,
            yeoh_cube=energy.c30 * thickness,
            gent_limit=energy.limit,
            face_shear=by_direction(*(gap - 2.0 * diagonal * squares / squares.sum())),
            face_diagonal_shear=diagonal,
            layer_distance=math.sqrt(square),
        )

    if grading:
        springs = cell_by_cell(of_cell, sheet, material, grid, grading, None, layer_distance)
    else:
        springs = of_cell(plan_spacing(sheet, grid), Section.of(Constants.of(sheet, material)))
    springs, notes = with_edges(sheet, grid, springs, grading)
    found = report(method, sheet, material, grid, springs, grading)
    return replace(found, remarks=(*found.remarks, *notes))
