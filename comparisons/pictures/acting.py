"""What acts on a sheet, on the stage of its picture: chains and moved edges in red, loads as blue arrows,
payloads at points as dark balls, obstacles pale.

An arrow starts where its force acts and points along it (`comparisons.pictures.plan`). A turned arrow is an
edge's moment.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pyvista

from comparisons.pictures.plan import ALONG, edge_plan, load_arrows, on_sheet
from comparisons.pictures.stage import Stage
from sheetbench.answers.solution import Solution
from sheetbench.scenes import EDGES, Chain, EdgeLoad

LOAD = "#1b6ca8"
MOMENT = 0.035  # radius of a turned arrow, of the longer side
ASIDE = 0.012  # of the longer side: how far a chain on a face is drawn from the mid-surface


def draw(stage: Stage, solution: Solution) -> np.ndarray:
    """Put actuators, loads and payloads on the stage; places (n, 3) [m] that must be seen."""
    seen = [stage.obstacles()]
    scene = stage.scene
    for actuator in scene.actuators:
        if isinstance(actuator, Chain):
            plan = edge_plan(scene, actuator.edge, np.linspace(0.0, 1.0, actuator.segments + 1))
            side = np.sign(actuator.axis_height(scene.sheet.thickness))
            aside = side * ASIDE * stage.size * _normals(stage, solution, plan)
            stage.chain(stage.deformed(solution, plan) + aside)
        else:
            plan = edge_plan(scene, actuator.edge, np.array([0.0, 1.0]))
            stage.chain(stage.deformed(solution, plan))
    plan, arrows = load_arrows(scene, partial(_normals, stage, solution))
    if len(plan):
        seen.append(_arrows(stage, stage.deformed(solution, plan), arrows))
    bodies = np.array([payload.at for payload in scene.masses if payload.at is not None]).reshape(-1, 2)
    if len(bodies):
        stage.payloads(stage.deformed(solution, bodies))
    for load in scene.loads:
        if isinstance(load, EdgeLoad) and load.moment_per_length:
            plan = edge_plan(scene, load.edge, np.linspace(0.0, 1.0, ALONG), load.where)[1::2]
            _turns(stage, stage.deformed(solution, plan), load.edge, load.moment_per_length)
    return np.vstack(seen)


def _arrows(stage: Stage, starts: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Draw arrows of vectors (n, 3), in units of the longer side; return where they end."""
    ends: np.ndarray = starts + stage.size * vectors
    for start, end in zip(starts, ends, strict=True):
        length = float(np.linalg.norm(end - start))
        if length:
            slender = 0.045 * stage.size / length
            arrow = pyvista.Arrow(
                start=start, direction=end - start, scale=length, tip_length=min(0.8 * slender, 0.5),
                tip_radius=0.25 * slender, shaft_radius=0.09 * slender,
            )  # fmt: skip
            stage.plotter.add_mesh(arrow, color=LOAD, smooth_shading=True)
    return ends


def _turns(stage: Stage, places: np.ndarray, edge: str, moment: float) -> None:
    """Most of a circle about the edge, from outside the sheet towards +z if the moment is positive."""
    outward, up = np.array(EDGES[edge].outward), np.array([0.0, 0.0, np.sign(moment)])
    angle = np.linspace(-0.5, 4.0, 40)[:, None]
    radius = MOMENT * stage.size
    for place in places:
        arc = place + radius * (np.cos(angle) * outward + np.sin(angle) * up)
        tube = pyvista.lines_from_points(arc).tube(radius=0.1 * radius)
        tip = pyvista.Cone(
            center=arc[-1], direction=arc[-1] - arc[-3], height=0.6 * radius, radius=0.27 * radius
        )
        for part in (tube, tip):
            stage.plotter.add_mesh(part, color=LOAD, smooth_shading=True)


def _normals(stage: Stage, solution: Solution, plan: np.ndarray) -> np.ndarray:
    """Unit normals (n, 3) of the drawn mid-surface at plan points (n, 2), by differences."""
    step = 1e-3 * stage.size
    tangents = []
    for axis in range(2):
        aside = np.zeros(2)
        aside[axis] = step
        ends = [on_sheet(stage.scene, plan + sign * aside) for sign in (-1.0, 1.0)]
        tangents.append(stage.deformed(solution, ends[1]) - stage.deformed(solution, ends[0]))
    normal = np.cross(*tangents)
    unit: np.ndarray = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return unit
