"""Drawing of deformed sheets with pyvista, off screen: the stage of every panel.

Displacements are multiplied by `scale`. Needs off-screen drawing (`comparisons.pictures.offscreen`).

A stage also shows actuators and loads: chains and moved edges in red, loads as blue arrows, payloads at
points as dark balls, obstacles pale. An arrow starts at the point of action of its force and points along it
(`comparisons.pictures.plan`). A turned arrow is an edge's moment.
"""

from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np
import pyvista
from matplotlib.colors import Colormap

from comparisons.pictures import offscreen
from comparisons.pictures.plan import (
    ALONG,
    edge_plan,
    eye_heading,
    held_lines,
    load_arrows,
    on_sheet,
    plan_lines,
    plan_mesh,
    rims,
)
from sheetbench.answers.solution import FieldMesh, Solution
from sheetbench.answers.style import DARK, GREY
from sheetbench.scenes import EDGES, Chain, Cylinder, EdgeLoad, Plane, Scene, holds_director

REFERENCE_PIXELS = 1800  # width of the image for which line widths below are given in pixels
MARGIN = 0.04  # fraction of the image's width
ELEVATION = 27.0  # degrees above the plane
Colours = str | Colormap
LINK, OUTLINE, ROD, OBSTACLE = "#5f6770", "#a9afb6", "#c8553d", "#d8d2c4"


class Stage:
    """A white stage with the undeformed outline and the supports of a scene, viewed from the free side."""

    def __init__(self, scene: Scene, held: Solution, scale: float, pixels: int) -> None:
        self.scene = scene
        self.pixels = pixels
        self._line = pixels / REFERENCE_PIXELS
        self.scale = scale
        self.size = max(scene.sheet.lengths)
        with offscreen.drawing():
            self.plotter = pyvista.Plotter(off_screen=True, window_size=[pixels, pixels])
        self.plotter.background_color = pyvista.Color("white")
        self._outline()
        self._supports(held)

    def lattice(
        self, mesh: FieldMesh, values: np.ndarray, limits: tuple[float, float], colours: Colours
    ) -> None:
        """Draw links, diagonals paler and thinner, and masses coloured by a value per mass."""
        points = mesh.points + self.scale * mesh.point_data["displacement"]
        pairs = np.vstack([cell for kind, cell in mesh.cells if kind == "line"])
        along = np.abs(np.diff(mesh.points[pairs], axis=1)[:, 0]) > 1e-9 * self.size
        straight = along.sum(axis=1) == 1
        for links, colour, width in ((pairs[~straight], OUTLINE, 3.0), (pairs[straight], LINK, 6.0)):
            lines = pyvista.PolyData(points, lines=np.insert(links, 0, 2, axis=1).ravel())
            self.plotter.add_mesh(lines, color=colour, line_width=self._line * width, lighting=False)
        linked = np.unique(pairs)  # masses of absent cells have no links
        masses = pyvista.PolyData(points[linked])
        masses["value"] = values[linked]
        radius = min(0.15 / np.sqrt(len(points)), 0.011)
        self._balls(masses, radius, specular=0.3, **_coloured(limits, colours))

    def payloads(self, points: np.ndarray) -> None:
        """Draw balls at the positions (n, 3) [m] of payloads."""
        self._balls(pyvista.PolyData(points), 0.018, color=DARK, specular=0.3)

    def _balls(self, at: pyvista.PolyData, radius: float, **shown: Any) -> None:
        """Draw balls; radius: fraction of the longer side."""
        ball = pyvista.Sphere(radius=radius * self.size)
        balls = at.glyph(geom=ball, scale=False, orient=False)
        self.plotter.add_mesh(balls, smooth_shading=True, **shown)

    def obstacles(self, time: float | None = None) -> np.ndarray:
        """Draw obstacles near the sheet, at a time [s] or at last; return points on them (n, 3) [m]."""
        middle = np.array([*(0.5 * length for length in self.scene.sheet.lengths), 0.0])
        points, side = [np.empty((0, 3))], 1.3 * self.size
        for obstacle in self.scene.obstacles:
            at, along, radius = obstacle.place(1.0, time), obstacle.direction, obstacle.radius
            offset = ((middle - at) @ along) * along
            culling: Any = {"culling": "back"}  # hides a body's far side
            if isinstance(obstacle, Plane):
                body = pyvista.Plane(center=middle - offset, direction=along, i_size=side, j_size=side)
                culling = {}
            elif isinstance(obstacle, Cylinder):
                size: dict[str, Any] = {"radius": radius, "height": 1.2 * self.size}
                body = pyvista.Cylinder(center=at + offset, direction=along, resolution=80, **size)
            else:
                body = pyvista.Sphere(radius=radius, center=at, theta_resolution=60, phi_resolution=60)
                body.points += obstacle.core * np.sign((body.points - at).round(9))
            sharp = isinstance(obstacle, Cylinder)
            self.plotter.add_mesh(
                body, color=OBSTACLE, opacity=0.55, smooth_shading=True, split_sharp_edges=sharp, **culling
            )
            points.append(body.points)
        return np.concatenate(points)

    def chain(self, points: np.ndarray) -> None:
        """Draw a chain's axis through the ends of its segments (p, 3), with a ball at each."""
        line = pyvista.lines_from_points(points)
        self.plotter.add_mesh(line.tube(radius=0.006 * self.size), color=ROD, specular=0.2)
        self._balls(pyvista.PolyData(points), 0.01, color=ROD, specular=0.2)

    def surface(
        self,
        solution: Solution,
        values: np.ndarray,
        limits: tuple[float, float],
        colours: Colours,
        lines: int,
    ) -> None:
        """Draw the mid-surface coloured by a value per plan point; lines: marked cells per side."""
        plan = plan_mesh(self.scene)
        quads = plan.cells[0][1]
        faces = np.insert(quads, 0, 4, axis=1).ravel()
        surface = pyvista.PolyData(self.deformed(solution, plan.points[:, :2]), faces=faces)
        surface["value"] = values
        shown = _coloured(limits, colours)
        self.plotter.add_mesh(surface, smooth_shading=True, specular=0.25, ambient=0.25, **shown)
        for line in plan_lines(self.scene, lines):
            self._curve(self.deformed(solution, line), DARK, width=2.0, opacity=0.45)

    def deformed(self, solution: Solution, plan: np.ndarray) -> np.ndarray:
        """Return the positions (n, 3) of plan points (n, 2) in the drawn sheet."""
        flat = np.column_stack([plan, np.zeros(len(plan))])
        return flat + self.scale * solution.displacement(plan)

    def take(self, seen: np.ndarray, marked: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the image (height, width, 3) and the pixels (n, 2) of the points `marked` (n, 3) in it. The
        camera's view just includes the points `seen` (m, 3) and depends on the scene alone."""
        toward, right, up = self._axes()
        across, along = seen @ right, seen @ up
        centre = right * _middle(across) + up * _middle(along) + toward * _middle(seen @ toward)
        width, height = (
            (1 + 2 * MARGIN) * max(np.ptp(across), 1e-3 * self.size),
            np.ptp(along) + 2 * MARGIN * np.ptp(across),
        )
        plotter = self.plotter
        plotter.window_size = [self.pixels, int(self.pixels * np.clip(height / width, 0.3, 1.5))]
        plotter.camera_position = [tuple(centre + 4 * self.size * toward), tuple(centre), tuple(up)]
        plotter.camera.parallel_projection = True
        plotter.camera.parallel_scale = 0.5 * max(
            height, width * 0.3, width * plotter.window_size[1] / self.pixels
        )
        plotter.camera.clipping_range = (0.1 * self.size, 10 * self.size)
        plotter.enable_anti_aliasing("ssaa")
        image = np.asarray(plotter.screenshot(return_img=True))
        pixels = np.array([self._pixel(point) for point in marked]).reshape(-1, 2)
        plotter.close()
        return image, pixels

    def _axes(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return unit vectors towards the eye, to its right and up; the eye is on the free side, above."""
        azimuth, raised = eye_heading(self.scene), np.radians(ELEVATION)
        ahead = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        upright = np.array([0.0, 0.0, 1.0])
        toward = ahead * np.cos(raised) + upright * np.sin(raised)
        return toward, np.cross(upright, ahead), upright * np.cos(raised) - ahead * np.sin(raised)

    def _pixel(self, point: np.ndarray) -> tuple[float, float]:
        from vtkmodules.vtkRenderingCore import vtkCoordinate

        place = vtkCoordinate()
        place.SetCoordinateSystemToWorld()
        place.SetValue(*point)
        x, y = place.GetComputedDoubleDisplayValue(self.plotter.renderer)
        return x, self.plotter.window_size[1] - y

    def _outline(self) -> None:
        for rim in rims(self.scene):
            for start, end in pairwise(np.column_stack([rim, np.zeros(len(rim))])):
                dashes = max(round(28 * np.linalg.norm(end - start) / self.size), 1)
                for i in range(dashes):
                    ends = [start + (end - start) * (i + share) / dashes for share in (0.2, 0.8)]
                    self._curve(np.array(ends), OUTLINE, width=5.0)

    def _supports(self, held: Solution) -> None:
        for support in self.scene.supports:
            clamped = holds_director(support)
            for plan in held_lines(self.scene, support):
                tube = pyvista.lines_from_points(self.deformed(held, plan)).tube(
                    radius=(0.009 if clamped else 0.005) * self.size
                )
                colour = DARK if clamped else GREY
                self.plotter.add_mesh(tube, color=colour, smooth_shading=True, specular=0.2)

    def _curve(self, points: np.ndarray, colour: str, width: float, opacity: float = 1.0) -> None:
        curve = pyvista.lines_from_points(points)
        self.plotter.add_mesh(
            curve, color=colour, line_width=self._line * width, lighting=False, opacity=opacity
        )


def _coloured(limits: tuple[float, float], colours: Colours) -> dict[str, Any]:
    return {"scalars": "value", "cmap": colours, "clim": limits, "show_scalar_bar": False}


def _middle(values: np.ndarray) -> float:
    return 0.5 * float(values.min() + values.max())


LOAD = "#1b6ca8"
MOMENT = 0.035  # radius of a turned arrow, of the longer side
CHAIN_OFFSET = 0.012  # of the longer side: distance of a chain on a face from the mid-surface


def draw(stage: Stage, solution: Solution) -> np.ndarray:
    """Draw actuators, loads, payloads and obstacles; return points (n, 3) [m] that the view must include."""
    seen = [stage.obstacles()]
    scene = stage.scene
    for actuator in scene.actuators:
        if isinstance(actuator, Chain):
            plan = edge_plan(scene, actuator.edge, np.linspace(0.0, 1.0, actuator.segments + 1))
            side = np.sign(actuator.axis_height(scene.sheet.thickness))
            offset = side * CHAIN_OFFSET * stage.size * _normals(stage, solution, plan)
            stage.chain(stage.deformed(solution, plan) + offset)
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
    """Draw arrows of vectors (n, 3), in units of the longer side; return their ends (n, 3)."""
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
    """Draw turned arrows about an edge, from outside the sheet towards +z for a positive moment."""
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
    """Return unit normals (n, 3) of the drawn mid-surface at plan points (n, 2), by finite differences."""
    step = 1e-3 * stage.size
    tangents = []
    for axis in range(2):
        shift = np.zeros(2)
        shift[axis] = step
        ends = [on_sheet(stage.scene, plan + sign * shift) for sign in (-1.0, 1.0)]
        tangents.append(stage.deformed(solution, ends[1]) - stage.deformed(solution, ends[0]))
    normal = np.cross(*tangents)
    return np.asarray(normal / np.linalg.norm(normal, axis=1, keepdims=True))
