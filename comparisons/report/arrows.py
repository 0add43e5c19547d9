"""The arrows of a scene's loads, in pictures and in views.

Of all point loads the largest has the longest arrow. Arrows of an edge load stand along its edge, of a
pressure all over the sheet, along its normal.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from sheetbench.scenes import EdgeLoad, PointLoad, Pressure, Scene, Sheet

POINT, EDGE, PRESSURE = 0.16, 0.1, 0.08  # lengths, of the sheet's longer side; of points the largest
SHORTEST = 0.4  # of any other point's, of the largest
ALONG = 5  # arrows along an edge
ACROSS = np.linspace(0.2, 0.8, 4)  # shares of both sides where a pressure's arrows stand


def load_arrows(scene: Scene, normals: Callable[[np.ndarray], np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return plan points (n, 2) [m] where arrows start, and the arrows (n, 3) in units of the sheet's longer
    side; normals: unit normals (n, 3) of the deformed sheet at plan points."""
    points = [load for load in scene.loads if isinstance(load, PointLoad)]
    plan = [np.array([load.at for load in points]).reshape(-1, 2)]
    arrows = [point_arrows(np.array([load.force for load in points]).reshape(-1, 3))]
    for load in scene.loads:
        if isinstance(load, EdgeLoad) and any(load.force_per_length):
            plan.append(edge_plan(scene.sheet, load.edge, np.linspace(0.0, 1.0, ALONG)))
            force = np.array(load.force_per_length) / np.linalg.norm(load.force_per_length)
            arrows.append(np.tile(EDGE * force, (ALONG, 1)))
        elif isinstance(load, Pressure) and load.value:
            plan.append(np.array([(x, y) for x in ACROSS for y in ACROSS]) * scene.sheet.lengths)
            arrows.append(PRESSURE * np.sign(load.value) * normals(plan[-1]))
    return np.vstack(plan), np.vstack(arrows)


def edge_plan(sheet: Sheet, edge: str, shares: np.ndarray) -> np.ndarray:
    """Plan points (n, 2) [m] at shares of an edge."""
    start, end = (np.array(corner) for corner in sheet.edge_ends(edge))
    points: np.ndarray = start + shares[:, None] * (end - start)
    return points


def point_arrows(forces: np.ndarray) -> np.ndarray:
    """Arrows (n, 3) of forces (n, 3), in units of the sheet's longer side: in proportion to the forces, but
    long enough to be seen."""
    sizes = np.linalg.norm(forces, axis=1, keepdims=True)
    largest = float(sizes.max(initial=0.0))
    if not largest:
        return np.zeros_like(forces)
    lengths = POINT * np.maximum(sizes / largest, SHORTEST)
    arrows: np.ndarray = lengths * forces / np.where(sizes > 0.0, sizes, 1.0)
    return arrows
