"""Drawn sheets over drawn obstacles, solved on the lattice, and what the geometry says of the answer.

A solver that reports no equilibrium is not judged.
"""

from __future__ import annotations

import warnings

import numpy as np
from cases import sheet

import lumped
from sheetbench.answers.solution import Solution, Status
from sheetbench.errors import BadInput
from sheetbench.scenes import Clamped, Cylinder, Hinged, Motion, Plane, PointLoad, Scene, SceneError, Sphere

INSIDE = 8  # points a side of a cell, that the sheet is looked at in


def draw(number: int) -> tuple[Scene, tuple[int, int, int]]:
    """Return a scene and a grid. Raises SceneError for one that makes no sense."""
    rng = np.random.default_rng(number)
    lengths = rng.uniform(0.08, 0.3, 2)
    short, long = lengths.min(), lengths.max()
    held = [("x0",), ("x0", "x1"), ("x0", "x1", "y0", "y1"), ("x0", "y0")][rng.integers(4)]
    kind = Clamped if rng.random() < 0.7 or len(held) == 1 else Hinged
    depth = rng.uniform(0.0, 0.1) * long
    at = [*(rng.uniform(0.2, 0.9, 2) * lengths), 0.0]
    thickness = 10 ** rng.uniform(-2.7, -1.7) * short
    cells = int(rng.integers(4, 13))  # along the shorter side
    radius = max(10 ** rng.uniform(-0.6, 1.0) * short / cells, 0.07 * short / cells)
    below = [at[0], at[1], -depth - radius - thickness / 2]
    turn, lean = rng.uniform(0.0, np.pi), rng.uniform(-0.3, 0.3, 2)
    round_one = {"position": tuple(below), "radius": radius}
    obstacle = [
        Plane(position=(0.0, 0.0, -depth - 0.3 * long), normal=(*lean, 1.0)),
        Sphere(**round_one),
        Cylinder(axis=(np.cos(turn), np.sin(turn), 0.0), **round_one),
        Cylinder(axis=(0.0, 1.0, 0.0), **round_one),
    ][rng.choice(4, p=(0.1, 0.4, 0.25, 0.25))]
    up = float(depth + rng.uniform(0.0, 0.1) * long)  # into the sheet as it is flat
    rise = Motion(time=(0.0, 1.0), displacement=((0.0, 0.0, 0.0), (0.0, 0.0, up)))
    push = PointLoad(
        at=tuple(rng.uniform(0.3, 1.0, 2) * lengths), force=(0.0, 0.0, -float(10 ** rng.uniform(-3, -0.5)))
    )
    heavy = 10 ** rng.uniform(0.0, 2.7)  # ρ g h L³/B, that a strip hangs straight down of from 50 on
    young = 12.0 * 1100.0 * 9.81 * long**3 / (heavy * thickness**2)
    scene = sheet(
        *(*lengths, thickness, young, rng.uniform(0.0, 0.48), 1100.0),
        weight=9.81,
        supports=tuple(kind(edge=edge) for edge in held),
        loads=(push,) if rng.random() < 0.3 else (),
        obstacles=(obstacle.replace(motion=rise) if rng.random() < 0.4 else obstacle,),
    )
    grid = tuple(max(3, round(cells * length / short) + 1) for length in lengths)
    return scene, (min(grid[0], 33), min(grid[1], 33), 2)


def surface(solution: Solution, grid: tuple[int, int, int], scene: Scene) -> np.ndarray:
    """Return places (m, n, 3) of points INSIDE a cell on the deformed mid-surface, straight between
    masses."""
    axes = [np.linspace(0.0, length, n) for length, n in zip(scene.sheet.lengths, grid, strict=False)]
    x, y = np.meshgrid(*axes, indexing="ij")
    plan = np.column_stack([x.ravel(), y.ravel()])
    masses = np.column_stack([plan, np.zeros(len(plan))]) + solution.displacement(plan)
    within = [np.linspace(0.0, n - 1.0, INSIDE * (n - 1) + 1) for n in grid[:2]]
    along_x, along_y = (
        np.maximum(0.0, 1.0 - np.abs(at[:, None] - np.arange(n))) for at, n in zip(within, grid, strict=False)
    )
    return np.einsum("ai,bj,ijk->abk", along_x, along_y, masses.reshape(*x.shape, 3))


def crossings(places: np.ndarray, start: np.ndarray, way: float) -> int:
    """Return how often a ray from `start` (3,) up or down, way = ±1, crosses the sheet."""
    a, b, c, d = places[:-1, :-1], places[1:, :-1], places[1:, 1:], places[:-1, 1:]
    found = 0
    for corners in (np.stack([a, b, c]), np.stack([a, c, d])):
        first, u, v = corners[0], corners[1] - corners[0], corners[2] - corners[0]
        area = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
        to = start - first
        with np.errstate(divide="ignore", invalid="ignore"):
            s = (to[..., 0] * v[..., 1] - to[..., 1] * v[..., 0]) / area
            t = (u[..., 0] * to[..., 1] - u[..., 1] * to[..., 0]) / area
        height = first[..., 2] + s * u[..., 2] + t * v[..., 2] - start[2]
        found += int(((s >= 0.0) & (t >= 0.0) & (s + t < 1.0) & (way * height > 0.0)).sum())
    return found


def sunk(scene: Scene, grid: tuple[int, int, int], places: np.ndarray) -> tuple[float, float]:
    """Return how deep the surface is in the obstacle [m], and how deep it may be: between points that lie on
    a ball of radius R, two of them √2 d apart, a straight line is d²/4R deep at most, twice that with what
    the points themselves give; and a tenth of the thickness."""
    (obstacle,) = scene.obstacles
    centre = obstacle.place()
    half = 0.5 * scene.sheet.thickness
    if isinstance(obstacle, Plane):
        return half - float(((places - centre) @ obstacle.direction).min()), 0.2 * half
    across = np.eye(3) - np.outer(obstacle.direction, obstacle.direction)
    reach = np.linalg.norm((places - centre) @ across, axis=2).min()
    cells = [length / (n - 1) for length, n in zip(scene.sheet.lengths, grid, strict=False)]
    apart = min(0.5 * obstacle.radius, 0.5 * max(cells))
    return obstacle.radius + half - float(reach), apart**2 / (2.0 * obstacle.radius) + 0.2 * half


def fault(scene: Scene, grid: tuple[int, int, int], solution: Solution) -> str:
    """Return what is wrong with an answer, "" for nothing."""
    if solution.status not in (Status.CONVERGED, Status.UNSTABLE) or solution.load_factor < 1.0:
        return ""
    places, (obstacle,) = surface(solution, grid, scene), scene.obstacles
    rim = INSIDE // 4  # beyond the last points of a free edge, a quarter of a cell, a mass may sink
    deep, allowed = sunk(scene, grid, places[rim:-rim, rim:-rim])
    if deep > allowed:
        return f"the surface is {deep:.3g} m deep in it, and may be {allowed:.3g} m"
    if isinstance(obstacle, Plane):
        return ""
    centre = obstacle.place()
    held = {support.edge for support in scene.supports}
    middles = [centre]
    if isinstance(obstacle, Cylinder):
        span = np.linspace(-1.0, 1.0, 21)[:, None] * max(scene.sheet.lengths) * obstacle.direction
        middles = list(centre + span)
    for middle in middles:
        below, above = crossings(places, middle, -1.0), crossings(places, middle, 1.0)
        if below and ({"x0", "x1"} <= held or not above):
            return f"the sheet is below the middle {middle.round(4).tolist()}"
    return ""


def judged(number: int) -> str:
    """Return the fault of the answer to a drawn scene, "" for none and for a refusal in a line."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene, grid = draw(number)
            solution = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=grid))
    except (SceneError, BadInput) as error:
        return str(error) if "\n" in str(error) else ""
    return fault(scene, grid, solution)
