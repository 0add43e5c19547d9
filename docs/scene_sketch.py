"""Draws docs/images/scene.svg: axes, edges and the sense of everything in a scene that has a sign.

Run by `make docs-scene`. Four views: the sheet in space, a clamped strip from the side, an edge seen from
outside, and a cut through the thickness.
"""

from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import Circle, Polygon, Rectangle

INK, QUIET, SHEET, LOAD = "#222222", "#8a8a8a", "#cfe0ee", "#b4442c"
TARGET = Path(__file__).parent / "images" / "scene.svg"
OBLIQUE = np.array([[1.0, 0.0], [0.45, 0.38], [0.0, 1.0]])  # x to the right, y to the back, z up


def main() -> None:
    """Draw and write the picture."""
    plt.rcParams.update({"svg.hashsalt": "scene", "svg.fonttype": "none", "font.size": 9.0})
    figure, views = plt.subplots(2, 2, figsize=(9.4, 5.0), layout="constrained")
    for view, draw in zip(
        views.flat, (in_space, from_the_side, from_outside, through_the_thickness), strict=True
    ):
        draw(view)
        view.set_aspect("equal")
        view.axis("off")
    figure.savefig(TARGET, metadata={"Date": None})


def in_space(view: Axes) -> None:
    """Draw axes, sides and the names of the edges."""
    view.set_title("the flat sheet, its axes and edges", loc="left", color=INK)
    x, y, z = np.eye(3)
    corners = np.array([0 * x, 3 * x, 3 * x + 2.4 * y, 2.4 * y]) @ OBLIQUE
    view.add_patch(Polygon(corners, facecolor=SHEET, edgecolor=INK, lw=1.0))
    for end, name in ((3.8 * x, "x"), (3.4 * y, "y"), (1.1 * z, "z, up")):
        arrow(view, (0.0, 0.0), end @ OBLIQUE, INK)
        say(view, end @ OBLIQUE, name, INK, 0.12)
    for middle, name in (
        (1.2 * y, "x0"),
        (3 * x + 1.2 * y, "x1"),
        (1.5 * x, "y0"),
        (1.5 * x + 2.4 * y, "y1"),
    ):
        place = middle @ OBLIQUE
        view.text(
            *place,
            name,
            ha="center",
            va="center",
            color=INK,
            weight="bold",
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.5},
        )
    view.text(
        *(1.5 * x + 1.2 * y) @ OBLIQUE,
        "top: seen from +z\nmid-surface z = 0",
        ha="center",
        va="center",
        color=INK,
    )
    view.annotate("", (0.0, -0.32), (3.0, -0.32), arrowprops={"arrowstyle": "<->", "color": QUIET, "lw": 0.8})
    view.text(1.5, -0.36, "length_x", ha="center", va="top", color=QUIET)
    start, end = (3.3 * x) @ OBLIQUE, (3.3 * x + 2.4 * y) @ OBLIQUE
    view.annotate("", start, end, arrowprops={"arrowstyle": "<->", "color": QUIET, "lw": 0.8})
    view.text(*((start + end) / 2 + (0.12, -0.05)), "length_y", ha="left", va="top", color=QUIET)
    view.set_xlim(-0.3, 5.1)
    view.set_ylim(-0.65, 1.5)


def from_the_side(view: Axes) -> None:
    """Draw a tilted clamp and an edge moment, both positive; gravity and a force."""
    view.set_title("from the side: tilt > 0, moment_per_length > 0", loc="left", color=INK)
    s = np.linspace(0.0, 3.6, 60)
    drop = -0.32 * s + 0.055 * s**2 + 0.012 * s**3
    view.plot(s, drop, color=INK, lw=3.0, solid_capstyle="butt")
    view.plot([0.0, 4.0], [0.0, 0.0], color=QUIET, lw=0.8, ls="--")
    view.text(2.3, 0.06, "flat sheet", color=QUIET, va="bottom", ha="center")
    slope = np.arctan(-0.32)
    box = Rectangle(
        (-0.55, -0.22),
        0.55,
        0.44,
        facecolor="#dddddd",
        edgecolor=INK,
        hatch="////",
        lw=0.8,
        angle=np.degrees(slope),
        rotation_point=(0.0, 0.0),
    )
    view.add_patch(box)
    view.text(-0.3, -0.42, "x0 clamped", ha="center", va="top", color=INK)
    view.plot([0.0, 1.7], [0.0, -0.32 * 1.7], color=QUIET, lw=0.8)
    turn(view, (0.0, 0.0), 1.5, 0.0, slope, LOAD)
    say(view, (1.05, -0.16), "tilt", LOAD, 0.0)
    end = np.array([s[-1], drop[-1]])
    turn(view, end, 0.5, -0.7, 1.1, LOAD)
    say(view, (end[0] + 0.62, end[1] + 0.1), "moment\nat x1", LOAD, 0.0)
    arrow(view, (2.6, -0.55), (2.6, -1.05), LOAD)
    say(view, (2.7, -0.9), "gravity [0, 0, −9.81]", LOAD, 0.0)
    view.set_xlim(-0.9, 5.1)
    view.set_ylim(-1.15, 0.9)


def from_outside(view: Axes) -> None:
    """Draw an edge bent by a rod or a chain to a positive curvature."""
    view.set_title("an edge from outside: curvature > 0", loc="left", color=INK)
    kappa = 0.42
    s = np.linspace(-1.8, 1.8, 60)
    view.plot(np.sin(kappa * s) / kappa, (1.0 - np.cos(kappa * s)) / kappa, color=INK, lw=3.0)
    view.plot([-2.0, 2.0], [0.0, 0.0], color=QUIET, lw=0.8, ls="--")
    view.plot([0.0], [0.0], "o", color=LOAD, ms=5)
    view.text(0.0, -0.12, "middle and tangent stay", ha="center", va="top", color=INK)
    for side in (-1.0, 1.0):
        x, z = np.sin(kappa * side * 1.5) / kappa, (1.0 - np.cos(kappa * 1.5)) / kappa
        arrow(view, (x, 0.04), (x, z - 0.06), LOAD)
    say(view, (1.7, 0.22), "ends lift\ntowards +z", LOAD, 0.0)
    arrow(view, (-2.5, 0.0), (-2.5, 0.8), INK)
    say(view, (-2.5, 0.85), "z", INK, 0.06)
    view.text(
        0.0,
        0.85,
        'support kind = "curved": a rigid rod\nactuator: a chain, its joints at rest so',
        ha="center",
        va="bottom",
        color=QUIET,
    )
    view.set_xlim(-2.7, 3.0)
    view.set_ylim(-0.5, 1.5)


def through_the_thickness(view: Axes) -> None:
    """Draw faces, the chain's axis on each, pressure."""
    view.set_title("through the thickness: faces, pressure > 0", loc="left", color=INK)
    view.add_patch(Rectangle((-2.0, -0.3), 4.0, 0.6, facecolor=SHEET, edgecolor=INK, lw=1.0))
    view.plot([-2.2, 2.3], [0.0, 0.0], color=QUIET, lw=0.8, ls="-.")
    view.text(2.35, 0.0, "mid-surface, z = 0", va="center", color=QUIET)
    for height, place, face in ((0.55, 1.6, "top"), (-0.55, 1.6, "bottom"), (0.0, 0.5, "mid")):
        view.add_patch(Circle((place, height), 0.25, facecolor="white", edgecolor=INK, lw=1.0))
        view.plot([place], [height], "+", color=INK, ms=6)
        if face != "mid":
            say(view, (1.95, height), f'face = "{face}"', INK, 0.0)
    view.text(0.18, 0.14, '"mid"', ha="right", va="center", color=INK)
    view.annotate("", (1.2, 0.55), (1.2, 0.0), arrowprops={"arrowstyle": "<->", "color": QUIET, "lw": 0.8})
    view.text(1.1, 0.5, "thickness/2 + radius", ha="right", va="center", color=QUIET)
    view.annotate("", (-2.2, -0.3), (-2.2, 0.3), arrowprops={"arrowstyle": "<->", "color": QUIET, "lw": 0.8})
    view.text(-2.3, 0.0, "thickness", ha="right", va="center", color=QUIET)
    for place in (-1.7, -1.3, -0.9, -0.5):
        arrow(view, (place, -0.75), (place, -0.34), LOAD)
    view.text(-1.1, -0.8, "pressure, along the normal,\nat first +z", ha="center", va="top", color=LOAD)
    arrow(view, (-1.7, 0.3), (-1.7, 0.75), INK)
    view.text(-1.8, 0.62, "normal", ha="right", va="center", color=INK)
    view.set_xlim(-3.3, 4.3)
    view.set_ylim(-1.45, 0.95)


def arrow(view: Axes, start: object, end: object, color: str) -> None:
    view.annotate(
        "",
        end,
        start,
        arrowprops={"arrowstyle": "-|>", "color": color, "lw": 1.3, "shrinkA": 0, "shrinkB": 0},
    )


def turn(view: Axes, centre: object, radius: float, start: float, end: float, color: str) -> None:
    """Draw an arc with a head, from one angle to another."""
    angles = np.linspace(start, end, 40)
    x, y = np.asarray(centre)[:, None] + radius * np.array([np.cos(angles), np.sin(angles)])
    view.plot(x, y, color=color, lw=1.3)
    arrow(view, (x[-4], y[-4]), (x[-1], y[-1]), color)


def say(view: Axes, place: object, text: str, color: str, right: float) -> None:
    x, y = place
    view.text(x + right, y, text, color=color, va="center", ha="left")


if __name__ == "__main__":
    main()
