"""Names of points in a picture, placed so that none hides another or leaves the panel."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke

from sheetbench.answers.style import DARK, MOST, plain

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


Box = tuple[float, float, float, float]  # left, bottom, right, top, in points
Place = tuple[tuple[float, float], str]


def place_labels(axis: Axes, pixels: np.ndarray, names: list[str]) -> None:
    """Mark the pixels (n, 2) of an image and name the first of them, at most MOST."""
    per_point = abs(np.diff(axis.get_xlim())[0]) / (72.0 * axis.get_position().width * _width(axis))
    shown = [plain(name, longest=LONGEST) for name in names[:MOST]]
    flipped = np.array([1.0, -1.0]) / per_point  # y runs down in an image
    (left, right), (bottom, top) = axis.get_xlim(), sorted(axis.get_ylim())
    frame = (left / per_point, -top / per_point, right / per_point, -bottom / per_point)
    chosen = spread(pixels * flipped, shown, frame)
    for x, y in pixels:
        axis.plot(x, y, "o", markersize=3, markerfacecolor="white", markeredgecolor=DARK, markeredgewidth=0.7)
    for point, name, (offset, side) in zip(pixels, shown, chosen, strict=False):
        label = axis.annotate(name, point, offset, textcoords="offset points", ha=side, fontsize=SIZE)
        label.set_path_effects([withStroke(linewidth=1.8, foreground="white")])


def spread(points: np.ndarray, names: list[str], frame: Box, size: float = SIZE) -> list[Place]:
    """Where the names of the first of the points (n, 2) stand, all in points, y upwards, within a frame."""
    taken = [(x - 2, y - 2, x + 2, y + 2) for x, y in points]
    chosen = []
    for number, ((x, y), name) in enumerate(zip(points, names, strict=False)):
        boxes = [_box(x, y, place, len(name), size) for place in PLACES]
        others = [box for i, box in enumerate(taken) if i != number]
        best = int(np.argmin([_cost(box, others, frame) for box in boxes]))
        taken.append(boxes[best])
        chosen.append(PLACES[best])
    return chosen


def _width(axis: Axes) -> float:
    figure = axis.get_figure()
    assert figure is not None
    return float(figure.get_figwidth())  # type: ignore[union-attr]


def _box(x: float, y: float, place: Place, letters: int, size: float) -> Box:
    """Return what a name covers."""
    (right, up), side = place
    width = 0.62 * size * letters
    left = x + right - {"left": 0.0, "right": width, "center": 0.5 * width}[side]
    return (left, y + up, left + width, y + up + size)


def _cost(box: Box, others: list[Box], frame: Box) -> float:
    """Return the area that a name would share with others or have outside the frame."""
    inside = _common(box, frame)
    return (box[2] - box[0]) * (box[3] - box[1]) - inside + sum(_common(box, other) for other in others)


def _common(first: Box, second: Box) -> float:
    across = min(first[2], second[2]) - max(first[0], second[0])
    along = min(first[3], second[3]) - max(first[1], second[1])
    return max(across, 0.0) * max(along, 0.0)
