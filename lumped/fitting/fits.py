"""Springs fitted to data: fit-static to displacement fields, fit-modal to natural frequencies.

Both start from the springs of `consistent` and vary the logarithms of the spring constants (positive links)
and the area springs as shares of the diagonal ones; layer distance, kz, the edges' twist and the strain
springs that share the stretching with the axial links, of which data determine the sum alone, are kept; on a
graded grid the cells' springs of a family are scaled equally. Gauss–Newton with exact Jacobians: of
displacements from `lumped.gradient`; of frequencies from Rayleigh's quotient, dω²/dk = φᵀ (∂K/∂k) φ/(φᵀ M
φ). Residuals are relative: displacements to the largest of their field, frequencies to themselves. A pull
towards the start (`prior`, in units of the residuals) keeps combinations that the data do not determine; the
report names them. fit-modal has Gregory's masses, which remove most of the frequencies' error before a spring
is changed: with tributary masses the fit made cross links fourteen times too stiff in shear, and was 28 % off
in statics.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, Any, ClassVar

import numpy as np

from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.consistent import consistent
from lumped.calibration.report import report
from lumped.fitting.identifiability import Identifiability, identifiability
from lumped.lattice import Grid
from lumped.sensitivity import Differentiable
from lumped.spring_constants import EDGES_OWN, RIMS_OWN
from lumped.vibration import frequency_slopes
from sheetbench.answers.table import PERCENT, Table
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Scene, Sheet
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.objects.grading import Graded

FIXED_CONSTANTS = ("vertical", "layer_distance", "stretch", *EDGES_OWN, *RIMS_OWN)


@dataclass(frozen=True)
class StaticTarget:
    """A scene and its target displacement of the mid-surface at plan points.

    Parameters
    ----------
    scene : Scene
        Scene of the data.
    points : ndarray of shape (n, 2)
        Plan points [m].
    displacement : ndarray of shape (n, 3)
        Target displacement [m].
    """

    prior: ClassVar[float] = 1e-3  # weight of the pull towards the start of a fit

    scene: Scene
    points: np.ndarray
    displacement: np.ndarray

    def compare(self, springs: Calibration, names: list[str]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Return the relative residuals (m,) of springs, and their derivatives (m,) by each constant."""
        scale = np.abs(self.displacement).max() * np.sqrt(len(self.points))
        displacement, slopes = Differentiable(self.scene, springs).at_points(self.points, names)
        slopes = {name: (slope / scale).ravel() for name, slope in slopes.items()}
        return ((displacement - self.displacement) / scale).ravel(), slopes


@dataclass(frozen=True)
class ModalTarget:
    """A scene and its lowest target frequencies.

    Parameters
    ----------
    scene : Scene
        Scene of the data.
    frequencies : ndarray of shape (n,)
        Target frequencies [Hz], rising.
    """

    prior: ClassVar[float] = 1e-1

    scene: Scene
    frequencies: np.ndarray

    def compare(self, springs: Calibration, names: list[str]) -> tuple[np.ndarray, dict[str, np.ndarray]]:
        """Return the relative residuals (n,) of springs, and their derivatives (n,) by each constant."""
        frequencies, rates = frequency_slopes(self.scene, springs, names, len(self.frequencies))
        slopes = {name: rates[name] / self.frequencies for name in names}
        return frequencies / self.frequencies - 1.0, slopes


Target = StaticTarget | ModalTarget


@dataclass(frozen=True)
class FitRow:
    """A spring that was fitted; width: half of its 95 % interval, None if the data do not determine it."""

    spring: str
    share: str
    width: Annotated[float | None, PERCENT(".2f", "±")]


@dataclass(frozen=True, repr=False)
class FittedCalibration(Calibration):
    """A calibration from data. residual: largest relative miss of the targets; identifiability: of the varied
    springs, in their logarithms (area springs: in shares of the diagonal's stiffness)."""

    residual: float = 0.0
    identifiability: Identifiability | None = None

    def document(self) -> dict[str, Any]:
        """Return the document of a calibration, with the springs' 95 % intervals: half widths as shares of
        the spring, of area springs as shares of the diagonal's stiffness."""
        report = self.identifiability
        widths, singular = (report.half_widths, report.singular_values) if report else ({}, np.empty(0))
        fit = {"residual": self.residual, "half_widths": widths, "singular_values": singular}
        return {**super().document(), "fit": fit}

    def tables(self) -> tuple[Table, ...]:
        widths = self.identifiability.half_widths if self.identifiability else {}
        shares = {"area": "of the diagonal", "mid_area": "of the diagonal"}
        finite = {name: width if np.isfinite(width) else None for name, width in widths.items()}
        rows = [FitRow(name, shares.get(name, "of itself"), width) for name, width in finite.items()]
        caption = "Springs and their 95 % intervals from the data"
        return (*super().tables(), Table.of(FitRow, rows, caption, "fit"))

    def notes(self) -> tuple[str, ...]:
        return (f"the targets are matched within {few(100 * self.residual)} %", *super().notes())


def fitted(
    method: str,
    kind: type[Target],
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    targets: Sequence[Target] = (),
    grading: Graded = 0.0,
) -> FittedCalibration:
    """Return springs fitted to targets of one kind, started from springs of `consistent`.

    Raises BadInput without targets, and for targets of another kind.
    """
    from scipy.optimize import least_squares

    if not targets or not all(isinstance(target, kind) for target in targets):
        raise BadInput(f"calibration '{method}' needs targets, all of them {kind.__name__}")
    first = consistent(sheet, material, grid, layer_distance, grading=grading)
    if kind is ModalTarget:
        first = replace(first, masses="gregory")
    nonzero = first.constants.names()
    names = [name for name in nonzero if name.removesuffix("_x").removesuffix("_y") not in FIXED_CONSTANTS]
    start = {name: first.constants.value(name) for name in names}
    signed = {name for name in names if name in ("area", "mid_area")}
    unit = first.constants.value("diagonal")

    def changed(change: Iterable[float]) -> Calibration:
        calibration = first
        for name, x in zip(names, change, strict=True):
            value = start[name] + unit * x if name in signed else start[name] * np.exp(x)
            calibration = calibration.with_constant(name, float(value))
        return calibration

    @lru_cache(maxsize=1)
    def at(change: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
        """Return the relative residuals, and their derivatives by the changes."""
        calibration = changed(change)
        misses, rates = zip(*(target.compare(calibration, names) for target in targets), strict=True)
        slopes = []
        for name in names:
            scale = unit if name in signed else calibration.constants.value(name)
            slopes.append(scale * np.concatenate([of[name] for of in rates]))
        return np.concatenate(misses), np.stack(slopes, axis=1)

    best = least_squares(
        lambda change: np.concatenate([at(tuple(change))[0], kind.prior * change]),
        np.zeros(len(names)),
        jac=lambda change: np.concatenate([at(tuple(change))[1], kind.prior * np.eye(len(change))]),
        xtol=1e-10,
        ftol=1e-10,
        max_nfev=60,
    )
    misses, slopes = at(tuple(best.x))
    intervals = identifiability(names, slopes, misses) if len(misses) > len(names) else None
    warnings = intervals.warnings if intervals else ("too few data for intervals of the springs",)
    grid_cells = each_cell(sheet, material, first.grid, first.grading)
    plain = replace(report(method, grid_cells, changed(best.x).constants, warnings), masses=first.masses)
    return FittedCalibration(**vars(plain), residual=float(np.abs(misses).max()), identifiability=intervals)
