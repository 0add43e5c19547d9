"""Layers of a laminate, from the sheet's lower face up: plies of one material at other angles, or of several.

Classical lamination, symmetric about the mid-surface, so that stretching and bending are apart.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import Field, model_validator

from sheetbench.scenes import orthotropy
from sheetbench.scenes.material import Material
from sheetbench.scenes.orthotropy import Fibres, Ply, in_own_axes
from sheetbench.scenes.quantities import Angle, Density, Length, Modulus, PoissonRatio
from sheetbench.scenes.sheet import Sheet

ROUNDING = 1e-9  # of the thickness


class Layer(Fibres):
    """A ply: thickness, the angle of its fibres, and constants that are not the material's."""

    thickness: Length
    """All of them add up to the sheet's."""
    angle: Angle | None = Field(default=None, kw_only=True)
    """Of its axis 1 from x towards y; the material's unless given."""
    young: Modulus | None = Field(default=None, kw_only=True)
    """Young's modulus of an isotropic layer, with poisson."""
    poisson: PoissonRatio | None = Field(default=None, kw_only=True)
    """Poisson's ratio of an isotropic layer."""
    density: Density | None = Field(default=None, kw_only=True)
    """The material's unless given."""

    @model_validator(mode="after")
    def _of_one_kind(self) -> Layer:
        own = self.own
        if (self.young is None) != (self.poisson is None):
            raise ValueError("young and poisson: an isotropic layer has both")
        if any(key in own for key in (*orthotropy.NEEDED, "shear_13", "shear_23")):
            if self.young is not None:
                raise ValueError(
                    f"young = {self.young:g}: the layer has constants of fibres too; give either"
                )
            if reason := orthotropy.impossible(own):
                raise ValueError(reason.removeprefix(f"{orthotropy.KIND}: "))
        return self

    @property
    def own(self) -> dict[str, Any]:
        """What is its own."""
        given = {name: getattr(self, name) for name in type(self).model_fields if name != "thickness"}
        return {name: value for name, value in given.items() if value is not None}


def plies(layers: tuple[Layer, ...], material: Material) -> tuple[Ply, ...]:
    """Return the plies of a sheet's layers."""
    ends = np.cumsum([0.0, *(layer.thickness for layer in layers)])
    base = Ply.of(material)
    return tuple(
        base._replace(**{**in_own_axes(layer.own), **_angle(layer), "low": low, "high": high})
        for layer, (low, high) in zip(layers, pairwise((ends / ends[-1] - 0.5).tolist()), strict=True)
    )


def _angle(layer: Layer) -> dict[str, float]:
    return {} if layer.angle is None else {"angle": layer.angle}


def misfit(layers: tuple[Layer, ...], sheet: Sheet, material: Material) -> str:
    """Return why layers are not those of a sheet, "" where they are."""
    total = sum(layer.thickness for layer in layers)
    if abs(total - sheet.thickness) > ROUNDING * sheet.thickness:
        return f"thicknesses add up to {total:g} m; the sheet's is {sheet.thickness:g} m"
    if material.law is not None:
        return f"material.law = '{material.law}': layers are of linear material"
    below = plies(layers, material)
    for number, (ply, above) in enumerate(zip(below, below[::-1], strict=True), start=1):
        mirrored = above._replace(low=-above.high, high=-above.low)
        if not np.allclose(ply, mirrored, rtol=1e-9, atol=ROUNDING):
            return (
                f"{number} is not {len(layers) + 1 - number} from the other face: a laminate that is not "
                "symmetric about its middle bends when it is pulled, which no model here has"
            )
    return ""
