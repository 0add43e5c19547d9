"""A tensile test as it was measured: stretch and engineering stress of a loading branch.

stress: engineering P = force/undeformed area, or true σ = P λ of an incompressible sheet
strain: engineering λ − 1, or true ln λ; or the displacement of the grips over the gauge length
test: uniaxial, pure-shear (a wide strip held along its width) or equibiaxial; Abaqus calls the latter two
    planar and biaxial

A curve may be of tension, of compression (stretch below 1) or of both.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from comparisons.identification.columns import Columns, read_columns
from sheetbench.errors import BadInput, require_choice

TESTS = ("uniaxial", "pure-shear", "equibiaxial")
NAMES = dict(zip(TESTS, TESTS, strict=True)) | {"planar": "pure-shear", "biaxial": "equibiaxial"}
ENGINEERING, TRUE = ("engineering_stress", "nominal_stress"), ("true_stress", "cauchy_stress")
STRETCH: dict[str, Callable[[np.ndarray], np.ndarray]] = {  # of a column's numbers
    "stretch": np.asarray,
    "engineering_strain": lambda e: 1.0 + e,
    "strain": lambda e: 1.0 + e,
    "true_strain": np.exp,
}
LENGTHS = ("displacement", "extension")  # and of these over the gauge
UNITS = dict.fromkeys(STRETCH, "") | dict.fromkeys(LENGTHS, "m") | {"force": "N", "stress": "Pa"}
UNITS |= dict.fromkeys((*ENGINEERING, *TRUE), "Pa")
FEWEST = 3  # rows: of one constant with two degrees of freedom left
BACK = 0.005  # of the range of stretch, that it may go back by noise
BROKEN = 0.8  # of the largest stress, below which a sheet has torn
LARGEST_STRETCH = 25.0
SOFTEST = 1e3  # Pa


@dataclass(frozen=True)
class Curve:
    """A curve of stretch (n,) and engineering stress (n,) [Pa]; file: its source."""

    test: str
    stretch: np.ndarray
    stress: np.ndarray
    file: str = ""


def read(
    text: str, area: float | None = None, up_to: float | None = None, gauge: float | None = None
) -> Curve:
    """Return the curve of `FILE`, uniaxial, or `TEST=FILE`; area [m²]: undeformed cross-section, where forces
    were measured; gauge [m]: undeformed length, where displacements were; up_to: the largest stretch to take.
    Raises BadInput naming file, line and remedy."""
    test, equals, name = text.partition("=")
    if not equals or (test not in NAMES and Path(text).is_file()):
        test, name = "uniaxial", text
    require_choice("test", test, NAMES)
    path = Path(name)
    columns = read_columns(path, UNITS)
    stretch, stress = _read_stretch(path, columns, gauge), _read_stress(path, columns, area)
    if any(column in columns.names for column in TRUE) and not set(ENGINEERING) & set(columns.names):
        stress = stress / stretch
    if up_to is not None:
        if up_to <= 1.0:
            raise BadInput(f"--up-to = {up_to:g}: a stretch, above 1; a strain of 50 % is a stretch of 1.5")
        stretch, stress = stretch[stretch <= up_to], stress[stretch <= up_to]
    curve = Curve(NAMES[test], stretch, stress, str(path))
    require_loading(curve, columns)
    return curve


def require_loading(curve: Curve, columns: Columns | None = None) -> None:
    """Raise BadInput unless the curve is one branch of loading, in SI units."""
    name, stretch, stress = curve.file or "tensile test", curve.stretch, curve.stress
    require_choice("test", curve.test, TESTS)
    if len(stretch) < FEWEST:
        raise BadInput(f"{name}: {len(stretch)} rows; at least {FEWEST}")
    if stretch.max() > LARGEST_STRETCH:
        raise BadInput(
            f"{name}: stretched to {stretch.max():g}: per cent? strains are fractions, or write the unit: "
            "strain [%]"
        )
    if stretch.min() <= 0.0:
        raise BadInput(
            f"{name}: stretch = {stretch.min():g}: must be greater than 0; of strains write strain"
        )
    direction = np.sign(stretch[np.argmax(np.abs(stretch - stretch[0]))] - stretch[0])
    reached = np.maximum.accumulate(direction * stretch)
    reversed_rows = reached - direction * stretch > BACK * np.ptp(stretch)
    if reversed_rows.any():
        row = int(np.argmax(reversed_rows))
        line = columns.rows[row].where if columns is not None else f"{name}, row {row + 1}"
        raise BadInput(
            f"{line}: stretch goes back to {stretch[row]:.4g}: an unloading branch; keep one loading"
        )
    tension = np.sign(stretch - 1.0) * stress
    if tension.max() <= 0.0 or tension.min() < -0.05 * tension.max():
        raise BadInput(
            f"{name}: stress {stress.min():g} to {stress.max():g} Pa: tension is > 0, compression < 0"
        )
    remedies = {1.0: "Leave that out by --up-to", -1.0: "Leave out the rows below"}
    for side, remedy in remedies.items():
        strain = side * (stretch - 1.0)
        side_pull = np.where(strain > 0.0, tension, 0.0)
        if side_pull[np.argmax(strain)] < BROKEN * side_pull.max():
            peak = stretch[np.argmax(side_pull)]
            raise BadInput(f"{name}: the stress falls after stretch {peak:.4g}: torn? {remedy} {peak:.4g}")
    if tension.max() < SOFTEST * np.abs(stretch - 1.0).max():
        raise BadInput(
            f"{name}: at most {tension.max():g} Pa, softer than any solid sheet: write the stress's unit in "
            "the header, as engineering_stress [MPa]"
        )


def _read_stretch(path: Path, columns: Columns, gauge: float | None) -> np.ndarray:
    column = next((name for name in (*STRETCH, *LENGTHS) if name in columns.names), None)
    if column is None:
        names = ", ".join(filter(None, columns.names)) or "none"
        raise BadInput(f"{path}: columns {names}; needed is stretch, strain, true_strain or displacement")
    if column in STRETCH:
        return STRETCH[column](columns.numbers(column))
    if gauge is None:
        raise BadInput(f"{path}: {column}: give the undeformed length between the grips, --gauge 33mm")
    return 1.0 + columns.numbers(column) / gauge


def _read_stress(path: Path, columns: Columns, area: float | None) -> np.ndarray:
    present = [name for name in (*ENGINEERING, *TRUE, "force") if name in columns.names]
    if not present and "stress" in columns.names:
        raise BadInput(
            f"{path}: stress: engineering or true? name the column engineering_stress or true_stress"
        )
    if not present:
        raise BadInput(f"{path}: needed is engineering_stress, true_stress or force")
    values = columns.numbers(present[0])
    if present[0] != "force":
        return values
    if area is None:
        raise BadInput(f"{path}: force: give the undeformed cross-section, --area 18mm²")
    return values / area
