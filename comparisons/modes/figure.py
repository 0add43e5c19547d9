"""The picture of natural modes: shapes on the plan, a row a model, a column a mode of the lattice and the
modes of the same shape of the references.
"""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure
from scipy.ndimage import maximum_filter

from comparisons.modes.answer import Spectra
from comparisons.pictures.plan import inside, rims
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.style import DARK, GREY, plain
from sheetbench.scenes.objects.grid import near_square

MOST, CELLS = 6, 24  # modes; cells along the shorter side
SHADES = "RdBu_r"
STILL = 0.02  # of the largest displacement: where less moves, as along a clamp, there is no nodal line


def compose(found: Spectra, style: FigureStyle = PLAIN) -> Figure:
    """Return the figure. Heights of every shape are in units of its largest displacement; where a mode moves
    in the plane, the length of its displacement stands for them."""
    scene = found.scene
    nx, ny = near_square(scene.sheet, CELLS)
    x, y = (np.linspace(0.0, side, n + 1) for side, n in zip(scene.sheet.lengths, (nx, ny), strict=True))
    plan = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    there, x, y = inside(scene, plan), 1e3 * x, 1e3 * y
    count = min(len(found[0].frequencies), MOST)
    across = MOST // 2 if style.narrow else MOST
    rows = -(-count // across)  # of one model
    aspect = scene.sheet.length_y / scene.sheet.length_x
    panel = style.width / across * min(max(aspect, 0.3), 2.0) + 0.2
    size = (style.width, len(found) * rows * panel + (0.3 if style.titled else 0.05))
    figure = Figure(figsize=size, layout="constrained")
    panels = figure.subplots(len(found) * rows, across, squeeze=False).reshape(len(found), rows * across)
    shapes = [spectrum.modes.displacement(plan[there]) for spectrum in found.found]
    for row, (spectrum, own) in enumerate(zip(found.found, shapes, strict=True)):
        matches = [pair.is_ for pair in found.against(spectrum.model)] if row else range(1, count + 1)
        for column, axis in enumerate(panels[row]):
            axis.set_axis_off()
            if column >= count or (match := matches[column]) is None:
                continue
            number = match - 1
            shape = own[number] * (1.0 if np.sum(own[number] * shapes[0][column]) >= 0.0 else -1.0)
            flat = np.abs(shape[:, 2]).max() < 0.5 * np.abs(shape).max()
            value = np.linalg.norm(shape, axis=1) if flat else shape[:, 2]
            height = np.ma.masked_all(len(plan))
            height[there] = value / (np.abs(value).max() or 1.0)
            value = height.reshape(len(y), len(x))
            axis.pcolormesh(x, y, value, cmap=SHADES, vmin=-1, vmax=1, shading="gouraud", rasterized=True)
            if not flat and value.min() < 0.0 < value.max():
                still = maximum_filter(np.abs(value.filled(0.0)), 3) < STILL
                nodal = np.ma.masked_where(still | value.mask, value)
                axis.contour(x, y, nodal, levels=[0.0], colors=DARK, linewidths=0.6)
            for rim in rims(scene):
                axis.plot(*1e3 * rim.T, color=GREY, linewidth=0.6)
            axis.set_aspect("equal")
            kind = found.kinds[column]
            title = f"{number + 1}: {spectrum.frequencies[number]:.4g} Hz"
            axis.set_title(f"{kind}\n{title}" if kind and row == 0 else title, fontsize=6.5, pad=2)
        panels[row, 0].text(
            -0.06, 0.5, spectrum.model, rotation=90, ha="right", va="center", fontsize=7.5,
            transform=panels[row, 0].transAxes,
        )  # fmt: skip
    if style.titled:
        figure.suptitle(plain(scene.title or scene.name, longest=105), fontsize=8)
    return figure
