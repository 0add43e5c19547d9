"""A lattice with a parameter of its scene a little below and above its value, for central differences.

Springs, supports and loads are made again where they follow from the parameter; the rest is shared with the
given lattice. The residual is linear in every spring constant, and its difference is exact but for rounding;
in the thickness, ν, a layer distance, a curvature or a tilt its relative error is of order 1e-8. A load at a
line of the grid, where its shares have a kink, has the mean of both sides.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

from lumped.calibration import MAKERS, Calibration
from lumped.pretension import calibrated_at_rest
from lumped.sections import sections_of
from lumped.statics.build import build_problem
from lumped.statics.problem import Problem
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene
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

Calibrate = Callable[[Scene], Calibration]
Sides = tuple[list[tuple[Problem, Calibration]], float]  # below and above, and the distance between both


def both_sides(
    calibration: Calibration,
    problem: Problem,
    name: str,
    calibrate: Calibrate | None = None,
    share: float = 0.0,
) -> Sides:
    """Return the problem and springs a little below and above a parameter, and the distance between both;
    share: of its value, for steps by that share."""
    scene, name = problem.scene, short_name(name)
    if of_springs := name in (*calibration.constants.names(), "layer_distance"):
        value, low, high = calibration.constants.value(name), -np.inf, np.inf
    else:
        entry = parameter(scene, name)
        value, low, high = entry.value, entry.low, entry.high
    key = name.partition(".")[2] if name.startswith(PATCH) else name
    if scene.obstacles and key == "thickness":  # which moves the surface that presses in
        key = OBSTACLE
    step = next((h for kind, h in STEP_OF.items() if key.startswith(kind)), STEP * abs(value))
    step = share * abs(value) or step
    if step == 0.0:
        raise BadInput(f"parameter {name!r} is zero: differences need a scale")
    sides, ends = [], np.clip([value - step, value + step], low, high).tolist()
    for end in ends:
        if of_springs:
            side, springs = scene, calibration.with_constant(name, end)
        else:
            side, springs = of_changed(scene, calibration, name, end, calibrate, name.startswith(EDGES))
        sides.append((build_problem(side, springs, previous=problem), springs))
    return sides, ends[1] - ends[0]


def of_changed(
    scene: Scene,
    calibration: Calibration,
    name: str,
    value: float,
    calibrate: Calibrate | None,
    checked: bool = True,
) -> tuple[Scene, Calibration]:
    """Return the scene with another value (`put`), and its springs, calibrated again if they depend
    on it."""
    begins_on = name.startswith(OBSTACLE)  # of a sheet that begins on one, within it by so little
    changed = put(scene, name, value, checked and not begins_on)
    grid, grading, material = calibration.grid, calibration.grading, changed.material
    if not name.startswith(CALIBRATED_FROM):
        if name != "density" or calibration.cells is None:
            return changed, calibration
        return changed, replace(calibration, cells=sections_of(changed, grid, grading))
    if calibrate is not None:
        return changed, calibrate(changed)
    if calibration.method not in MAKERS:
        raise BadInput(
            f"springs of calibration '{calibration.method}' do not follow from the sheet and its material"
        )
    own: dict[str, Any] = {"grading": grading} if grading else {}
    if (cells := sections_of(changed, grid, grading)) is not None:
        own["cells"] = cells
    make = MAKERS[calibration.method]
    return changed, calibrated_at_rest(changed, lambda sheet: make(sheet, material, grid, **own))
