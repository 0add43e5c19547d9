"""Which sheet another code's numbers are: the table of coefficients read the other way.

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
SLENDER = 5.0  # nodes' distance over the thickness: below it the mesh is no thin sheet's
QUANTITIES = {  # of the sheet: symbol and unit
    **{"young": ("E", "Pa"), "poisson": ("ν", ""), "thickness": ("h", "m"), "stretching": ("E h", "N/m")},
    **{"membrane": ("A11", "N/m"), "bending": ("D11", "N·m"), "density": ("ρ", "kg/m³")},
    "area_density": ("ρ h", "kg/m²"),
}


@dataclass(frozen=True, repr=False)
class SheetOfCode(Answer):
    """The sheet that numbers of a code describe. given: parameters of the code; spacing [m]: distance of the
    nodes; membrane: A11 [N/m]; poisson; bending: D11 [N·m]; areal: ρ h [kg/m²]; rho: ρ [kg/m³]. The last
    three are None where no parameter determines them."""

    code: Code
    given: Mapping[str, float]
    spacing: float | None
    membrane: float
    poisson: float
    bending: float | None
    areal: float | None = None
    rho: float | None = None

    file_name = "sheet"

    @property
    def thickness(self) -> float | None:
        """h [m] of the isotropic sheet that has this membrane and this bending stiffness."""
        return (12.0 * self.bending / self.membrane) ** 0.5 if self.bending else None

    @property
    def stretching(self) -> float:
        """E h [N/m]."""
        return self.membrane * (1.0 - self.poisson**2)

    @property
    def young(self) -> float | None:
        """E [Pa] of that sheet."""
        return self.stretching / self.thickness if self.thickness else None

    @property
    def density(self) -> float | None:
        """ρ [kg/m³] of that sheet."""
        return self.areal / self.thickness if self.areal and self.thickness else self.rho

    @property
    def area_density(self) -> float | None:
        """ρ h [kg/m²] of that sheet."""
        return self.rho * self.thickness if self.areal is None and self.rho and self.thickness else self.areal

    @property
    def impossible(self) -> str:
        """The reason why no isotropic sheet has the coefficients, "" where one has."""
        if self.poisson > MOST_POISSON:
            return f"ν = {self.poisson:.3g} is of no isotropic material, whose ν is below 0.5"
        if self.bending is None:
            return "nothing given says how it bends"
        if not self.bending:
            return "D11 = 0 N·m: a sheet with this membrane has some bending stiffness"
        if self.spacing and self.thickness and self.thickness * SLENDER > self.spacing:
            return (
                f"D11 = {self.bending:.3g} N·m is of no thin sheet with this membrane: of one "
                f"{1e3 * self.thickness:.3g} mm thick, with vertices {1e3 * self.spacing:.3g} mm apart"
            )
        return ""

    def _known(self) -> list[tuple[str, float, str]]:
        known = ((symbol, getattr(self, name), unit) for name, (symbol, unit) in QUANTITIES.items())
        return [one for one in known if one[1] is not None]

    def heading(self) -> tuple[str, str, str]:
        given = ", ".join(f"{name} = {value:g}" for name, value in self.given.items())
        return f"{self.code.title} as a sheet", given, self.impossible and f"No sheet: {self.impossible}."

    def tables(self) -> tuple[Table, ...]:
        columns = ("quantity", NUMBER("#.5g", "value"), "unit")
        return (Table.listed("The sheet", columns, self._known(), "sheet"),)

    def result(self) -> str:
        known = ", ".join(f"{symbol} {number(value, '.4g')} {unit}" for symbol, value, unit in self._known())
        return known + (f"; no sheet: {self.impossible}" if self.impossible else "")

    def notes(self) -> list[str]:
        own = "h: of the isotropic sheet with this A11 and D11, E of that h; E h is of the membrane alone."
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
    row, asked = CODES[code], f"--from {code}:"
    known = ", ".join(key.name for key in row.keys)
    if unknown := given.keys() - {key.name for key in row.keys}:
        raise BadInput(f"{asked} {', '.join(sorted(unknown))}: {row.title} has {known}")
    if not given:
        raise BadInput(f"{asked} needs its numbers as NAME=VALUE,NAME=VALUE of {known}")
    found = solved(row, given)
    layered, springs = row.mesh == LAYERED and "layers" in found, row.elements == "springs"
    mesh = LAYERED if layered else cell or (FLAT if row.mesh == LAYERED else row.mesh)
    membrane = ("k",) if springs else ("lambda_h", "mu_h")
    if missing := [name for name in membrane if name not in found]:
        raise BadInput(f"{asked} what is given leaves {', '.join(missing)} of the membrane open")
    if row.hinge != "height" and {"hinge", "layers"} & found.keys() and not spacing:
        raise BadInput(f"{asked} --spacing: how far apart are the vertices? The bending depends on it")
    size = spacing or 1.0
    if layered:
        shape = tetrahedral_cell(size, found["layers"])
    else:
        shape = triangular_cell(mesh, size) if springs else cell_of(mesh, size, hinge=row.hinge)
    moduli = moduli_of(shape, {name: found.get(name, 0.0) for name in shape.units()})
    stretching, mixed = map(float, moduli.membrane[0, :2])
    bending = float(moduli.bending[0, 0]) if layered else None
    if "hinge" in found:  # it is in proportion to the sheet's bending stiffness
        like = Material(1e6, min(mixed / stretching, MOST_POISSON), 1e3)
        per = nearest(shape, like, 1e-3, dict.fromkeys(membrane, 0.0))["hinge"]
        bending = found["hinge"] * 1e6 * 1e-9 / 12.0 / (1.0 - like.poisson**2) / per
    elif "thickness" in found and not layered and row.hinge != "height":
        bending = stretching * found["thickness"] ** 2 / 12.0
    areal, rho = found.get("areal"), found.get("density", density)
    if areal is None and rho is not None and "thickness" in found:
        areal = rho * found["thickness"]
    return SheetOfCode(row, given, spacing, stretching, mixed / stretching, bending, areal, rho)


NAMES = ("lambda_h", "mu_h", "hinge", "thickness", "density", "k", "layers")


def solved(code: Code, given: Mapping[str, float]) -> dict[str, float]:
    """Return the coefficients, thickness and density that a code's parameters determine.

    Unknowns are logarithms, and artanh of λh/(λh + 2 μh); residuals are logarithms of parameters over given
    values where both are positive. If ρ h alone is known, it is "areal" [kg/m²]. Raises BadInput for numbers
    that no coefficients have."""
    limp = {name for name in given if given[name] == 0.0 and name in BENDS}
    keys = [key for key in code.keys if key.name in given.keys() - limp]

    def numbers(x: np.ndarray) -> dict[str, float]:
        share, own = np.tanh(x[0]), np.exp(x[1:])
        values = (2.0 * own[0] * share / (1.0 - share), *own)
        return dict(zip(NAMES, map(float, values), strict=True))

    def residuals(x: np.ndarray) -> np.ndarray:
        of, out = numbers(x), []
        for key in keys:
            value, target = key.value(of), given[key.name]
            relative = key.unit and value > 0.0 and target > 0.0
            scale = abs(target) or of["lambda_h"] + 2.0 * of["mu_h"] if key.unit else 1.0
            out.append(np.log(value / target) if relative else (value - target) / scale)
        return np.array(out)

    start = np.array([0.3, *np.zeros(len(NAMES) - 1)])
    found = least_squares(residuals, start, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    if np.abs(found.fun).max(initial=0.0) > SOLVED:
        told = ", ".join(f"{key.name} = {given[key.name]:g}" for key in keys)
        raise BadInput(f"--from {code.name}: {told}: no isotropic sheet has these in {code.title}")
    _, sizes, directions = np.linalg.svd(found.jac)
    free = directions[np.sum(sizes > UNKNOWN * sizes.max(initial=1.0)) :]
    moves = dict(zip(NAMES, np.abs(free).max(axis=0, initial=0.0), strict=True))
    known = {name: value for name, value in numbers(found.x).items() if moves[name] < UNKNOWN}
    both = free[:, [NAMES.index("thickness"), NAMES.index("density")]].sum(axis=1)
    if "density" not in known and np.abs(both).max(initial=0.0) < UNKNOWN:
        of = numbers(found.x)
        known["areal"] = of["thickness"] * of["density"]
    return known | ({"hinge": 0.0} if limp else {})
