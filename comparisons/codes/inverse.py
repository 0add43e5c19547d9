"""The sheet of another code's parameters: the inverse of the table of coefficients.

Coefficients C, thickness and density follow from the code's parameters, which are functions of them
(`comparisons.codes.table`). The cell of the code's mesh then has a membrane A with ν = A12/A11 and
E h = A11 (1 − ν²), and `coefficients.nearest` has its hinges for one bending stiffness D11 of a sheet of
this ν. An isotropic sheet with both is h = √(12 D11/A11) thick.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from comparisons.codes.cell import cell_of
from comparisons.codes.coefficients import moduli_of, nearest, tetrahedral_cell, triangular_cell
from comparisons.codes.table import CODES, Code
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import NUMBER, Table, number
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Material

LAYERED, FLAT = "tetrahedra", "alternate-diagonals"
SOLVED, UNKNOWN = 1e-9, 1e-6  # of residuals; of a direction that no parameter depends on
BENDS = ("edge_ke", "bendingStiffness", "bending", "bend", "bendingStiffMult")  # 0 where hinges are free
MOST_POISSON = 0.4999  # of an isotropic material
LEAST_SPACING = 5.0  # nodes' distance over the thickness: below it the mesh is no thin sheet's
QUANTITIES = {  # of the sheet: symbol and unit
    **{"young": ("E", "Pa"), "poisson": ("ν", ""), "thickness": ("h", "m"), "stretching": ("E h", "N/m")},
    **{"membrane": ("A11", "N/m"), "bending": ("D11", "N·m"), "density": ("ρ", "kg/m³")},
    "area_density": ("ρ h", "kg/m²"),
}


@dataclass(frozen=True, repr=False)
class SheetOfCode(Answer):
    """The sheet that numbers of a code describe. given: parameters of the code; spacing [m]: distance of the
    nodes; membrane: A11 [N/m]; poisson; stretching: E h [N/m]; bending: D11 [N·m]; thickness: h [m] of the
    isotropic sheet with this membrane and this bending stiffness, young: its E [Pa], density: its ρ [kg/m³];
    area_density: ρ h [kg/m²]. Those from bending on are None where no parameter determines them."""

    code: Code
    given: Mapping[str, float]
    spacing: float | None
    membrane: float
    poisson: float
    stretching: float
    bending: float | None
    thickness: float | None
    young: float | None
    density: float | None
    area_density: float | None

    file_name = "sheet"

    @property
    def impossible(self) -> str:
        """The reason why no isotropic sheet has the coefficients, "" where one has."""
        if self.poisson > MOST_POISSON:
            return f"ν = {self.poisson:.3g}: an isotropic material has ν below 0.5"
        if self.bending is None:
            return "its bending stiffness is not given"
        if not self.bending:
            return "D11 = 0 N·m: a sheet with this membrane has some bending stiffness"
        if self.spacing and self.thickness and self.thickness * LEAST_SPACING > self.spacing:
            return (
                f"D11 = {self.bending:.3g} N·m needs a sheet with this membrane that is not thin, "
                f"{1e3 * self.thickness:.3g} mm, with vertices {1e3 * self.spacing:.3g} mm apart"
            )
        return ""

    def _list(self) -> list[tuple[str, float, str]]:
        known = ((symbol, getattr(self, name), unit) for name, (symbol, unit) in QUANTITIES.items())
        return [one for one in known if one[1] is not None]

    def heading(self) -> tuple[str, str, str]:
        given = ", ".join(f"{name} = {value:g}" for name, value in self.given.items())
        return f"{self.code.title} as a sheet", given, self.impossible and f"No sheet: {self.impossible}."

    def tables(self) -> tuple[Table, ...]:
        columns = ("quantity", NUMBER("#.5g", "value"), "unit")
        return (Table.listed("The sheet", columns, self._list(), "sheet"),)

    def result(self) -> str:
        known = ", ".join(f"{symbol} {number(value, '.4g')} {unit}" for symbol, value, unit in self._list())
        return known + (f"; no sheet: {self.impossible}" if self.impossible else "")

    def notes(self) -> list[str]:
        own = "h: of the isotropic sheet with this A11 and D11; E: for this h; E h: of the membrane alone."
        nearest = "D11: of the sheet whose moduli the hinges come nearest to (docs/cells.md)."
        return [own, *([nearest] if self.code.hinge and self.bending else [])]

    def document(self) -> dict[str, Any]:
        sheet = {name: getattr(self, name) for name in QUANTITIES}
        return {"code": self.code.name, "given": dict(self.given), "sheet": sheet, "message": self.impossible}


def sheet_of(
    code: str,
    given: Mapping[str, float],
    *,
    cell: str | None = None,
    spacing: float | None = None,
    density: float | None = None,
) -> SheetOfCode:
    """Return the sheet that a code's numbers describe.

    given: parameters of the code by their names; cell: the mesh, by default the code's usual one; spacing
    [m]: of its vertices; density [kg/m³]: for codes without a parameter for it. Raises BadInput for unknown
    names, numbers that contradict each other, and a mesh without a spacing on which the bending depends."""
    require_choice("--from", code, CODES)
    row, option = CODES[code], f"--from {code}:"
    parameters = ", ".join(key.name for key in row.keys)
    if unknown := given.keys() - {key.name for key in row.keys}:
        raise BadInput(f"{option} {', '.join(sorted(unknown))}: {row.title} has {parameters}")
    if not given:
        raise BadInput(f"{option} needs its numbers as NAME=VALUE,NAME=VALUE of {parameters}")
    values = solved(row, given)
    layered, springs = row.mesh == LAYERED and "layers" in values, row.elements == "springs"
    mesh = LAYERED if layered else cell or (FLAT if row.mesh == LAYERED else row.mesh)
    membrane = ("k",) if springs else ("lambda_h", "mu_h")
    if missing := [name for name in membrane if name not in values]:
        raise BadInput(f"{option} the numbers do not determine {', '.join(missing)} of the membrane")
    if row.hinge != "height" and {"hinge", "layers"} & values.keys() and not spacing:
        raise BadInput(f"{option} --spacing: the distance of vertices is needed: bending depends on it")
    distance = spacing or 1.0
    if layered:
        shape = tetrahedral_cell(distance, values["layers"])
    else:
        shape = triangular_cell(mesh, distance) if springs else cell_of(mesh, distance, hinge=row.hinge)
    moduli = moduli_of(shape, {name: values.get(name, 0.0) for name in shape.units()})
    a11, poisson = float(moduli.membrane[0, 0]), float(moduli.membrane[0, 1] / moduli.membrane[0, 0])
    bending = float(moduli.bending[0, 0]) if layered else None
    if "hinge" in values:  # it is in proportion to the sheet's bending stiffness
        material = Material(1e6, min(poisson, MOST_POISSON), 1e3)
        unit_hinge = nearest(shape, material, 1e-3, dict.fromkeys(membrane, 0.0))["hinge"]
        bending = values["hinge"] * 1e6 * 1e-9 / 12.0 / (1.0 - material.poisson**2) / unit_hinge
    elif "thickness" in values and not layered and row.hinge != "height":
        bending = a11 * values["thickness"] ** 2 / 12.0
    thickness = (12.0 * bending / a11) ** 0.5 if bending else None
    stretching = a11 * (1.0 - poisson**2)
    young = stretching / thickness if thickness else None
    areal, rho = values.get("areal"), values.get("density", density)
    if areal is None and rho is not None and "thickness" in values:
        areal = rho * values["thickness"]
    if areal and thickness:
        rho = areal / thickness
    elif areal is None and rho and thickness:
        areal = rho * thickness
    found = poisson, stretching, bending, thickness, young, rho, areal
    return SheetOfCode(row, given, spacing, a11, *found)


NAMES = ("lambda_h", "mu_h", "hinge", "thickness", "density", "k", "layers")


def solved(code: Code, given: Mapping[str, float]) -> dict[str, float]:
    """Return the coefficients, thickness and density that a code's parameters determine.

    Unknowns are logarithms, and artanh of λh/(λh + 2 μh); residuals are logarithms of parameters over given
    values where both are positive. If ρ h alone is known, it is "areal" [kg/m²]. Raises BadInput for numbers
    that no coefficients have."""
    no_bending = {name for name in given if given[name] == 0.0 and name in BENDS}
    keys = [key for key in code.keys if key.name in given.keys() - no_bending]

    def numbers(x: np.ndarray) -> dict[str, float]:
        share, exponentials = np.tanh(x[0]), np.exp(x[1:])
        values = (2.0 * exponentials[0] * share / (1.0 - share), *exponentials)
        return dict(zip(NAMES, map(float, values), strict=True))

    def residuals(x: np.ndarray) -> np.ndarray:
        coefficients, differences = numbers(x), []
        for key in keys:
            value, target = key.value(coefficients), given[key.name]
            relative = key.unit and value > 0.0 and target > 0.0
            scale = abs(target) or coefficients["lambda_h"] + 2.0 * coefficients["mu_h"] if key.unit else 1.0
            differences.append(np.log(value / target) if relative else (value - target) / scale)
        return np.array(differences)

    start = np.array([0.3, *np.zeros(len(NAMES) - 1)])
    solution = least_squares(residuals, start, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    if np.abs(solution.fun).max(initial=0.0) > SOLVED:
        text = ", ".join(f"{key.name} = {given[key.name]:g}" for key in keys)
        raise BadInput(f"--from {code.name}: {text}: no isotropic sheet has these in {code.title}")
    _, sizes, directions = np.linalg.svd(solution.jac)
    free = directions[np.sum(sizes > UNKNOWN * sizes.max(initial=1.0)) :]
    changes = dict(zip(NAMES, np.abs(free).max(axis=0, initial=0.0), strict=True))
    determined = {name: value for name, value in numbers(solution.x).items() if changes[name] < UNKNOWN}
    joint_changes = free[:, [NAMES.index("thickness"), NAMES.index("density")]].sum(axis=1)
    if "density" not in determined and np.abs(joint_changes).max(initial=0.0) < UNKNOWN:
        coefficients = numbers(solution.x)
        determined["areal"] = coefficients["thickness"] * coefficients["density"]
    return determined | ({"hinge": 0.0} if no_bending else {})
