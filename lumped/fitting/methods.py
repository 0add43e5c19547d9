"""All calibration methods by name, including fits to data, and the function `calibrate` that calls them."""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from typing import Any

from lumped.calibration.calibration import Calibration
from lumped.calibration.methods import MAKERS as CLOSED
from lumped.fitting.fits import ModalTarget, StaticTarget, Target, fitted
from lumped.sections import CellSection
from sheetbench.choices import CALIBRATION, CALIBRATIONS
from sheetbench.errors import BadInput, require_choice
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import Cells, Material, Sheet
from sheetbench.scenes.objects.grading import Graded
from sheetbench.scenes.objects.grid import DEFAULT_MASSES, grid_of
from sheetbench.scenes.objects.quantities import require_positive

MAKERS = CLOSED | {
    "fit-static": partial(fitted, "fit-static", StaticTarget),
    "fit-modal": partial(fitted, "fit-modal", ModalTarget),
}
UNITS = {"k": "N/m", "layer_distance": "m"}


def calibrate(
    sheet: Sheet,
    material: Material,
    grid: int | Sequence[int] = DEFAULT_MASSES,
    method: str = CALIBRATION,
    k: float | None = None,
    layer_distance: float | None = None,
    targets: Sequence[Target] = (),
    grading: Graded = 0.0,
    cells: Cells | CellSection | None = None,
) -> Calibration:
    """Return springs of a grid for a sheet and its material, by a named method.

    Parameters
    ----------
    sheet : Sheet
        Length, width and thickness.
    material : Material
        Young's modulus, Poisson's ratio and density, or fibres, or a law of rubber.
    grid : int or sequence of int, default 9
        Masses along the shorter side, (nx, ny) or (nx, ny, layers).
    method : str, default "consistent"
        Name of a method, a key of `CALIBRATIONS`.
    k : float, optional
        Spring constant [N/m], for methods that take it.
    layer_distance : float, optional
        Distance of neighbouring layers [m], for methods that take it.
    targets : sequence of StaticTarget or ModalTarget, optional
        Data that the springs of "fit-static" and "fit-modal" are fitted to.
    grading : float or Grading, default 0
        Grading of the grid's lines, 0 (equal cells) to 1 (`lumped.grid_lines`).
    cells : Cells or CellSection, optional
        Constants or sections of unequal cells (`sections_of`).

    Returns
    -------
    Calibration
        Spring constants [N/m], layer distance [m], and a report of the moduli that they meet.

    Raises
    ------
    BadInput
        If the method is unknown or has no springs for the grid, the grid is too small, or an option is out of
        its bounds or not one of the method's.

    Notes
    -----
    The methods and their sources are in `docs/calibration.md` and `docs/theory.md`.

    Examples
    --------
    >>> import lumped
    >>> from sheetbench.scenes import load
    >>> scene = load("two-edges-clamped")
    >>> springs = lumped.calibrate(scene.sheet, scene.material, grid=9)
    >>> springs.method, springs.grid, round(springs.layer_distance, 6)
    ('consistent', (9, 9, 2), 0.003706)
    """
    require_choice("calibration", method, CALIBRATIONS)
    requested: dict[str, Any] = {"k": k, "layer_distance": layer_distance, "targets": tuple(targets) or None}
    requested |= {"grading": grading or None, "cells": cells}
    options = {name: value for name, value in requested.items() if value is not None}
    for name, value in options.items():
        if name not in CALIBRATIONS[method].takes:
            with_option = [f"'{other}'" for other, entry in CALIBRATIONS.items() if name in entry.takes]
            others = " and ".join(with_option)
            unit = f" {UNITS[name]}" if name in UNITS else ""
            prefix = "" if name in ("targets", "cells") else f"{name} = {value:g}{unit}: "
            raise BadInput(f"{prefix}calibration '{method}' takes no {name}; {name} goes with {others}")
        if name in UNITS:
            require_positive(name, value, UNITS[name])
    with one_blas_thread():
        found = MAKERS[method](sheet, material, grid_of(sheet, grid), **options)
    given = tuple((name, options[name]) for name in UNITS if name in options)
    return replace(found, options=given) if given else found
