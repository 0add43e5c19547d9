"""Names of points in a picture, placed so that none hides another or leaves the panel."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke

from comparisons.report.style import DARK, MOST, plain

SIZE, LONGEST = 6.5, 14  # points; characters of a name
# Where a name may stand, in points from its point, in the order of preference: offset, alignment.
PLACES = (
    ((3.5, 3.5), "left"),
    ((-3.5, 3.5), "right"),
    ((3.5, -8.5), "left"),
    ((-3.5, -8.5), "right"),
    ((0.0, 6.0), "center"),
    ((0.0, -11.5), "center"),
    ((6.0, -2.0), "left"),
    ((-6.0, -2.0), "right"),
)


def place_labels(axis: Axes, pixels: np.ndarray, names: list[str]) -> None:
    """Mark the pixels (n, 2) of an image and name the first of them, at most MOST."""
    per_point = abs(np.diff(axis.get_xlim())[0]) / (72.0 * axis.get_position().width * _width(axis))
    taken = [(x - 2 * per_point, y - 2 * per_point, x + 2 * per_point, y + 2 * per_point) for x, y in pixels]
    for number, ((x, y), name) in enumerate(zip(pixels, names, strict=True)):
        axis.plot(x, y, "o", markersize=3, markerfacecolor="white", markeredgecolor=DARK, markeredgewidth=0.7)
        if number >= MOST:
            continue
        shown = plain(name, longest=LONGEST)
        boxes = [_box(x, y, offset, side, len(shown), per_point) for offset, side in PLACES]
        others = [box for i, box in enumerate(taken) if i != number]
        worst = [_cost(box, others, axis) for box in boxes]
        best = int(np.argmin(worst))
        taken.append(boxes[best])
        offset, side = PLACES[best]
        label = axis.annotate(shown, (x, y), offset, textcoords="offset points", ha=side, fontsize=SIZE)
        label.set_path_effects([withStroke(linewidth=1.8, foreground="white")])


Box = tuple[float, float, float, float]


def _width(axis: Axes) -> float:
    figure = axis.get_figure()
    assert figure is not None
    return float(figure.get_figwidth())  # type: ignore[union-attr]


def _box(x: float, y: float, offset: tuple[float, float], side: str, letters: int, per_point: float) -> Box:
    """The pixels that a name covers: left, top, right, bottom (y runs down)."""
    width, height = 0.62 * SIZE * letters, SIZE
    left = offset[0] - {"left": 0.0, "right": width, "center": 0.5 * width}[side]
    corners = (left, -offset[1] - height, left + width, -offset[1])
    return (
        x + corners[0] * per_point,
        y + corners[1] * per_point,
        x + corners[2] * per_point,
        y + corners[3] * per_point,
    )


def _cost(box: Box, others: list[Box], axis: Axes) -> float:
    """The area that a name would share with others or have outside the panel, [pixels²]."""
    (left, right), (bottom, top) = axis.get_xlim(), sorted(axis.get_ylim())
    inside = _common(box, (left, bottom, right, top))
    return (box[2] - box[0]) * (box[3] - box[1]) - inside + sum(_common(box, other) for other in others)


def _common(first: Box, second: Box) -> float:
    across = min(first[2], second[2]) - max(first[0], second[0])
    along = min(first[3], second[3]) - max(first[1], second[1])
    return max(across, 0.0) * max(along, 0.0)
