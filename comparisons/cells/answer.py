"""What a cell is as a sheet: coefficients, moduli beside the sheet's, the error that stays."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from comparisons.cells.cell import Cell
from comparisons.cells.codes import Parameter, parameters
from comparisons.cells.coefficients import best_hinge, limit_error, nearest
from comparisons.cells.homogenise import Moduli, moduli_of
from fem_reference.surface.materials import section_of
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import Column, Table, number
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene, Scene, require_plain, scene_of
from sheetbench.scenes.words import sheet_in_words

UNITS = {"A": "N/m", "D": "N·m", "S": "N/m"}
MISSED = 0.01  # of the sheet's modulus 11


@dataclass(frozen=True)
class Coefficient:
    """A coefficient of the cell's elements [SI]."""

    coefficient: str
    unit: str
    value: Annotated[float, Column("value", form="#.6g")]


@dataclass(frozen=True)
class Modulus:
    """A modulus of the sheet and of the cell, and their difference over the sheet's 11 of the same kind."""

    modulus: str
    unit: str
    sheet: Annotated[float, Column("sheet", form="#.6g")]
    cell: Annotated[float, Column("cell", form="#.6g")]
    miss: Annotated[float, Column("off by", "", "%", 100.0, "z.2f")]


@dataclass(frozen=True, repr=False)
class CellModuli(Answer):
    """A cell's coefficients for a scene's sheet, the moduli they give, and the error of fine meshes there.

    best_hinge: the hinges' coefficient that is best in this scene alone, and the error that it leaves; None
    where there is none, or where coefficients were given.
    """

    cell: Cell
    scene: Scene
    coefficients: dict[str, float]
    moduli: Moduli
    limit_error: float
    best_hinge: tuple[float, float] | None = None

    file_name = "cell"

    @property
    def rows(self) -> list[Modulus]:
        """The moduli of the sheet and of the cell."""
        own = section_of(self.scene.material, self.scene.sheet.thickness)
        target = Moduli(own.membrane, 0.0 * own.membrane, own.bending, own.shear).named()
        scales = {"A": target["A11"], "D": target["D11"], "S": target["Sx"]}
        return [
            Modulus(name, UNITS[name[0]], target[name], got, (got - target[name]) / scales[name[0]])
            for name, got in self.moduli.named().items()
        ]

    def heading(self) -> tuple[str, str, str]:
        size = f"nodes {1e3 * (self.cell.area / len(self.cell.nodes)) ** 0.5:.4g} mm apart"
        return f"cell {self.cell.name}", size, sheet_in_words(self.scene.sheet, self.scene.material)

    def tables(self) -> tuple[Table, ...]:
        units = self.cell.units()
        coefficients = [Coefficient(name, units[name], value) for name, value in self.coefficients.items()]
        codes = parameters(self.cell.hinge, self.coefficients, self.scene) if self.cell.triangles else []
        caption = "Parameters of codes with such cells"
        return (
            Table.of(Coefficient, coefficients, "Coefficients", "coefficients"),
            *([Table.of(Parameter, codes, caption, "codes", grouped=True)] if codes else []),
            Table.of(Modulus, self.rows, "Moduli of the sheet and of the cell", "moduli"),
        )

    def notes(self) -> list[str]:
        missed = [
            f"{row.modulus} by {number(100 * row.miss, '+.0f')} %"
            for row in self.rows
            if abs(row.miss) > MISSED
        ]
        notes = ["off by: difference over the sheet's A11, D11 or S."]
        if missed:
            notes.append(f"These coefficients miss {', '.join(missed)}.")
        notes.append(
            f"Error of an infinitely fine mesh with them in this scene: {100 * self.limit_error:.1f} % of "
            "the largest displacement, from a shell with the cell's moduli."
        )
        if self.best_hinge is not None:
            value, error = self.best_hinge
            unit = self.cell.units()["hinge"]
            notes.append(f"Least error in this scene: {100 * error:.1f} % with hinge = {value:.4g} {unit}.")
        return notes

    def document(self) -> dict[str, Any]:
        best = self.best_hinge and dict(zip(("value", "error"), self.best_hinge, strict=True))
        return {
            "cell": self.cell.name,
            "area": self.cell.area,
            "coefficients": self.coefficients,
            "units": self.cell.units(),
            "moduli": [
                {"name": r.modulus, "asked": r.sheet, "got": r.cell, "miss": r.miss} for r in self.rows
            ],
            "limit_error": self.limit_error,
            "best_hinge": best,
        }


def homogenise(scene: AnyScene, cell: Cell, given: Mapping[str, float] | None = None) -> CellModuli:
    """Return a cell's coefficients for a scene's sheet, those nearest to its moduli, and what they give.

    given: coefficients to be taken instead. Raises BadInput for one that the cell does not have, and for a
    scene without an answer at rest.
    """
    scene, given = scene_of(scene), dict(given or {})
    require_plain(scene, "homogenise")
    if unknown := set(given) - set(cell.units()):
        raise BadInput(f"coefficient {', '.join(sorted(unknown))}: {cell.name} has {', '.join(cell.units())}")
    coefficients = nearest(cell, scene.material, scene.sheet.thickness) | given
    moduli = moduli_of(cell, coefficients)
    best = None if given else best_hinge(scene, cell, coefficients)
    return CellModuli(cell, scene, coefficients, moduli, limit_error(scene, moduli), best)
