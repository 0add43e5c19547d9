"""Springs that meet the moduli as nearly as they can: bounded least squares on A, D and S.

The method for a layer distance that is given, for more layers than the closed form permits with nonnegative
links, and a check of the closed form where both apply. Links and strain springs are kept nonnegative; area
springs may have either sign; strain springs are used only if the others miss a modulus, and then as weak as
possible. Residuals are relative to the sheet's moduli (off-diagonal terms to D11 and A11); bending and shear
weigh more than stretching, since a soft sheet bends first.
"""

from typing import Any

import numpy as np

from lumped import moduli
from lumped.calibration.cell_by_cell import GridCells
from lumped.spring_constants import Springs, by_direction

STRETCHING = 0.3  # weight of A; D and S have the weight 1
PAIRS = ("axial", "cross", "mid_stretch")
STRAINS = ("mid_stretch_x", "mid_stretch_y", "shear", "mid_shear")
FREE = ("area", "mid_area")
MATCHED = 1e-6  # weighted miss that counts as none
PLACES = [0, 0, 1, 2], [0, 1, 1, 2]  # entries of a form whose misses count
SCALES = [0, 0, 0, 2], [0, 0, 0, 2]  # entries that the misses are divided by
WEAK = 1e-4  # weight of the strain springs themselves, where they are needed
UNKNOWNS = tuple(f"{name}_{direction}" for name in PAIRS for direction in "xy")
UNKNOWNS += ("diagonal", "cross_diagonal", "shear", "mid_shear", *FREE)


def fit_moduli(grid_cells: GridCells, layer_distance: float | None = None) -> Springs:
    """Return the springs with the least weighted error of their moduli.

    Unknowns: the five link families, axial and cross each along x and y, the strain springs, all ≥ 0;
    area, mid_area of any sign; the layer distance unless given. kz as in the closed form.
    """
    from scipy.optimize import least_squares

    layers, target = grid_cells.grid[2], grid_cells.target
    first_distance = layer_distance or grid_cells.sheet.thickness / (layers - 1)

    def springs_of(unknowns: np.ndarray) -> Springs:
        distance = layer_distance or first_distance * float(np.exp(unknowns[-1]))
        stiffness = target.bending[0, 0, 0] / (moduli.second_moment(layers) * distance**2)
        values: dict[str, Any] = dict(zip(UNKNOWNS, stiffness * unknowns, strict=False))
        for name in PAIRS:
            values[name] = by_direction(values.pop(f"{name}_x"), values.pop(f"{name}_y"), 1e-6)
        return Springs.made(**values, vertical=4.0 * stiffness, layer_distance=distance)

    def misses(unknowns: np.ndarray) -> np.ndarray:
        got = moduli.of_cells(springs_of(unknowns), grid_cells.sides, layers)
        rows = [(got.shear[0, 0] - target.shear[0]) / target.shear[0]]
        for form, goal, weight in (
            (got.bending[0, 0], target.bending[0], 1.0),
            (got.membrane[0, 0], target.membrane[0], STRETCHING),
        ):
            rows.append(weight * (form - goal)[PLACES] / goal[SCALES])
        return np.concatenate(rows)

    strains = [UNKNOWNS.index(name) for name in STRAINS]
    numbers = np.arange(len(UNKNOWNS) + (0 if layer_distance else 1))
    kinds = [numbers < len(UNKNOWNS) - len(FREE), numbers < len(UNKNOWNS)]
    start, low = np.select(kinds, [0.3, 0.1]), np.select(kinds, [0.0, -np.inf], -2.0)
    high = np.select(kinds, [np.inf, np.inf], 2.0)

    def fitted(active: np.ndarray) -> np.ndarray:
        """Fit the active unknowns by least squares, and return all unknowns; the others are 0."""

        def of(values: np.ndarray) -> np.ndarray:
            unknowns = np.zeros_like(start)
            unknowns[active] = values
            return unknowns

        fit = least_squares(
            lambda values: np.append(misses(of(values)), WEAK * of(values)[strains]),
            start[active],
            jac="3-point",
            bounds=(low[active], high[active]),
            x_scale="jac",
            xtol=1e-15,
            ftol=1e-15,
            gtol=1e-15,
            max_nfev=3000,
        )
        return of(fit.x)

    unknowns = fitted(np.setdiff1d(numbers, strains))
    if np.abs(misses(unknowns)).max() > MATCHED:
        unknowns = fitted(numbers)
    return springs_of(unknowns)
