"""The figure of natural modes: shapes on the plan, a row per model; a column has a mode of the lattice and
the references' modes of equal shape.
"""

import numpy as np
from matplotlib.figure import Figure
from scipy.ndimage import maximum_filter

from comparisons.modes.answer import Spectra
from comparisons.pictures.plan import inside, rims
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, GREY, plain
from sheetbench.scenes.objects.grid import near_square

MOST, CELLS = 6, 24  # modes; cells along the shorter side
COLOUR_MAP = "RdBu_r"
STILL = 0.02  # of the largest displacement: parts that move less, as along a clamp, have no nodal line


def compose(spectra: Spectra, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure: every shape's deflection divided by its largest one; for a mode in the plane, the
    magnitude of its displacement."""
    scene = spectra.scene
    nx, ny = near_square(scene.sheet, CELLS)
    x, y = (np.linspace(0.0, side, n + 1) for side, n in zip(scene.sheet.lengths, (nx, ny), strict=True))
    plan = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    on_sheet, x, y = inside(scene, plan), 1e3 * x, 1e3 * y
    count = min(len(spectra[0].frequencies), MOST)
    across = MOST // 2 if style.narrow else MOST
    rows = -(-count // across)  # per model
    aspect = scene.sheet.length_y / scene.sheet.length_x
    panel = style.width / across * min(max(aspect, 0.3), 2.0) + 0.2
    size = (style.width, len(spectra) * rows * panel + (0.3 if style.titled else 0.05))
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(len(spectra) * rows, across, squeeze=False).reshape(len(spectra), rows * across)
    shapes = [spectrum.modes.displacement(plan[on_sheet]) for spectrum in spectra.spectra]
    for row, (spectrum, model_shapes) in enumerate(zip(spectra.spectra, shapes, strict=True)):
        matches = [pair.is_ for pair in spectra.pairs_with(spectrum.model)] if row else range(1, count + 1)
        for column, axis in enumerate(panels[row]):
            axis.set_axis_off()
            if column >= count or (match := matches[column]) is None:
                continue
            number = match - 1
            shape = model_shapes[number]
            shape = shape if np.sum(shape * shapes[0][column]) >= 0.0 else -shape
            in_plane = np.abs(shape[:, 2]).max() < 0.5 * np.abs(shape).max()
            value = np.linalg.norm(shape, axis=1) if in_plane else shape[:, 2]
            height = np.ma.masked_all(len(plan))
            height[on_sheet] = value / (np.abs(value).max() or 1.0)
            value = height.reshape(len(y), len(x))
            axis.pcolormesh(x, y, value, cmap=COLOUR_MAP, vmin=-1, vmax=1, shading="gouraud", rasterized=True)
            if not in_plane and value.min() < 0.0 < value.max():
                still = maximum_filter(np.abs(value.filled(0.0)), 3) < STILL
                nodal = np.ma.masked_where(still | value.mask, value)
                axis.contour(x, y, nodal, levels=[0.0], colors=DARK, linewidths=0.6)
            for rim in rims(scene):
                axis.plot(*1e3 * rim.T, color=GREY, linewidth=0.6)
            axis.set_aspect("equal")
            kind = spectra.kinds[column]
            title = f"{number + 1}: {spectrum.frequencies[number]:.4g} Hz"
            axis.set_title(f"{kind}\n{title}" if kind and row == 0 else title, fontsize=6.5, pad=2)
        panels[row, 0].text(
            -0.06, 0.5, spectrum.model, rotation=90, ha="right", va="center", fontsize=7.5,
            transform=panels[row, 0].transAxes,
        )  # fmt: skip
    if style.titled:
        figure.suptitle(plain(scene.title or scene.name, longest=105), fontsize=8)
    return figure
