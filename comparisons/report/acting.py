"""What acts on a sheet, on the stage of its picture: chains and moved edges in red, loads as blue arrows.

An arrow starts where its force acts and points along it; of all forces and pressures of a scene the largest
has the longest arrow. A turned arrow is an edge's moment.
"""

from __future__ import annotations

import numpy as np
import pyvista

from comparisons.report.arrows import point_arrows
from comparisons.report.stage import Stage
from sheetbench.scenes import EDGES, Chain, EdgeLoad, PointLoad, Pressure, Sheet, Solution

LOAD = "#1b6ca8"
EDGE, PRESSURE, MOMENT = 0.1, 0.08, 0.035  # lengths and radius, of the longer side
ALONG = 5  # arrows along an edge
ASIDE = 0.012  # of the longer side: how far a chain on a face is drawn from the mid-surface


def draw(stage: Stage, solution: Solution) -> np.ndarray:
    """Put actuators and loads on the stage; places (n, 3) [m] that must be seen."""
    seen = [np.empty((0, 3))]
    scene = stage.scene
    for actuator in scene.actuators:
        if isinstance(actuator, Chain):
            plan = _edge_plan(scene.sheet, actuator.edge, np.linspace(0.0, 1.0, actuator.segments + 1))
            side = np.sign(actuator.axis_height(scene.sheet.thickness))
            aside = side * ASIDE * stage.size * _normals(stage, solution, plan)
            stage.chain(stage.deformed(solution, plan) + aside)
        else:
            plan = _edge_plan(scene.sheet, actuator.edge, np.array([0.0, 1.0]))
            stage.chain(stage.deformed(solution, plan))
    points = [load for load in scene.loads if isinstance(load, PointLoad)]
    if points:
        at = stage.deformed(solution, np.array([load.at for load in points]))
        seen += _arrows(stage, at, point_arrows(np.array([load.force for load in points])))
    for load in scene.loads:
        if isinstance(load, EdgeLoad):
            plan = _edge_plan(scene.sheet, load.edge, np.linspace(0.0, 1.0, ALONG))
            at = stage.deformed(solution, plan)
            if any(load.force_per_length):
                force = np.array(load.force_per_length) / np.linalg.norm(load.force_per_length)
                seen += _arrows(stage, at, np.tile(EDGE * force, (ALONG, 1)))
            if load.moment_per_length:
                _turns(stage, at[1::2], load.edge, load.moment_per_length)
        elif isinstance(load, Pressure) and load.value:
            shares = np.linspace(0.2, 0.8, 4)
            plan = np.array([(x, y) for x in shares for y in shares]) * scene.sheet.lengths
            normals = np.sign(load.value) * _normals(stage, solution, plan)
            seen += _arrows(stage, stage.deformed(solution, plan), PRESSURE * normals)
    return np.vstack(seen)


def _arrows(stage: Stage, starts: np.ndarray, vectors: np.ndarray) -> list[np.ndarray]:
    """Arrows of vectors (n, 3), in units of the longer side; where they end."""
    ends = starts + stage.size * vectors
    for start, end in zip(starts, ends, strict=True):
        length = float(np.linalg.norm(end - start))
        if length:
            slender = 0.045 * stage.size / length
            arrow = pyvista.Arrow(
                start=start, direction=end - start, scale=length, tip_length=min(0.8 * slender, 0.5),
                tip_radius=0.25 * slender, shaft_radius=0.09 * slender,
            )  # fmt: skip
            stage.plotter.add_mesh(arrow, color=LOAD, smooth_shading=True)
    return [ends]


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


def _edge_plan(sheet: Sheet, edge: str, shares: np.ndarray) -> np.ndarray:
    """Plan points (n, 2) [m] at shares of an edge."""
    start, end = (np.array(corner) for corner in sheet.edge_ends(edge))
    points: np.ndarray = start + shares[:, None] * (end - start)
    return points


def _normals(stage: Stage, solution: Solution, plan: np.ndarray) -> np.ndarray:
    """Unit normals (n, 3) of the drawn mid-surface at plan points (n, 2), by differences."""
    step, lengths = 1e-3 * stage.size, np.array(stage.scene.sheet.lengths)
    tangents = []
    for axis in range(2):
        aside = np.zeros(2)
        aside[axis] = step
        ends = [np.clip(plan + sign * aside, 0.0, lengths) for sign in (-1.0, 1.0)]
        tangents.append(stage.deformed(solution, ends[1]) - stage.deformed(solution, ends[0]))
    normal = np.cross(*tangents)
    unit: np.ndarray = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    return unit
