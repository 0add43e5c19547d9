"""The figure of a scene before a solve: plan, patches, supports, loads, payloads and probes."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.figure import Figure
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from shapely import MultiPoint

from comparisons.pictures.plan import edge_ends, held_lines, load_arrows
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, plain
from sheetbench.scenes import EdgeLoad, Plane, Scene, holds_director
from sheetbench.scenes.objects.shapes import Shape
from sheetbench.scenes.objects.supports import named, place

SHEET, PATCHES, LOAD, HELD = "#e8ebee", "YlOrBr", "#1b6ca8", "#8a939c"
PAYLOAD, OBSTACLE = "#4a3f6b", "#d8d2c4"
LONGEST = 0.14  # length of the longest arrow, of the longer side


def compose(scene: Scene, style: FigureStyle = PLAIN) -> Figure:
    """Return the plan of a scene: the sheet pale, with the elements of a given mesh; patches coloured,
    supports grey with a dark line, loads blue, payloads violet."""
    lengths = np.array(scene.sheet.lengths)
    height = style.width * min(max(lengths[1] / lengths[0], 0.25), 1.5) + 0.6
    figure = Figure(figsize=(style.width, height), layout="constrained")
    axis = figure.add_subplot()
    axis.add_patch(_filled(scene.region, facecolor=SHEET, edgecolor=DARK, linewidth=0.8))
    if (mesh := scene.sheet.mesh) is not None:
        points, quads = mesh.arrays
        elements = list(1e3 * points[quads])
        axis.add_collection(PolyCollection(elements, facecolors="none", edgecolors=HELD, linewidths=0.3))
    for number, patch in enumerate(scene.patches, start=1):
        colour = colormaps[PATCHES](0.2 + 0.6 * number / (len(scene.patches) + 1))
        face = {"facecolor": colour, "edgecolor": DARK, "linewidth": 0.4, "alpha": 0.7}
        _part(axis, scene, patch.shape, f"patch {number}", **face)
    for name, support in named(scene.supports).items():
        if (shape := place(support)) is not None:
            _part(axis, scene, shape, name, facecolor=HELD, edgecolor="none", alpha=0.6)
        for line in held_lines(scene, support):
            axis.plot(*1e3 * line.T, color=DARK, linewidth=3.0 if holds_director(support) else 1.5)
    for number, load in enumerate(scene.loads, start=1):
        if isinstance(load, EdgeLoad):
            for ends in edge_ends(scene, load.edge, load.where):
                axis.plot(*1e3 * np.array(ends).T, color=LOAD, linewidth=1.5)
        elif (shape := getattr(load, "where", None)) is not None:
            _part(axis, scene, shape, f"load {number}", facecolor=LOAD, edgecolor=LOAD, alpha=0.2)
    for number, payload in enumerate(scene.masses, start=1):
        if payload.where is not None:
            face = {"facecolor": PAYLOAD, "edgecolor": PAYLOAD, "alpha": 0.4}
            _part(axis, scene, payload.where, f"mass {number}", **face)
        elif payload.at is not None:
            axis.plot(*1e3 * np.array(payload.at), "s", markersize=7, color=PAYLOAD)
    for obstacle in scene.obstacles:
        if not isinstance(obstacle, Plane):  # a plane has no outline
            sides, along = np.array([[1, 1], [1, -1], [-1, -1], [-1, 1]]), obstacle.direction[:2]
            corners = obstacle.position[:2] + sides * obstacle.core[:2]
            corners += np.outer(sides[:, 0], max(scene.sheet.lengths) * along)
            caps: Any = "flat" if along.any() else "round"
            shadow = MultiPoint(corners).convex_hull.buffer(obstacle.radius, cap_style=caps)
            axis.add_patch(_filled(shadow, facecolor=OBSTACLE, edgecolor=DARK, alpha=0.5, linestyle="--"))
    _arrows(axis, scene, 1e3 * LONGEST * lengths.max())
    for name, at in scene.probes.items():
        axis.plot(1e3 * at[0], 1e3 * at[1], "o", markersize=3, markerfacecolor="white", markeredgecolor=DARK)
        axis.annotate(plain(name, longest=14), (1e3 * at[0], 1e3 * at[1]), (3, 3), textcoords="offset points")
    axis.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    if style.titled:
        axis.set_title(plain(scene.title or scene.name, longest=60), fontsize=8)
    axis.margins(0.06)
    return figure


def _arrows(axis: Axes, scene: Scene, longest: float) -> None:
    """Draw loads in the plane as arrows [mm], loads normal to it as dots (upwards) or crosses (downwards)."""
    plan, arrows = load_arrows(scene, lambda points: np.tile([0.0, 0.0, 1.0], (len(points), 1)))
    for at, along in zip(1e3 * plan, arrows, strict=True):
        size = float(np.linalg.norm(along))
        if size == 0.0:
            continue
        if abs(along[2]) < 0.7 * size:
            end = at + longest * along[:2] / size
            axis.update_datalim([end])
            axis.annotate("", end, at, arrowprops={"arrowstyle": "->", "color": LOAD})
        else:
            axis.plot(*at, marker="." if along[2] > 0.0 else "x", color=LOAD, markersize=5)


def _part(axis: Axes, scene: Scene, shape: Shape, name: str, **drawn_as: Any) -> None:
    """Draw the part of the sheet inside a shape, with its name at the upper left or lower right."""
    area = scene.region.intersection(shape.area)
    if not area.area:  # a rim, drawn as a line by the caller
        return
    axis.add_patch(_filled(area, **drawn_as))
    left, low, right, top = (1e3 * bound for bound in area.bounds)
    if name.startswith("patch"):
        axis.annotate(name, (right, low), (-2, 2), textcoords="offset points", fontsize=6, ha="right")
    else:
        axis.annotate(name, (left, top), (3, -3), textcoords="offset points", fontsize=6, va="top")


def _filled(area: Any, **drawn_as: Any) -> PathPatch:
    """Return an area [m] as a filled patch; holes stay empty because their rings run the opposite way."""
    parts = [part for part in getattr(area.normalize(), "geoms", [area.normalize()]) if part.area > 0.0]
    rings = [np.array(ring.coords) for part in parts for ring in (part.exterior, *part.interiors)]
    return PathPatch(Path.make_compound_path(*(Path(1e3 * ring, closed=True) for ring in rings)), **drawn_as)
