"""Layers of a laminate, from the sheet's lower face up: plies of one material at other angles, or of several.

Classical lamination: N = A ε + B κ and M = B ε + D κ of strains and curvatures of the mid-surface, on which
supports, loads and probes are. Layers that are not symmetric about it have a B: they bend when pulled.
"""

from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np
from pydantic import Field

from sheetbench.scenes.objects.material import Material
from sheetbench.scenes.objects.orthotropy import NEEDED, Fibres, Ply, impossible, in_own_axes
from sheetbench.scenes.objects.quantities import Angle, Density, Length, Modulus, PoissonRatio
from sheetbench.scenes.objects.sheet import Sheet

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

    def _faults(self) -> Iterator[object]:
        own = self.own
        yield ("young" in own) != ("poisson" in own) and "young and poisson: an isotropic layer has both"
        if {*NEEDED, "shear_13", "shear_23"} & own.keys():
            yield self.young and f"young = {self.young:g}: the layer has constants of fibres too; give either"
            yield impossible(own)

    @property
    def own(self) -> dict[str, Any]:
        """What is its own."""
        return self.given(name for name in type(self).model_fields if name != "thickness")


def plies(layers: tuple[Layer, ...], material: Material) -> tuple[Ply, ...]:
    """Return the plies of a sheet's layers, at heights from its middle."""
    ends, base = np.cumsum([0.0, *(layer.thickness for layer in layers)]), material.ply
    within = zip(layers, pairwise((ends / ends[-1] - 0.5).tolist()), strict=True)
    return tuple(base._replace(low=a, high=b, **in_own_axes(layer.own)) for layer, (a, b) in within)


def plane_stress(ply: Ply) -> np.ndarray:
    """Return the stress (3, 3) [Pa] over (xx, yy, xy) of strains (xx, yy, 2xy) where nothing pulls along z:
    the inverse of its compliance, turned."""
    c, s = np.cos(ply.angle), np.sin(ply.angle)
    turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
    mixed = -ply.poisson_12 / ply.young_1
    soft = np.array([[1.0 / ply.young_1, mixed, 0.0], [mixed, 1.0 / ply.young_2, 0.0]])
    soft = np.vstack([soft, [0.0, 0.0, 1.0 / ply.shear_12]])
    return np.asarray(turn.T @ np.linalg.inv(soft) @ turn)


def resultants(found: tuple[Ply, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return A [Pa], B and D [Pa] of plies per thickness, its square and its cube, (3, 3) each."""
    return moments(found, [plane_stress(ply) for ply in found])


def moments(found: tuple[Ply, ...], values: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ∫ f dz, ∫ f z dz and ∫ f z² dz of values f of plies, over the thickness as 1."""
    powers = np.array([[(p.high**n - p.low**n) / n for p in found] for n in (1, 2, 3)])
    first, second, third = np.tensordot(powers, np.array(values), 1)
    return first, second, third


def bends_when_pulled(found: tuple[Ply, ...]) -> bool:
    """Return whether plies have a B: they are not symmetric about the middle."""
    stretching, mixed, _ = resultants(found)
    return bool(np.abs(mixed).max() > ROUNDING * np.abs(stretching).max())


def misfit(layers: tuple[Layer, ...], sheet: Sheet, material: Material) -> str:
    """Return why layers are not those of a sheet, "" where they are."""
    total = sum(layer.thickness for layer in layers)
    if abs(total - sheet.thickness) > ROUNDING * sheet.thickness:
        return f"layer: thicknesses add up to {total:g} m; the sheet's is {sheet.thickness:g} m"
    if material.law is not None:
        return f"layer: material.law = '{material.law}': layers are of linear material"
    return ""
