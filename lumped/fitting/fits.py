"""Springs fitted to data: fit-static to displacement fields, fit-modal to natural frequencies.

Both start from the springs of `consistent` and vary the logarithms of the spring constants (positive links)
and the area springs as shares of the axial ones; layer distance, kz, the edges' twist and the strain springs
that share the stretching with the axial links, whose sum is what data see, are kept; on a graded grid the
cells' springs of a family grow alike. Gauss–Newton with exact Jacobians: of displacements from
`lumped.sensitivity`; of frequencies from Rayleigh's quotient, dω²/dk = φᵀ (∂K/∂k) φ/(φᵀ M φ). Residuals are
relative: displacements to the largest of their field, frequencies to themselves. A pull towards the start
(PRIOR, in units of the residuals) keeps what the data do not see where it was; the report says which
combinations those are. fit-modal takes Gregory's masses, which have most of the frequencies' error away
before a spring is touched: with tributary masses the fit bought frequencies with cross links fourteen times
too stiff in shear, and was 28 % off in statics.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Annotated, Any

import numpy as np

from lumped.calibration.calibration import Calibration
from lumped.calibration.cell_by_cell import each_cell
from lumped.calibration.consistent import consistent
from lumped.calibration.report import report
from lumped.fitting.identifiability import Identifiability, identifiability
from lumped.lattice import Grid
from lumped.sensitivity import sensitivity
from lumped.spring_constants import EDGES_OWN, RIMS_OWN
from lumped.vibration import frequency_slopes
from sheetbench.answers.table import PERCENT, Table
from sheetbench.errors import BadInput
from sheetbench.scenes import Material, Scene, Sheet
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.objects.grading import Graded

PRIOR = {"fit-static": 1e-3, "fit-modal": 1e-1}
FIXED_CONSTANTS = ("vertical", "layer_distance", "stretch", *EDGES_OWN, *RIMS_OWN)


@dataclass(frozen=True)
class StaticTarget:
    """A scene and the mid-surface displacement (n, 3) [m] wanted at plan points (n, 2) [m]."""

    scene: Scene
    points: np.ndarray
    displacement: np.ndarray


@dataclass(frozen=True)
class ModalTarget:
    """A scene and the lowest natural frequencies (n,) [Hz] wanted of it."""

    scene: Scene
    frequencies: np.ndarray


Target = StaticTarget | ModalTarget


@dataclass(frozen=True)
class FitRow:
    """A spring that was fitted; width: half of its 95 % interval, None where the data do not see it."""

    spring: str
    share: str
    width: Annotated[float | None, PERCENT(".2f", "±")]


@dataclass(frozen=True, repr=False)
class FittedCalibration(Calibration):
    """A calibration from data: residual: largest relative miss of the targets; identifiability: of the
    springs varied, in their logarithms (area springs: in shares of the axial stiffness)."""

    residual: float = 0.0
    identifiability: Identifiability | None = None

    def document(self) -> dict[str, Any]:
        """The document of a calibration, with what the data tell of each spring: half widths of the 95 %
        intervals as shares of the spring, of area springs as shares of the diagonal's stiffness."""
        known = self.identifiability
        fit = {
            "residual": self.residual,
            "half_widths": known.half_widths if known else {},
            "singular_values": known.singular_values if known else [],
        }
        return {**super().document(), "fit": fit}

    def tables(self) -> tuple[Table, ...]:
        known = self.identifiability.half_widths if self.identifiability else {}
        shares = {"area": "of the diagonal", "mid_area": "of the diagonal"}
        rows = [
            FitRow(name, shares.get(name, "of itself"), width if np.isfinite(width) else None)
            for name, width in known.items()
        ]
        caption = "What the data tell of each spring: 95 % intervals"
        return (*super().tables(), Table.of(FitRow, rows, caption, "fit"))

    def notes(self) -> tuple[str, ...]:
        return (f"the targets are matched within {few(100 * self.residual)} %", *super().notes())


def fit_static(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    targets: Sequence[Target] = (),
    grading: Graded = 0.0,
) -> FittedCalibration:
    """Springs whose displacements come nearest to those of the targets (StaticTarget).

    Raises BadInput without targets, and for other kinds of them.
    """

    def compare(target: StaticTarget, calibration: Calibration, names: list[str]) -> Compared:
        scale = np.abs(target.displacement).max() * np.sqrt(len(target.points))
        found = sensitivity(target.scene, calibration, names, target.points)
        slopes = {name: (found.derivatives[name] / scale).ravel() for name in names}
        return ((found.displacement - target.displacement) / scale).ravel(), slopes

    first = consistent(sheet, material, grid, layer_distance, grading=grading)
    return _fit("fit-static", sheet, material, first, _of_kind("fit-static", targets, StaticTarget), compare)


def fit_modal(
    sheet: Sheet,
    material: Material,
    grid: Grid,
    layer_distance: float | None = None,
    targets: Sequence[Target] = (),
) -> FittedCalibration:
    """Springs whose natural frequencies come nearest to those of the targets (ModalTarget), in order.

    Raises BadInput without targets, and for other kinds of them.
    """

    def compare(target: ModalTarget, calibration: Calibration, names: list[str]) -> Compared:
        frequencies, rates = frequency_slopes(target.scene, calibration, names, len(target.frequencies))
        slopes = {name: rates[name] / target.frequencies for name in names}
        return frequencies / target.frequencies - 1.0, slopes

    first = replace(consistent(sheet, material, grid, layer_distance), masses="gregory")
    return _fit("fit-modal", sheet, material, first, _of_kind("fit-modal", targets, ModalTarget), compare)


Compared = tuple[np.ndarray, dict[str, np.ndarray]]  # relative misses, and their derivatives by spring


def _fit(
    method: str,
    sheet: Sheet,
    material: Material,
    first: Calibration,
    targets: Sequence[Any],
    compare: Callable[[Any, Calibration, list[str]], Compared],
) -> FittedCalibration:
    """The fit of `method` to targets, from the springs `first` on."""
    from scipy.optimize import least_squares

    names = [name for name in first.constants.names() if name not in FIXED_CONSTANTS]
    start = {name: first.constants.value(name) for name in names}
    signed = {name for name in names if name in ("area", "mid_area")}
    unit = first.constants.value("diagonal")

    def fitted(change: Iterable[float]) -> Calibration:
        calibration = replace(first, method=method)
        for name, x in zip(names, change, strict=True):
            value = start[name] + unit * x if name in signed else start[name] * np.exp(x)
            calibration = calibration.with_constant(name, float(value))
        return calibration

    @lru_cache(maxsize=1)
    def at(change: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
        """Relative misses, and their derivatives by the changes."""
        calibration = fitted(change)
        compared = [compare(target, calibration, names) for target in targets]
        slopes = []
        for name in names:
            scale = unit if name in signed else calibration.constants.value(name)
            slopes.append(scale * np.concatenate([rates[name] for _, rates in compared]))
        return np.concatenate([misses for misses, _ in compared]), np.stack(slopes, axis=1)

    def residuals(change: np.ndarray) -> np.ndarray:
        return np.concatenate([at(tuple(change))[0], PRIOR[method] * change])

    def slopes_of(change: np.ndarray) -> np.ndarray:
        return np.concatenate([at(tuple(change))[1], PRIOR[method] * np.eye(len(change))])

    best = least_squares(residuals, np.zeros(len(names)), jac=slopes_of, xtol=1e-10, ftol=1e-10, max_nfev=60)
    misses, slopes = at(tuple(best.x))
    each = each_cell(sheet, material, first.grid, first.grading)
    plain = report(method, each, fitted(best.x).constants)
    known = identifiability(names, slopes, misses) if len(misses) > len(names) else None
    return FittedCalibration(
        method,
        first.grid,
        plain.springs,
        plain.moduli,
        (*plain.remarks, *(known.warnings if known else ("too few data for intervals of the springs",))),
        first.masses,
        grading=first.grading,
        residual=float(np.abs(misses).max()),
        identifiability=known,
    )


def _of_kind(method: str, targets: Sequence[Target], kind: type) -> list:
    wanted = [target for target in targets if isinstance(target, kind)]
    if not wanted or len(wanted) != len(targets):
        raise BadInput(f"calibration '{method}' needs targets, all of them {kind.__name__}")
    return wanted
