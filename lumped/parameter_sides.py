"""A scene and its springs with a parameter a little below and above its value, for central differences.

Springs are calibrated again where they follow from the parameter. The residual is linear in every spring
constant, and its difference is exact but for rounding; in the thickness, ν, a layer distance, a curvature or
a tilt its relative error is of order 1e-8. A load at a line of the grid, where its shares have a kink, has
the mean of both sides.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np

from lumped.calibration import MAKERS, Calibration
from lumped.calibration.cell_by_cell import with_shares
from lumped.calibration.closed_form import NoClosedForm
from lumped.calibration.consistent import springs_of_sheets
from lumped.pretension import calibrated_at_rest
from lumped.sections import sections_of
from sheetbench.choices import CALIBRATIONS
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, Sheet
from sheetbench.scenes.meaning.natural_state import sheet_at_rest
from sheetbench.scenes.meaning.parameters import FIBRES, OF_LAWS, parameter, put, short_name

STEP = 1e-5  # of a parameter, for the difference of residuals
# beginnings of names of parameters that springs follow from
CALIBRATED_FROM: tuple[str, ...] = ("young", "poisson", "thickness", *FIBRES, *OF_LAWS, "patch", "layer")
CALIBRATED_FROM += ("temperature", "natural.e", "natural.p")
# steps of parameters that may be zero, by beginnings of names: 1/m, rad, m, N, K; contacts press in by 1e-8 m
STEP_OF = {"curvature": 1e-4, "tilt_": 1e-5, "angle": 1e-5, "natural.k": 1e-3, "natural.e": 1e-6}
STEP_OF |= {"obstacle": 1e-10, "load": 1e-6, "gravity": 1e-4, "support": 1e-8, "actuator": 1e-8}
STEP_OF |= {"temperature": 1e-3, "poisson": 4e-6}
PATCH, OBSTACLE, EDGES = "patch", "obstacle", ("tilt", "curvature")  # beginnings of names

Changed = tuple[Scene, Calibration]
Sides = tuple[list[Changed], float]  # below and above a parameter, and the distance between both


def both_sides(
    scene: Scene,
    calibration: Calibration,
    names: Sequence[str],
    share: float = 0.0,
) -> list[Sides]:
    """Return scene and springs at values a little below and above each parameter, all of one kind, and the
    distance between both values; share: of its value, for steps by that share."""
    known, changes = calibration.constants, list[tuple[str, float]]()
    of_springs = names[0] in (*known.names(), "layer_distance")
    for name in map(short_name, names):
        value, low, high = (known.value(name), -np.inf, np.inf) if of_springs else parameter(scene, name)[2:]
        key = name.partition(".")[2] if name.startswith(PATCH) else name
        if scene.obstacles and key == "thickness":  # which moves the surface that presses in
            key = OBSTACLE
        usual = next((step for kind, step in STEP_OF.items() if key.startswith(kind)), STEP * abs(value))
        if (step := share * abs(value) or usual) == 0.0:
            raise BadInput(f"parameter {name!r} is zero: differences need a scale")
        changes += [(name, end) for end in np.clip([value - step, value + step], low, high).tolist()]
    if of_springs:
        sides = [(scene, calibration.with_constant(*change)) for change in changes]
    else:
        sides = of_changed(scene, calibration, changes, names[0].startswith(EDGES))
    return [(sides[n : n + 2], changes[n + 1][1] - changes[n][1]) for n in range(0, len(sides), 2)]


def of_changed(
    scene: Scene,
    calibration: Calibration,
    changes: Sequence[tuple[str, float]],
    checked: bool = True,
) -> list[Changed]:
    """Return scene and springs for each changed value, recalibrated if they depend on it; checked: whether
    the first changed scene is validated, as by `put`."""
    name, _ = changes[0]
    checked &= not name.startswith(OBSTACLE)  # of a sheet that begins on one, within it by so little
    scenes = [put(scene, *change, checked and change is changes[0]) for change in changes]
    springs = [calibration] * len(scenes)
    if name.startswith(CALIBRATED_FROM):
        springs = _calibrated(calibration, scenes)
    elif name == "density" and calibration.cells is not None:
        grid, grading = calibration.grid, calibration.grading
        springs = [replace(calibration, cells=sections_of(one, grid, grading)) for one in scenes]
    return [*zip(scenes, springs, strict=True)]


def same_method(calibration: Calibration, scene: Scene) -> Callable[[Sheet], Calibration]:
    """Return the function that calibrates a sheet with the scene's material and parts by a calibration's
    method and options, on its grid. Raises BadInput for fitted springs and a scene's table."""
    method, grid, grading = calibration.method, calibration.grid, calibration.grading
    if method not in MAKERS:
        raise BadInput(f"springs of calibration '{method}' do not follow from the sheet and its material")
    given = {"grading": grading or None, "cells": sections_of(scene, grid, grading)}
    own: dict[str, Any] = {key: value for key, value in given.items() if value is not None}
    own |= dict(calibration.options)
    shared = None if "cells" in CALIBRATIONS[method].takes else own.pop("cells", None)

    def calibrate(sheet: Sheet) -> Calibration:
        found = replace(MAKERS[method](sheet, scene.material, grid, **own), options=calibration.options)
        return found if shared is None else with_shares(found, sheet, scene.material, shared)

    return calibrate


def _calibrated(calibration: Calibration, scenes: Sequence[Scene]) -> list[Calibration]:
    """Return the springs of scenes by a calibration's method; of isotropic sheets without parts in one
    pass."""
    method, grid = calibration.method, calibration.grid
    with_parts = calibration.cells is not None or scenes[0].natural or scenes[0].patches  # which may grow
    if method.startswith("consistent") and not (with_parts or calibration.grading or calibration.options):
        with suppress(NoClosedForm):
            sheets = [(sheet_at_rest(one), one.material) for one in scenes]
            found = springs_of_sheets(sheets, grid, method)
            return [replace(calibration, springs=one.table()) for one in found]
    return [calibrated_at_rest(one, same_method(calibration, one)) for one in scenes]
