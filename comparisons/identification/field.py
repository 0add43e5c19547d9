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

from dataclasses import dataclass
from typing import Annotated, Any

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
from sheetbench.answers.table import MILLIMETRES, NUMBER, Column, Table, TableUnit, quantity, unit
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.parameters import parameter, short_name

SUFFIX = "=field"
FIELDS = ("young", "thickness", "density")
STEPS, SMALL, LONGEST = 30, 1e-4, 1.0  # of p: the change that ends the search, the largest of a step
SMOOTHING = (-8.0, 8.0)  # log₁₀ of α beside its size that gives both terms the same weight


@dataclass(frozen=True)
class CellRow:
    """Value in a cell with its deviation by noise; resolved: side of the square it is the mean of."""

    x: Annotated[float, MILLIMETRES(".1f")]
    y: Annotated[float, MILLIMETRES(".1f")]
    unit: TableUnit
    value: Annotated[float, NUMBER(".4g")]
    deviation: Annotated[float, NUMBER(".2g", "± of noise")]
    resolved: Annotated[float, MILLIMETRES(".0f")]


@dataclass(frozen=True)
class FieldRow:
    """Statistics of a field over its cells; values: least, median and most."""

    unknown: str
    numbers: Annotated[str, Column("independent numbers")]
    resolved: Annotated[float, MILLIMETRES(".0f")]
    unit: TableUnit
    values: dict[Column, float]


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
    determined: float
    evaluations: int
    converged: bool

    def document(self) -> dict[str, Any]:
        fields = {name: value for name, value in vars(self).items() if name != "determined"}
        return fields | {"scene": self.scene.name, "told": self.determined}

    def tables(self) -> tuple[Table, ...]:
        """Return a row of statistics over the cells, then a row per cell."""
        fields, present = (self.values, self.deviation, self.resolved), np.isfinite(self.values)
        columns = (*self.centres[present].T.tolist(), *(field[present].tolist() for field in fields))
        rows = (CellRow(x, y, unit(self.unit), *numbers) for x, y, *numbers in zip(*columns, strict=True))
        return (*self.printed(), Table.of(CellRow, rows, f"{self.name} of the cells", "field"))

    def printed(self) -> tuple[Table, ...]:
        of_cells = np.nanpercentile(self.values, (0, 50, 100)).tolist()
        values = {NUMBER(".4g", n): v for n, v in zip(("least", "median", "most"), of_cells, strict=True)}
        numbers, resolved = f"{self.determined:.1f}", float(np.nanmedian(self.resolved))
        row = FieldRow(self.name, numbers, resolved, unit(self.unit), values)
        caption = f"{self.name} of {np.isfinite(self.values).sum()} cells, χ²/n = {self.chi:.2f}"
        return (Table.of(FieldRow, [row], caption, "unknowns"),)

    def figures(self) -> tuple[Picture, ...]:
        compose = "comparisons.identification.field:compose"
        return (Picture("identification", compose, (self,), formats=RASTER),)

    def result(self) -> str:
        """Return the range of values and the count of independent numbers."""
        least, most = (quantity(float(of(self.values)), self.unit, ".4g") for of in (np.nanmin, np.nanmax))
        return f"{self.name} from {least} to {most}; {self.determined:.0f} independent numbers in the data"

    def notes(self) -> tuple[str, ...]:
        return (
            "smoothed until noise remains: a value is the mean over a square of about the resolved side; its "
            "± is due to noise alone",
        )

    def complaints(self) -> list[str]:
        faults = [] if self.converged else [f"the search did not end within {self.evaluations} evaluations"]
        if self.converged and self.chi > 1.1:
            faults.append(f"χ²/n = {self.chi:.2f}: every field of {self.name} leaves more than noise")
        return faults

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
    scene, array = model.scene, f"cells.{name}"
    sheet = lumped.Differentiable(scene, model.springs)
    base = sheet.base[array]
    present, measured_components = base > 0.0, measured.measured.ravel()
    weights = 1.0 / np.repeat(measured.deviation, 3)[measured_components]
    data, count = weights * measured.displacement.ravel()[measured_components], int(measured_components.sum())
    lattice = sheet.problem.assembly.lattice
    widths = [line.widths for line in lattice.lines]
    roughness = _assemble_roughness(present, *widths)
    p, converged, evaluations = np.zeros(int(present.sum())), False, 0
    while not converged and evaluations < STEPS:
        evaluations += 1
        values = base.copy()
        values[present] *= np.exp(p)
        u = sheet.solve({array: values})
        displacement, surface = sheet.surface(measured.points)
        residuals = weights * displacement.ravel()[measured_components] - data
        observe = weights[:, None] * surface.matrix(len(u)).toarray()[measured_components]
        context().progress(f"{name} of {len(p)} cells: χ²/n = {residuals @ residuals / count:.3g}")
        rows = (sheet.pullback(row.reshape(-1, 3))[array] for row in observe)
        slopes = np.array([(values * row)[present] for row in rows])
        target, smoothing = _solve_smoothed(slopes, slopes @ p - residuals, roughness)
        change = np.clip(target - p, -LONGEST, LONGEST)
        converged = bool(np.abs(change).max() < SMALL)
        p = p + change
    information = slopes.T @ slopes
    inverse = np.linalg.inv(information + smoothing * roughness)
    resolution, noise = inverse @ information, inverse @ information @ inverse
    deviations, shares = np.sqrt(np.diag(noise)), np.clip(np.diag(resolution), 1e-9, 1.0)
    shown, deviation, resolved = np.full((3, *base.shape), np.nan)
    shown[present], deviation[present] = values[present], values[present] * deviations
    resolved[present] = np.sqrt(lattice.cell_areas[present] / shares)
    centres, given = [line.at[:-1] + 0.5 * line.widths for line in lattice.lines], parameter(scene, name)
    return FieldIdentification(
        scene=scene,
        name=name,
        unit=given.unit,
        start=given.value,
        settings=model.settings,
        centres=np.stack(np.meshgrid(*centres), axis=-1),
        values=shown,
        deviation=deviation,
        resolved=resolved,
        chi=float(residuals @ residuals) / count,
        smoothing=smoothing,
        determined=float(np.trace(resolution)),
        evaluations=evaluations,
        converged=converged,
    )


def _assemble_roughness(present: np.ndarray, widths_x: np.ndarray, widths_y: np.ndarray) -> np.ndarray:
    """Return LᵀL over the present cells, of differences between neighbouring cells."""
    unit_fields, total = np.zeros((*present.shape, int(present.sum()))), 0.0
    unit_fields[present] = np.eye(unit_fields.shape[2])
    distance_x, distance_y = (0.5 * (widths[1:] + widths[:-1]) for widths in (widths_x, widths_y))
    weights = widths_y[:, None] / distance_x, widths_x / distance_y[:, None]
    pairs = present[:, 1:] & present[:, :-1], present[1:] & present[:-1]
    for axis, weight, pair in zip((1, 0), weights, pairs, strict=True):
        differences = np.sqrt(weight[pair])[:, None] * np.diff(unit_fields, axis=axis)[pair]
        total = total + differences.T @ differences
    return np.asarray(total)


def _solve_smoothed(slopes: np.ndarray, data: np.ndarray, roughness: np.ndarray) -> tuple[np.ndarray, float]:
    """Return p with a residual of J p = b as large as the noise, within the range of α, and its α."""
    normal, right_hand_side = slopes.T @ slopes, slopes.T @ data
    scale = np.trace(normal) / np.trace(roughness)

    def solve_with(exponent: float) -> np.ndarray:
        return np.asarray(np.linalg.solve(normal + scale * 10.0**exponent * roughness, right_hand_side))

    def excess(exponent: float) -> float:
        residuals = slopes @ solve_with(exponent) - data
        return float(residuals @ residuals) / len(data) - 1.0

    low, high = SMOOTHING
    at_low, at_high = excess(low), excess(high)
    best = low if at_low > 0.0 else high if at_high < 0.0 else float(brentq(excess, low, high, xtol=1e-3))
    return solve_with(best), float(scale * 10.0**best)


def compose(answer: FieldIdentification, style: FigureStyle = PLAIN) -> Figure:
    """Draw the field at the left, and at the right the side of the square that each value is the mean of."""
    rows, columns = style.panels(2)
    figure = Figure(figsize=(style.width, 3.0 * rows), layout="constrained")
    sides = [1e3 * side for side in answer.scene.sheet.lengths]
    relative = answer.values / answer.start, f"{answer.name} over the scene's"
    for axis, (values, title) in zip(
        figure.subplots(rows, columns), (relative, (1e3 * answer.resolved, "resolved [mm]")), strict=True
    ):
        image = axis.imshow(values, origin="lower", extent=(0.0, sides[0], 0.0, sides[1]), cmap="viridis")
        figure.colorbar(image, ax=axis, shrink=0.9)
        axis.set_title(title, loc="left", fontsize=7.5, fontweight="bold")
        axis.set(xlabel="x [mm]", ylabel="y [mm]")
    return figure
