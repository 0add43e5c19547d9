"""One stiffness k for all five families, as Habibi et al. have it; no area springs.

Its bending stiffness is D11 = k Σ z_k² (lx/ly + …): on square cells and two layers k lz². Where k is not
given it is matched to the sheet's D11 = E h³/12(1 − ν²). Poisson's ratio and the twisting stiffness are
then what the uniform lattice has (½ and D66/D11 = ½), not the sheet's.
"""

from __future__ import annotations

from lumped import moduli
from lumped.calibration.calibration import Calibration, plan_spacing
from lumped.calibration.report import report
from lumped.lattice import Grid
from sheetbench.scenes import Material, Sheet, SpringSet


def uniform(
    sheet: Sheet, material: Material, grid: Grid, k: float | None = None, layer_distance: float | None = None
) -> Calibration:
    """k [N/m] as given or from D11; layer_distance [m] as given or the sheet's thickness over the gaps."""
    distance = layer_distance if layer_distance is not None else sheet.thickness / (grid[2] - 1)
    lx, ly = plan_spacing(sheet, grid)
    if k is None:
        unit = moduli.of_springs(_all(1.0, distance), (lx, ly, distance), grid[2])
        k = float(moduli.of_sheet(sheet, material, (lx, ly)).bending[0, 0] / unit.bending[0, 0])
    return report("uniform", sheet, material, grid, _all(k, distance))


def _all(k: float, layer_distance: float) -> SpringSet:
    return SpringSet(
        axial=k, diagonal=k, vertical=k, cross=k, cross_diagonal=k, layer_distance=layer_distance
    )
