"""Which sheet another code's numbers are: the table of coefficients read the other way.

The code's parameters, functions of coefficients C, thickness and density (`comparisons.codes.table`), are
solved for these. The cell of the code's mesh then has a membrane A, of which ν = A12/A11 and
E h = A11 (1 − ν²), and its hinges are those of `coefficients.nearest` for one bending stiffness D11 of a
sheet of that ν. An isotropic sheet that has both is h = √(12 D11/A11) thick.
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
QUANTITY = ("quantity", NUMBER("#.5g", "value"), "unit")


@dataclass(frozen=True, repr=False)
class SheetOfCode(Answer):
    """What numbers of a code are as a sheet. given: its parameters; spacing [m]: distance of the nodes;
    membrane: A11 [N/m]; poisson; bending: D11 [N·m], None where nothing given says it; density [kg/m³] and
    area_density [kg/m²], where they are known."""

    code: Code
    given: Mapping[str, float]
    spacing: float | None
    membrane: float
    poisson: float
    bending: float | None
    density: float | None = None
    area_density: float | None = None

    file_name = "sheet"

    @property
    def thickness(self) -> float | None:
        """h [m] of the isotropic sheet that has this membrane and this bending stiffness."""
        return (12.0 * self.bending / self.membrane) ** 0.5 if self.bending else None

    @property
    def young(self) -> float | None:
        """E [Pa] of that sheet."""
        return self.membrane * (1.0 - self.poisson**2) / self.thickness if self.thickness else None

    @property
    def impossible(self) -> str:
        """Why no isotropic sheet has these numbers, "" where one has."""
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

    def heading(self) -> tuple[str, str, str]:
        given = ", ".join(f"{name} = {value:g}" for name, value in self.given.items())
        return f"{self.code.title} as a sheet", given, self.impossible and f"No sheet: {self.impossible}."

    @property
    def quantities(self) -> dict[str, tuple[float, str]]:
        """What is known of the sheet, with units."""
        found = {
            "E": (self.young, "Pa"),
            "ν": (self.poisson, ""),
            "h": (self.thickness, "m"),
            "E h": (self.membrane * (1.0 - self.poisson**2), "N/m"),
            "A11": (self.membrane, "N/m"),
            "D11": (self.bending, "N·m"),
            "ρ": (self.density, "kg/m³"),
            "ρ h": (self.area_density, "kg/m²"),
        }
        return {name: (value, unit) for name, (value, unit) in found.items() if value is not None}

    def tables(self) -> tuple[Table, ...]:
        rows = [(name, *one) for name, one in self.quantities.items()]
        return (Table.listed("The sheet", QUANTITY, rows, "sheet"),)

    def result(self) -> str:
        known = (f"{name} {number(one, '.4g')} {unit}" for name, (one, unit) in self.quantities.items())
        return ", ".join(known) + (f"; no sheet: {self.impossible}" if self.impossible else "")

    def notes(self) -> list[str]:
        notes = [
            "h: of the isotropic sheet with this A11 and D11, E of that h; E h is of the membrane alone."
        ]
        if self.code.hinge and self.bending:
            notes.append("D11: of the sheet whose moduli the hinges come nearest to (docs/cells.md).")
        return notes

    def document(self) -> dict[str, Any]:
        names = ("young", "poisson", "thickness", "membrane", "bending", "density", "area_density")
        sheet = {name: getattr(self, name) for name in names}
        return {"code": self.code.name, "given": dict(self.given), "sheet": sheet, "message": self.impossible}


def sheet_of(
    code: str,
    given: Mapping[str, float],
    *,
    cell: str | None = None,
    spacing: float | None = None,
    density: float | None = None,
) -> SheetOfCode:
    """Return the sheet that a code's numbers are.

    given: parameters of the code by their names; cell: its mesh, the code's own choice unless given, with
    vertices `spacing` [m] apart; density [kg/m³]: where no parameter says it. Raises BadInput for unknown
    names, numbers that contradict each other, and a mesh without a spacing on which the bending depends.
    """
    require_choice("--from", code, CODES)
    row = CODES[code]
    known = [key.name for key in row.keys]
    if unknown := [name for name in given if name not in known]:
        raise BadInput(f"--from {code}: {', '.join(unknown)}: {row.title} has {', '.join(known)}")
    if not given:
        raise BadInput(f"--from {code}: needs its numbers as NAME=VALUE,NAME=VALUE of {', '.join(known)}")
    found = solved(row, given)
    layered, springs = row.mesh == LAYERED and "layers" in found, row.elements == "springs"
    mesh = LAYERED if layered else cell or (FLAT if row.mesh == LAYERED else row.mesh)
    membrane = ("k",) if springs else ("lambda_h", "mu_h")
    if missing := [name for name in membrane if name not in found]:
        raise BadInput(f"--from {code}: what is given leaves {', '.join(missing)} of the membrane open")
    scaled = row.hinge != "height" and ({"hinge", "layers"} & found.keys())
    if scaled and not spacing:
        raise BadInput(f"--from {code}: --spacing: how far apart are the vertices? The bending depends on it")
    size = spacing or 1.0
    if layered:
        moduli = moduli_of(tetrahedral_cell(size, found["layers"]), {"k": found["k"]})
    else:
        shape = triangular_cell(mesh, size) if springs else cell_of(mesh, size, hinge=row.hinge)
        units = {name: found.get(name, 0.0) for name in shape.units()}
        moduli = moduli_of(shape, units)
    stretching = float(moduli.membrane[0, 0])
    poisson = float(moduli.membrane[0, 1]) / stretching
    bending = float(moduli.bending[0, 0]) if layered else None
    if "hinge" in found:  # it is in proportion to the sheet's bending stiffness
        like = Material(1e6, min(poisson, MOST_POISSON), 1e3)
        per = nearest(shape, like, 1e-3, {name: 0.0 for name in membrane})["hinge"]
        bending = found["hinge"] * 1e6 * 1e-9 / 12.0 / (1.0 - like.poisson**2) / per
    elif "thickness" in found and bending is None and row.hinge != "height":
        bending = stretching * found["thickness"] ** 2 / 12.0
    answer = SheetOfCode(row, given, spacing, stretching, poisson, bending)
    rho, areal = found.get("density", density), found.get("areal")
    if areal is None and rho is not None and answer.thickness:
        areal = rho * (found.get("thickness") or answer.thickness)
    elif areal is not None and answer.thickness:
        rho = areal / answer.thickness
    return SheetOfCode(row, given, spacing, stretching, poisson, bending, rho, areal)


NAMES = ("mu_h", "hinge", "thickness", "density", "k", "layers")  # by their logarithms


def solved(code: Code, given: Mapping[str, float]) -> dict[str, float]:
    """Return the coefficients, thickness and density that a code's parameters say, those that they do.

    Unknowns are logarithms, and artanh of λh/(λh + 2 μh), residuals logarithms of parameters over those given
    where both are positive. Where only ρ h is known it is "areal" [kg/m²]. Raises BadInput for numbers that
    no coefficients have.
    """
    keys = [key for key in code.keys if key.name in given]

    def numbers(x: np.ndarray) -> dict[str, float]:
        own = {name: float(np.exp(value)) for name, value in zip(NAMES, x[1:], strict=True)}
        share = float(np.tanh(x[0]))
        return {**own, "lambda_h": 2.0 * own["mu_h"] * share / (1.0 - share)}

    def residuals(x: np.ndarray) -> np.ndarray:
        of = numbers(x)
        scale = of["lambda_h"] + 2.0 * of["mu_h"]
        out = []
        for key in keys:
            value, target = key.value(of), given[key.name]
            if key.unit and value > 0.0 and target > 0.0:
                out.append(np.log(value / target))
            elif key.unit:
                out.append((value - target) / (abs(target) or scale))
            else:
                out.append(value - target)
        return np.array(out)

    limp = {key.name for key in keys if given[key.name] == 0.0 and key.name in BENDS}
    keys = [key for key in keys if key.name not in limp]
    start = np.array([0.3, *np.zeros(len(NAMES))])
    found = least_squares(residuals, start, xtol=1e-15, ftol=1e-15, gtol=1e-15)
    if np.abs(found.fun).max(initial=0.0) > SOLVED:
        told = ", ".join(f"{key.name} = {given[key.name]:g}" for key in keys)
        raise BadInput(f"--from {code.name}: {told}: no isotropic sheet has these in {code.title}")
    _, sizes, directions = np.linalg.svd(found.jac)
    free = directions[np.sum(sizes > UNKNOWN * sizes.max(initial=1.0)) :]
    values, names = numbers(found.x), ("lambda_h", *NAMES)
    known = {
        n: values[n] for n, at in zip(names, free.T, strict=True) if np.abs(at).max(initial=0.0) < UNKNOWN
    }
    areal = np.zeros(len(names))
    areal[[names.index("thickness"), names.index("density")]] = 1.0
    if "density" not in known and np.abs(free @ areal).max(initial=0.0) < UNKNOWN:
        known["areal"] = values["thickness"] * values["density"]
    return known | ({"hinge": 0.0} if limp else {})
