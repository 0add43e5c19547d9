"""A code's parameters for a scene's sheet, as they are shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from comparisons.codes.table import CODES, Code, Numbers
from sheetbench.answers.table import Column
from sheetbench.scenes import Material, Scene


@dataclass(frozen=True)
class Parameter:
    """A parameter of a code, as it is shown."""

    code: str
    parameter: str
    value: Annotated[float, Column("value", form=".6g")]
    unit: str
    convention: Annotated[str, Column("meaning in this code", prose=True)]


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
