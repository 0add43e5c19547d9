"""A field over a lattice's cells from displacements measured at rest: E, thickness or density of every cell.

Unknowns p are the logarithms of the cells' values over the scene's, J the slopes of the m residuals r, in
standard deviations of the measurements, by p (one adjoint solution a number, `lumped.gradient`). A step
minimises

    |r + J δp|² + α |L p|²,     |L p|² ≈ ∫ |∇p|² dA,

with the α that leaves |r + J δp|² = m, as noise does (Morozov's discrepancy principle). Values found are a
mixture R = (JᵀJ + α LᵀL)⁻¹ JᵀJ of the true ones: its trace is the count of independent numbers in the data,
and a cell of area A has the mean of about A/R_cc. The covariance of their noise is
(JᵀJ + α LᵀL)⁻¹ JᵀJ (JᵀJ + α LᵀL)⁻¹.
Source: Aster, Borchers and Thurber, Parameter Estimation and Inverse Problems (2013), chapters 4 and 10.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import brentq

import lumped
from comparisons.identification.measurements import Displacements, Measured
from comparisons.models.context import context
from comparisons.models.resolve import Resolved
from comparisons.models.spec import Lattice
from sheetbench.answers.answer import Answer
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.report import RASTER, Picture
from sheetbench.answers.table import MILLIMETRES, NUMBER, Column, Table, quantity, unit
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.parameters import parameter, short_name

SUFFIX = "=field"
FIELDS = ("young", "thickness", "density")
STEPS, SMALL, LONGEST = 30, 1e-4, 1.0  # of p: the change that ends the search, the largest of a step
SMOOTHING = (-8.0, 8.0)  # log₁₀ of α beside its size that gives both terms the same weight
COLUMNS = (*(MILLIMETRES(".1f", axis) for axis in "xy"), "unit", NUMBER(".4g", "value"))
COLUMNS += (NUMBER(".2g", "± of noise"), MILLIMETRES(".0f", "resolved"))
SUMMARY: tuple[str | Column, ...] = ("unknown", "numbers told", MILLIMETRES(".0f", "resolved"), "unit")
SUMMARY += tuple(NUMBER(".4g", name) for name in ("least", "median", "most"))


@dataclass(frozen=True, repr=False)
class FieldIdentification(Answer):
    """Values of a parameter in cells (rows, columns), nan where there is no cell. deviation: standard
    deviation of the values from noise; resolved: side [m] of the square that each value is the mean of;
    centres: (rows, columns, 2) [m]; chi: χ²/m of m numbers; determined: number of values that the data
    determine; start: the scene's value."""

    file_name = "identification"
    scene: Scene
    name: str
    unit: str
    start: float
    settings: dict[str, Any]
    centres: np.ndarray
    values: np.ndarray
    deviation: np.ndarray
    resolved: np.ndarray
    chi: float
    smoothing: float
    told: float
    evaluations: int
    converged: bool

    def document(self) -> dict[str, Any]:
        return vars(self) | {"scene": self.scene.name}

    def tables(self) -> tuple[Table, ...]:
        """Return a row of statistics over the cells, then a row per cell."""
        parts, there = (self.centres, self.values, self.deviation, self.resolved), np.isfinite(self.values)
        each = zip(*(part[there].tolist() for part in parts), strict=True)
        rows = [(*at, unit(self.unit), *numbers) for at, *numbers in each]
        return (*self.printed(), Table.listed(f"{self.name} of the cells", COLUMNS, rows, "field"))

    def printed(self) -> tuple[Table, ...]:
        values = [float(of(self.values)) for of in (np.nanmin, np.nanmedian, np.nanmax)]
        row = self.name, f"{self.told:.1f}", float(np.nanmedian(self.resolved)), unit(self.unit), *values
        caption = f"{self.name} of {np.isfinite(self.values).sum()} cells, χ²/n = {self.chi:.2f}"
        return (Table.listed(caption, SUMMARY, [row], "unknowns"),)

    def figures(self) -> tuple[Picture, ...]:
        compose = "comparisons.identification.field:compose"
        return (Picture("identification", compose, (self,), formats=RASTER),)

    def result(self) -> str:
        """Return the range of values and the count of independent numbers."""
        least, most = (quantity(float(of(self.values)), self.unit, ".4g") for of in (np.nanmin, np.nanmax))
        return f"{self.name} from {least} to {most}; the data tell {self.told:.0f} numbers"

    def notes(self) -> tuple[str, ...]:
        return (
            "smoothed as far as noise is left: a value is the mean over a square of about the side resolved, "
            "finer detail is not seen; its ± is that of noise alone",
        )

    def complaints(self) -> list[str]:
        found = [] if self.converged else [f"the search did not end within {self.evaluations} evaluations"]
        if self.converged and self.chi > 1.1:
            found.append(f"χ²/n = {self.chi:.2f}: no field of {self.name} leaves noise alone")
        return found

    def choices(self) -> dict[str, Any]:
        return self.settings

    @property
    def succeeded(self) -> bool:
        return self.converged


def identify_field(model: Resolved[Lattice], measured: Measured, name: str) -> FieldIdentification:
    """Return the field of young, thickness or density over a lattice's cells. Raises BadInput for other names
    and data that come without a standard deviation, of a motion or of a surface."""
    require_choice("unknown", name := short_name(name), FIELDS)
    if not isinstance(measured, Displacements) or measured.time is not None:
        raise BadInput(f"unknown = '{name}{SUFFIX}': displacements of points at rest are needed")
    if measured.deviation is None:
        raise BadInput(f"unknown = '{name}{SUFFIX}': smoothing goes by the noise: give --uncertainty")
    scene, key = model.scene, f"cells.{name}"
    sheet = lumped.Differentiable(scene, model.springs)
    base = sheet.base[key]
    there, given = base > 0.0, measured.measured.ravel()
    weights = 1.0 / np.repeat(measured.deviation, 3)[given]
    to_points = weights[:, None] * sheet.at(measured.points).toarray()[given]
    data, count = weights * measured.displacement.ravel()[given], int(given.sum())
    lattice = sheet.problem.assembly.lattice
    widths = [line.widths for line in lattice.lines]
    rough = _roughness(there, *widths)
    p, converged, evaluations = np.zeros(int(there.sum())), False, 0
    while not converged and evaluations < STEPS:
        evaluations += 1
        values = base.copy()
        values[there] *= np.exp(p)
        left = to_points @ sheet.solve({key: values}).ravel() - data
        context().progress(f"{name} of {len(p)} cells: χ²/n = {left @ left / count:.3g}")
        rows = (sheet.pullback(row.reshape(-1, 3))[key] for row in to_points)
        slopes = np.array([(values * row)[there] for row in rows])
        found, smoothing = _smoothed(slopes, slopes @ p - left, rough)
        change = np.clip(found - p, -LONGEST, LONGEST)
        converged = bool(np.abs(change).max() < SMALL)
        p = p + change
    told = slopes.T @ slopes
    inverse = np.linalg.inv(told + smoothing * rough)
    resolution, noise = inverse @ told, inverse @ told @ inverse
    spread, own_share = np.sqrt(np.diag(noise)), np.clip(np.diag(resolution), 1e-9, 1.0)
    square = lattice.cell_areas[there] / own_share
    shown, deviation, resolved = np.full((3, *base.shape), np.nan)
    shown[there], deviation[there], resolved[there] = values[there], values[there] * spread, np.sqrt(square)
    middles, own = [line.at[:-1] + 0.5 * line.widths for line in lattice.lines], parameter(scene, name)
    return FieldIdentification(
        scene=scene,
        name=name,
        unit=own.unit,
        start=own.value,
        settings=model.settings,
        centres=np.stack(np.meshgrid(*middles), axis=-1),
        values=shown,
        deviation=deviation,
        resolved=resolved,
        chi=float(left @ left) / count,
        smoothing=smoothing,
        told=float(np.trace(resolution)),
        evaluations=evaluations,
        converged=converged,
    )


def _roughness(there: np.ndarray, widths_x: np.ndarray, widths_y: np.ndarray) -> np.ndarray:
    """Return LᵀL over the present cells, of differences between neighbouring cells."""
    units, found = np.zeros((*there.shape, int(there.sum()))), 0.0
    units[there] = np.eye(units.shape[2])
    apart_x, apart_y = (0.5 * (widths[1:] + widths[:-1]) for widths in (widths_x, widths_y))
    weights = widths_y[:, None] / apart_x, widths_x / apart_y[:, None]
    both = there[:, 1:] & there[:, :-1], there[1:] & there[:-1]
    for axis, weight, pair in zip((1, 0), weights, both, strict=True):
        rows = np.sqrt(weight[pair])[:, None] * np.diff(units, axis=axis)[pair]
        found = found + rows.T @ rows
    return np.asarray(found)


def _smoothed(slopes: np.ndarray, wanted: np.ndarray, rough: np.ndarray) -> tuple[np.ndarray, float]:
    """Return p that leaves as much of J p = b as noise does, or as near to it as SMOOTHING allows, and its
    α."""
    square, pulled = slopes.T @ slopes, slopes.T @ wanted
    size = np.trace(square) / np.trace(rough)

    def found(exponent: float) -> np.ndarray:
        return np.asarray(np.linalg.solve(square + size * 10.0**exponent * rough, pulled))

    def excess(exponent: float) -> float:
        left = slopes @ found(exponent) - wanted
        return float(left @ left) / len(wanted) - 1.0

    low, high = SMOOTHING
    ends = excess(low), excess(high)
    best = low if ends[0] > 0.0 else high if ends[1] < 0.0 else float(brentq(excess, low, high, xtol=1e-3))
    return found(best), float(size * 10.0**best)


def compose(found: FieldIdentification, style: FigureStyle = PLAIN) -> Figure:
    """Draw the field at the left, and at the right the side of the square that each value is the mean of."""
    rows, columns = style.panels(2)
    figure = Figure(figsize=(style.width, 3.0 * rows), layout="constrained")
    sides = [1e3 * side for side in found.scene.sheet.lengths]
    shown = found.values / found.start, f"{found.name} over the scene's"
    for axis, (values, title) in zip(
        figure.subplots(rows, columns), (shown, (1e3 * found.resolved, "resolved [mm]")), strict=True
    ):
        drawn = axis.imshow(values, origin="lower", extent=(0.0, sides[0], 0.0, sides[1]), cmap="viridis")
        figure.colorbar(drawn, ax=axis, shrink=0.9)
        axis.set_title(title, loc="left", fontsize=7.5, fontweight="bold")
        axis.set(xlabel="x [mm]", ylabel="y [mm]")
    return figure
