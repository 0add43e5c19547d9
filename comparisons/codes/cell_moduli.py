"""Moduli of a repeated cell compared with a sheet's, the error of its finest mesh, and the corresponding
parameters of codes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isfinite
from typing import Annotated, Any

from comparisons.codes.cell import Cell, cell_of
from comparisons.codes.coefficients import Moduli, best_hinge, limit_errors, moduli_of, nearest
from comparisons.codes.table import CODES, Code, Numbers
from fem_reference.surface.materials import section_of
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import NUMBER, PERCENT, Column, Table, number
from sheetbench.errors import BadInput, NoEquilibrium, require_effect
from sheetbench.scenes import AnyScene, Material, Scene, require_plain, scene_of
from sheetbench.scenes.meaning.words import sheet_in_words


@dataclass(frozen=True)
class Parameter:
    """A parameter of a code, as it is shown."""

    code: str
    name: Annotated[str, Column("parameter")]
    value: Annotated[float, NUMBER(".6g")]
    unit: str
    convention: Annotated[str, Column("meaning in this code", prose=True)]


@dataclass(frozen=True, repr=False)
class CellInScene(Answer):
    """Base of answers about a cell in a scene. coefficients: of the cell; limit_error: of however fine a mesh
    with them, None where the scene has no answer at rest; missing: why that is not known where it should
    be."""

    scene: Scene
    cell: Cell
    coefficients: Mapping[str, float]
    limit_error: float | None
    missing: str

    @property
    def succeeded(self) -> bool:
        """Whether the error in the scene is known or was not requested."""
        return not self.missing

    def complaints(self) -> list[str]:
        return [f"no error in {self.scene.name} is known: {self.missing}"] if self.missing else []


def parameters_of(code: Code, coefficients: Numbers, scene: Scene) -> list[Parameter]:
    """Return the parameters of a code for a scene's sheet."""
    material = scene.material
    damping = {"damping_time": material.dashpot_time, "damping_rate": material.damping_rate}
    numbers = {"thickness": scene.sheet.thickness, "density": material.density, **damping, **coefficients}
    keys = (*code.keys, *(code.dampers if material.dashpot_time else ()))
    return [Parameter(code.title, key.name, key.value(numbers), key.unit, key.convention) for key in keys]


def undamped(code: Code, material: Material) -> str:
    """Return the reason why a material's damping is not among a code's parameters, "" if it is or there is
    none."""
    if material.branches.times:
        return f"{code.title} has no Maxwell branches"
    if material.dashpot_time and not code.dampers:
        return f"{code.title} has no damper in proportion to the stiffness"
    if material.damping_rate and not any(key.name == "rayleighMass" for key in code.dampers):
        return f"{code.title} has no damper in proportion to the mass"
    return ""


UNITS = {"A": "N/m", "D": "N·m", "S": "N/m"}
SPACINGS, MOST = 8, 1e4  # cells along the shorter side, unless a spacing is given; at most
LARGEST_DIFFERENCE = 0.01  # of the sheet's modulus 11
COEFFICIENTS: tuple[Any, ...] = ("coefficient", "unit", NUMBER("#.6g", "value"))


@dataclass(frozen=True)
class ModulusRow:
    """A modulus of the sheet and of the cell, and their difference over the sheet's 11."""

    modulus: str
    unit: str
    sheet: Annotated[float, NUMBER("#.6g")]
    cell: Annotated[float, NUMBER("#.6g")]
    difference: Annotated[float, PERCENT("z.2f")]


@dataclass(frozen=True, repr=False)
class CellModuli(CellInScene):
    """Coefficients of a cell for a scene's sheet, the resulting moduli, and the error of fine meshes in the
    scene.

    Hinges have the coefficient that is best in this scene; nearest: the coefficients whose moduli come
    nearest to the sheet's, and the error that they leave, where that is another."""

    moduli: Moduli
    nearest: tuple[dict[str, float], float] | None = None

    file_name = "cell"

    @property
    def rows(self) -> list[ModulusRow]:
        """The moduli of the sheet and of the cell."""
        section = section_of(self.scene.material, self.scene.sheet.thickness)
        target = Moduli(section.membrane, 0.0 * section.membrane, section.bending, section.shear).named()
        scales = {"A": target["A11"], "D": target["D11"], "S": target["Sx"]}
        return [
            ModulusRow(name, UNITS[name[0]], target[name], value, (value - target[name]) / scales[name[0]])
            for name, value in self.moduli.named().items()
        ]

    def heading(self) -> tuple[str, str, str]:
        size = f"nodes {1e3 * (self.cell.area / len(self.cell.nodes)) ** 0.5:.4g} mm apart"
        sheet = sheet_in_words(self.scene.sheet, self.scene.material)
        return f"cell {self.cell.name}", size, " ".join(filter(None, (f"{sheet}.", self._describe_error())))

    def _describe_error(self) -> str:
        """Return a sentence on the error of the finest mesh in the scene, "" without a scene."""
        if self.limit_error is None:
            return ""
        text = f"In {self.scene.name} even an infinitely fine mesh is {100 * self.limit_error:.1f} % off"
        if self.nearest is None:
            return f"{text}."
        return (
            f"{text} with the coefficients below, {100 * self.nearest[1]:.1f} % with those nearest to the "
            "sheet's moduli."
        )

    def tables(self) -> tuple[Table, ...]:
        units = self.cell.units()
        found, columns = [self.coefficients], COEFFICIENTS
        if self.nearest is not None:
            found, columns = [*found, self.nearest[0]], (*columns, NUMBER("#.6g", "nearest to the moduli"))
        coefficients = [(name, units[name], *(one[name] for one in found)) for name in self.coefficients]
        codes = [
            one
            for code in CODES.values()
            if self.cell.triangles and code.elements == "triangles" and code.hinge == self.cell.hinge
            for one in parameters_of(code, self.coefficients, self.scene)
        ]
        caption = "Parameters of codes with such cells"
        return (
            Table.listed("Coefficients", columns, coefficients, "coefficients"),
            *([Table.of(Parameter, codes, caption, "codes", grouped=True)] if codes else []),
            Table.of(ModulusRow, self.rows, "Moduli of the sheet and of the cell", "moduli"),
        )

    def result(self) -> str:
        return self._describe_error() or super().result()

    def notes(self) -> list[str]:
        rows = (row for row in self.rows if abs(row.difference) > LARGEST_DIFFERENCE)
        missed = [f"{row.modulus} by {number(100 * row.difference, '+.0f')} %" for row in rows]
        notes = ["difference: over the sheet's A11, D11 or S."]
        if missed:
            notes.append(f"These coefficients miss {', '.join(missed)}.")
        if self.limit_error is not None:
            notes.append(
                "Errors in the scene: of the largest displacement, by a shell with the cell's moduli beside "
                "one with the sheet's."
            )
        return notes

    def document(self) -> dict[str, Any]:
        nearest = self.nearest and dict(zip(("coefficients", "limit_error"), self.nearest, strict=True))
        return {
            "cell": self.cell.name,
            "area": self.cell.area,
            "coefficients": self.coefficients,
            "units": self.cell.units(),
            "moduli": [
                {"name": row.modulus, "asked": row.sheet, "got": row.cell, "miss": row.difference}
                for row in self.rows
            ],
            "limit_error": self.limit_error,
            "nearest": nearest,
            "message": self.missing,
        }


def homogenise(
    scene: AnyScene,
    cell: Cell | str,
    *,
    spacing: float | None = None,
    hinge: str | None = None,
    coefficients: Mapping[str, float] | None = None,
) -> CellModuli:
    """Return a cell's coefficients for a scene's sheet, and the moduli that they give: the nearest to the
    sheet's, and of hinges the best in the scene.

    cell: a `Cell`, or a name or a file of a cell with nodes `spacing` [m] from each other, an eighth of the
    shorter side by default, and with the energy of a `hinge`. coefficients: taken in place of the computed
    ones. The answer has no error, and a note, for a scene whose sheet has no stable equilibrium. Raises
    BadInput for a coefficient that the cell does not have, a scene without an answer at rest, and spacing and
    hinge of a cell that has its own."""
    scene, fixed = scene_of(scene), dict(coefficients or {})
    require_plain(scene, "--cell")
    if isinstance(cell, str):
        shorter = min(scene.sheet.lengths)
        if spacing is None and not cell.endswith(".toml"):
            spacing = shorter / SPACINGS
        if spacing is not None and not shorter / MOST <= spacing <= shorter:
            raise BadInput(
                f"--spacing = {spacing:g} m: from {shorter / MOST:g} to {shorter:g}, a side's length"
            )
        cell = cell_of(cell, spacing, scene.sheet.thickness, hinge)
    else:
        require_effect("on a Cell, which has its own", {"spacing": spacing, "hinge": hinge})
    if unknown := set(fixed) - set(cell.units()):
        raise BadInput(f"coefficient {', '.join(sorted(unknown))}: {cell.name} has {', '.join(cell.units())}")
    values = nearest(cell, scene.material, scene.sheet.thickness) | fixed
    if fixed and not moduli_of(cell, values).stable:
        text = ", ".join(f"{name}={value:g}" for name, value in fixed.items())
        raise BadInput(f"--coefficient {text}: a sheet of these cells has a negative stiffness")
    error_left, nearest_values, missing = None, None, ""
    try:
        error_of = limit_errors(scene)
        error_left = error_of(moduli_of(cell, values))
        if not fixed and (best := best_hinge(scene, cell, values)):
            nearest_values, values = (values, error_left), values | {"hinge": best}
            error_left = error_of(moduli_of(cell, values))
    except NoEquilibrium as error:
        error_left, nearest_values, missing = None, None, str(error)
    return CellModuli(scene, cell, values, error_left, missing, moduli_of(cell, values), nearest_values)


def given_coefficients(entries: Sequence[str]) -> dict[str, float]:
    """Return coefficients by name from NAME=VALUE texts. Raises BadInput for an invalid one."""
    given: dict[str, float] = {}
    for entry in entries:
        name, _, value = entry.partition("=")
        try:
            given[name] = float(value)
        except ValueError:
            raise BadInput(f"--coefficient {entry}: NAME=VALUE, the value a number") from None
        if not isfinite(given[name]):
            raise BadInput(f"--coefficient {entry}: not finite")
    return given
