"""Names of points in a figure, placed without overlaps and inside the panel."""

from collections.abc import Iterable, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patheffects import withStroke
from matplotlib.text import Annotation
from matplotlib.transforms import Bbox, BboxBase

from sheetbench.answers.style import DARK, MOST, plain

SIZE, LONGEST = 6.5, 14  # points; characters of a name
STEPS = (3.5, 9.0, 15.0)  # points from a point to its name
CORNERS = ((1, 1), (-1, 1), (1, -1), (-1, -1), (0, 1), (0, -1), (1, 0), (-1, 0))  # directions, by preference
ACROSS, UP = ("center", "left", "right"), ("center", "bottom", "top")


def place_labels(axis: Axes, pixels: np.ndarray, names: list[str]) -> None:
    """Mark the pixels (n, 2) of an image and name the first of them, at most MOST."""
    labels = []
    for x, y in pixels:
        axis.plot(x, y, "o", markersize=3, markerfacecolor="white", markeredgecolor=DARK, markeredgewidth=0.7)
    for point, name in zip(pixels, names[:MOST], strict=False):
        shown = plain(name, longest=LONGEST)
        labels.append(axis.annotate(shown, point, (0, 0), textcoords="offset points", fontsize=SIZE))
        labels[-1].set_path_effects([withStroke(linewidth=1.8, foreground="white")])
    axis.apply_aspect()
    spread(labels, marks(axis, pixels), frame=axis.get_window_extent())


def marks(axis: Axes, points: np.ndarray) -> list[Bbox]:
    """Return the boxes of the marks of points (n, 2), in pixels."""
    size, at = axis.figure.dpi / 36.0, axis.transData.transform(points.reshape(-1, 2))
    return [Bbox.from_bounds(x - 0.5 * size, y - 0.5 * size, size, size) for x, y in at]


def spread(
    labels: Iterable[Annotation],
    taken: Sequence[BboxBase],
    corners: Sequence[tuple[int, int]] = CORNERS,
    frame: BboxBase | None = None,
) -> None:
    """Move each label to the position near its point with the least overlap with taken boxes and earlier
    labels, and the least area outside the frame; corners: directions from the point, in order of
    preference."""
    hidden = list(taken)
    for label in labels:
        places = [(step, x, y) for step in STEPS for x, y in corners]
        costs = [_cost(_moved(label, *place), hidden, frame) for place in places]
        hidden.append(_moved(label, *places[int(np.argmin(costs))]))


def _moved(label: Annotation, step: float, x: int, y: int) -> Bbox:
    """Move a label off its point; return its box in pixels."""
    label.xyann = (step * x, step * y)
    label.set(ha=ACROSS[x], va=UP[y])
    return label.get_window_extent()


def _cost(box: BboxBase, taken: Sequence[BboxBase], frame: BboxBase | None) -> float:
    """Return the area of a label that overlaps others or lies outside the frame."""
    outside = 0.0 if frame is None else box.width * box.height - _common(box, frame)
    return float(round(outside + sum(_common(box, other) for other in taken), 6))


def _common(first: BboxBase, second: BboxBase) -> float:
    both = Bbox.intersection(first, second)
    return 0.0 if both is None else float(both.width * both.height)
