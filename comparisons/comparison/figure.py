"""The figure of a comparison: the lattice, the reference, and their difference on the deformed sheet.

The sheets are drawn at true scale unless their displacements are too small to see; lengths are in
millimetres. Actuators and loads are drawn on both sheets (`comparisons.pictures.stage`).
"""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Colormap, ListedColormap, Normalize
from matplotlib.figure import Figure

from comparisons.comparison.answer import Comparison
from comparisons.pictures import offscreen
from comparisons.pictures.labels import place_labels
from comparisons.pictures.plan import plan_mesh
from comparisons.pictures.stage import Stage, draw
from sheetbench.answers import style as plots
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.report import NoPicture
from sheetbench.answers.solution import Solution
from sheetbench.answers.style import GREY, plain
from sheetbench.scenes import Scene

LINE = 105  # characters of a title in full size
VISIBLE, DRAWN = 0.02, 0.08  # of the longer side: displacements below the first are enlarged to the second
FLAT = 1e-3  # of the largest displacement: sheets with smaller deflections show a component in the plane
TALLEST = 1.9  # inches, height of stacked panels: three with their texts fill a page
HEIGHTS = "viridis"
DIFFERENCES = ListedColormap(
    colormaps["magma_r"](np.linspace(0.0, 0.75, 256)), "magma_r"
)  # labels on its dark end
MODEL_NAMES = {
    "lumped": "Lumped lattice",
    "plate": "Mindlin plate",
    "shell": "Reissner–Mindlin shell",
    "solid": "Solid",
}


def compose(comparison: Comparison, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure with its three panels. Raises NoPicture."""
    scene = comparison.scene
    lattice, reference = comparison.solutions[:2]
    if not all(np.all(np.isfinite(s.mesh.point_data["displacement"])) for s in (lattice, reference)):
        raise NoPicture("a displacement is not a finite number")
    if reason := offscreen.unavailable_reason():
        raise NoPicture(reason)
    plan = plan_mesh(scene).points[:, :2]
    truth = reference.displacement(plan)
    difference = 1e3 * np.linalg.norm(lattice.displacement(plan) - truth, axis=1)
    largest = np.abs(truth).max(axis=0)
    axis = 2 if largest[2] > FLAT * largest.max() else int(np.argmax(largest))
    masses = 1e3 * lattice.mesh.point_data["displacement"][:, axis]
    heights = 1e3 * truth[:, axis]
    height_limits = _limits(np.concatenate([heights, masses]))
    difference_limits = (0.0, float(difference.max()) or 1.0)
    scale = exaggeration(scene, [lattice, reference])

    left, middle, right = (Stage(scene, reference, scale, plots.PIXELS) for _ in range(3))
    if any(kind == "line" for kind, _ in lattice.mesh.cells):
        left.lattice(lattice.mesh, masses, height_limits, HEIGHTS)
    else:
        lattice_heights = 1e3 * lattice.displacement(plan)[:, axis]
        left.surface(lattice, lattice_heights, height_limits, HEIGHTS, _elements(lattice))
    middle.surface(reference, heights, height_limits, HEIGHTS, _elements(reference))
    right.surface(reference, difference, difference_limits, DIFFERENCES, 0)
    flat = np.column_stack([plan, np.zeros(len(plan))])
    stages = ((left, lattice), (middle, reference), (right, reference))
    ends = [*(draw(stage, solution) for stage, solution in stages[:2]), right.obstacles()]
    seen = np.vstack([flat, left.deformed(reference, plan), left.deformed(lattice, plan), *ends])
    probes = scene.probe_points()
    images = [stage.take(seen, stage.deformed(solution, probes)) for stage, solution in stages]

    rows, columns = style.panels(3)
    aspect = images[0][0].shape[0] / images[0][0].shape[1]
    panel_height = style.width / columns * aspect
    panel_height = min(panel_height, TALLEST) if style.narrow else panel_height
    height = rows * (panel_height + 0.85) + 0.2 * style.titled
    figure = Figure(figsize=(style.width, height), layout="constrained")
    axes = figure.subplots(rows, columns).ravel()
    titles = [
        MODEL_NAMES.get(lattice.model.removesuffix("-advised"), lattice.model),
        MODEL_NAMES.get(reference.model, reference.model),
        "Difference",
    ]
    subtitles = (lattice.label, reference.label, comparison.error_in_words(lattice))
    for panel, (image, _), title, subtitle in zip(axes, images, titles, subtitles, strict=True):
        panel.imshow(image, interpolation="lanczos")
        panel.set_axis_off()
        panel.set_title(title, fontsize=8.5, fontweight="bold", pad=12)
        place: dict[str, Any] = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "center"}
        panel.annotate(subtitle, (0.5, 1.0), (0.0, 2.5), fontsize=6.5, color=GREY, va="bottom", **place)
    both: dict[str, Any] = {"ax": axes[1:2] if style.narrow else axes[:2], "shrink": 0.5, "aspect": 40}
    colour_bar(figure, HEIGHTS, height_limits, f"$u_{'xyz'[axis]}$  [mm]", **both)
    last: dict[str, Any] = {"ax": axes[2], "shrink": 0.7, "aspect": 28}
    colour_bar(figure, DIFFERENCES, difference_limits, "|$u$ − $u_{ref}$|  [mm]", **last)
    note = "drawn at true scale" if scale == 1.0 else f"displacements drawn {scale:g} times as large"
    if style.titled or scale != 1.0:
        title = plain(f"{scene.title or scene.name}  ({note})" if style.titled else note, longest=2 * LINE)
        figure.suptitle(title, fontsize=max(8.0 * min(1.0, LINE / len(title)), 5.0))
    figure.draw_without_rendering()
    for panel, (_, pixels) in zip(axes, images, strict=True):
        place_labels(panel, pixels, list(scene.probes))
    return figure


def exaggeration(scene: Scene, solutions: list[Solution]) -> float:
    """Return the factor of drawn displacements: 1, or a round number if they are too small to see."""
    plan = plan_mesh(scene, 16).points[:, :2]
    largest = max(float(np.abs(solution.displacement(plan)).max()) for solution in solutions)
    longer = max(scene.sheet.lengths)
    if largest == 0.0 or largest >= VISIBLE * longer:
        return 1.0
    factor = DRAWN * longer / largest
    power = 10.0 ** np.floor(np.log10(factor))
    return float(max(step * power for step in (1, 2, 5) if step * power <= factor))


def _limits(values: np.ndarray) -> tuple[float, float]:
    low, high = float(values.min()), float(values.max())
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _elements(solution: Solution) -> int:
    """Return the number of cells to mark along the shorter side: the solution's own, at most 16."""
    return min(np.min(solution.settings.get("elements", 16)), 16)


def colour_bar(
    figure: Figure, colours: str | Colormap, limits: tuple[float, float], label: str, **place: Any
) -> None:
    """Draw a horizontal colour bar; place: keywords of `Figure.colorbar`."""
    mapped = ScalarMappable(Normalize(*limits), colours)
    bar = figure.colorbar(mapped, orientation="horizontal", **place)
    bar.outline.set_visible(False)
    bar.set_label(label, labelpad=1.5)
    bar.ax.tick_params(length=2, width=0.5, pad=1.5, labelsize=6.5)
