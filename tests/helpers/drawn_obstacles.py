"""Drawn sheets over drawn obstacles, solved on the lattice, and faults of the answer by geometry.

A solver that reports no equilibrium is not faults_of.
"""

import warnings

import numpy as np
from cases import sheet

import lumped
from lumped.cell_surface import CellSurface, shapes
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
    """Return places (m, n, 3) of points INSIDE a cell on the deformed mid-surface: curved as in contact,
    on a plane straight between masses."""
    mesh, (nx, ny, layers) = solution.mesh, grid
    masses = (mesh.points + mesh.point_data["displacement"]).reshape(ny, nx, layers, 3)
    corners = np.stack([masses[:-1, :-1], masses[:-1, 1:], masses[1:, 1:], masses[1:, :-1]], axis=2)
    cells = CellSurface(grid, solution.settings["layer_distance"])
    vectors = cells.vectors(corners.reshape(-1, 4 * layers, 3))[0].reshape(ny - 1, nx - 1, 12, 3)
    if isinstance(scene.obstacles[0], Plane):
        vectors[:, :, 4:] = 0.0
    out = np.empty((INSIDE * (nx - 1) + 1, INSIDE * (ny - 1) + 1, 3))
    line = np.linspace(0.0, 1.0, INSIDE + 1)
    s, r = np.meshgrid(line, line)
    basis = shapes(r.ravel(), s.ravel())
    for (j, i), _ in np.ndenumerate(vectors[..., 0, 0]):
        places = (basis @ vectors[j, i]).reshape(INSIDE + 1, INSIDE + 1, 3)
        out[INSIDE * i : INSIDE * (i + 1) + 1, INSIDE * j : INSIDE * (j + 1) + 1] = places
    return out


def crossings(places: np.ndarray, start: np.ndarray, way: float) -> int:
    """Return the number of times that a ray from `start` (3,) up or down, way = ±1, crosses the sheet."""
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


def sunk(scene: Scene, places: np.ndarray) -> tuple[float, float]:
    """Return the depth of the surface in the obstacle [m], and the allowed one: a tenth of the thickness, and
    the error of a depth that is biquadratic over half a radius of a sheet on a ball, below R/500."""
    (obstacle,) = scene.obstacles
    centre = obstacle.place()
    half = 0.5 * scene.sheet.thickness
    if isinstance(obstacle, Plane):
        return half - float(((places - centre) @ obstacle.direction).min()), 0.2 * half
    across = np.eye(3) - np.outer(obstacle.direction, obstacle.direction)
    reach = np.linalg.norm((places - centre) @ across, axis=2).min()
    return obstacle.radius + half - float(reach), 2e-3 * obstacle.radius + 0.2 * half


def fault(scene: Scene, grid: tuple[int, int, int], solution: Solution) -> str:
    """Return the fault of an answer, "" for none."""
    if solution.status not in (Status.CONVERGED, Status.UNSTABLE) or solution.load_factor < 1.0:
        return ""
    places, (obstacle,) = surface(solution, grid, scene), scene.obstacles
    rim = INSIDE // 4  # beyond the last points of a free edge, a quarter of a cell, a mass may sink
    deep, allowed = sunk(scene, places[rim:-rim, rim:-rim] if isinstance(obstacle, Plane) else places)
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


def faults_of(number: int) -> str:
    """Return the fault of the answer to a drawn scene, "" for none and for a refusal in a line."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            scene, grid = draw(number)
            solution = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, grid=grid))
    except (SceneError, BadInput) as error:
        return str(error) if "\n" in str(error) else ""
    return fault(scene, grid, solution)
