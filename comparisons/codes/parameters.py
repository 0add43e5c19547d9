"""A code's parameters for a scene's sheet, and the base of answers about a cell in a scene."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from comparisons.codes.cell import Cell
from comparisons.codes.table import CODES, Code, Numbers
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import NUMBER, Column
from sheetbench.scenes import Material, Scene


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
        """Whether the error in the scene is known, or needs not be."""
        return not self.missing

    def complaints(self) -> list[str]:
        return [f"no error in {self.scene.name} is known: {self.missing}"] if self.missing else []


def parameters(hinge: str, coefficients: Numbers, scene: Scene) -> list[Parameter]:
    """The parameters of the codes of triangles whose hinges have this weight."""
    return [
        one
        for code in CODES.values()
        if code.hinge == hinge and code.elements == "triangles"
        for one in parameters_of(code, coefficients, scene)
    ]


def parameters_of(code: Code, coefficients: Numbers, scene: Scene) -> list[Parameter]:
    """The parameters of a code for a scene's sheet."""
    material = scene.material
    damping = {"damping_time": material.dashpot_time, "damping_rate": material.damping_rate}
    numbers = {"thickness": scene.sheet.thickness, "density": material.density, **damping, **coefficients}
    keys = (*code.keys, *(code.dampers if material.dashpot_time else ()))
    return [Parameter(code.title, key.name, key.value(numbers), key.unit, key.convention) for key in keys]


def undamped(code: Code, material: Material) -> str:
    """Why a material's damping is not among a code's parameters, or "" where it is, or there is none."""
    if material.branches.times:
        return f"{code.title} has no Maxwell branches"
    if material.dashpot_time and not code.dampers:
        return f"{code.title} has no damper in proportion to the stiffness"
    if material.damping_rate and not any(key.name == "rayleighMass" for key in code.dampers):
        return f"{code.title} has no damper in proportion to the mass"
    return ""
