"""All calibration methods by name, the fitted ones too, and the one door to them."""

from __future__ import annotations

from collections.abc import Sequence
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
from sheetbench.scenes.objects.grid import MASSES, grid_of
from sheetbench.scenes.objects.quantities import require_positive

MAKERS = CLOSED | {
    "fit-static": partial(fitted, "fit-static", StaticTarget),
    "fit-modal": partial(fitted, "fit-modal", ModalTarget),
}
UNITS = {"k": "N/m", "layer_distance": "m"}


def calibrate(
    sheet: Sheet,
    material: Material,
    grid: int | Sequence[int] = MASSES,
    method: str = CALIBRATION,
    k: float | None = None,
    layer_distance: float | None = None,
    targets: Sequence[Target] = (),
    grading: Graded = 0.0,
    cells: Cells | CellSection | None = None,
) -> Calibration:
    """Springs of a grid for a sheet of this material, by a named method.

    grid: masses along the shorter side, (nx, ny) or (nx, ny, layers), see `sheetbench.scenes.objects.grid`.
    k [N/m] and layer_distance [m] are for the methods that take them; the fitted methods need targets.
    grading: how much smaller the cells are at the edges, 0 to 1 (`lumped.grid_lines`). cells: what each is
    made of, where they differ. Raises BadInput for an
    unknown method, a grid too small, an option that the method does not take or that is out of its bounds.

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
            others = " and ".join(f"'{other}'" for other, one in CALIBRATIONS.items() if name in one.takes)
            unit = f" {UNITS[name]}" if name in UNITS else ""
            given = "" if name in ("targets", "cells") else f"{name} = {value:g}{unit}: "
            raise BadInput(f"{given}calibration '{method}' takes no {name}; {name} goes with {others}")
        if name in UNITS:
            require_positive(name, value, UNITS[name])
    with one_blas_thread():
        return MAKERS[method](sheet, material, grid_of(sheet, grid), **options)
