"""Layers of a laminate, from the sheet's lower face up: plies of one material at other angles, or of several.

Classical lamination: N = A ε + B κ and M = B ε + D κ with strains ε and curvatures κ of the mid-surface, on
which supports, loads and probes are. Layers not symmetric about it have B ≠ 0: they bend when pulled.
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
    """Thickness; all layers' add up to the sheet's."""
    angle: Angle | None = Field(default=None, kw_only=True)
    """Angle of its axis 1 from x towards y; the material's unless given."""
    young: Modulus | None = Field(default=None, kw_only=True)
    """Young's modulus of an isotropic layer, with poisson."""
    poisson: PoissonRatio | None = Field(default=None, kw_only=True)
    """Poisson's ratio of an isotropic layer."""
    density: Density | None = Field(default=None, kw_only=True)
    """Density; the material's unless given."""

    def _faults(self) -> Iterator[object]:
        own = self.own
        yield ("young" in own) != ("poisson" in own) and "young and poisson: an isotropic layer has both"
        if {*NEEDED, "shear_13", "shear_23"} & own.keys():
            yield self.young and f"young = {self.young:g}: the layer has constants of fibres too; give either"
            yield impossible(own)

    @property
    def own(self) -> dict[str, Any]:
        """Return the constants that the layer gives itself."""
        return self.given(name for name in type(self).model_fields if name != "thickness")


def plies(layers: tuple[Layer, ...], material: Material) -> tuple[Ply, ...]:
    """Return the plies of a sheet's layers, with heights from its middle over its thickness."""
    ends, base = np.cumsum([0.0, *(layer.thickness for layer in layers)]), material.ply
    heights = zip(layers, pairwise((ends / ends[-1] - 0.5).tolist()), strict=True)
    return tuple(base._replace(low=a, high=b, **in_own_axes(layer.own)) for layer, (a, b) in heights)


def plane_stress(ply: Ply) -> np.ndarray:
    """Return a ply's plane-stress stiffness (3, 3) [Pa]: stresses (xx, yy, xy) of strains (xx, yy, 2xy). It
    is the inverse of the compliance in the ply's axes, turned."""
    c, s = np.cos(ply.angle), np.sin(ply.angle)
    turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
    mixed = -ply.poisson_12 / ply.young_1
    soft = np.array([[1.0 / ply.young_1, mixed, 0.0], [mixed, 1.0 / ply.young_2, 0.0]])
    soft = np.vstack([soft, [0.0, 0.0, 1.0 / ply.shear_12]])
    return np.asarray(turn.T @ np.linalg.inv(soft) @ turn)


def resultants(plies: tuple[Ply, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return A/h, B/h² and D/h³ [Pa] of plies, (3, 3) each, with h the thickness."""
    return moments(plies, [plane_stress(ply) for ply in plies])


def moments(plies: tuple[Ply, ...], values: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return ∫ f dz, ∫ f z dz and ∫ f z² dz of values f of plies, with z over the thickness."""
    powers = np.array([[(p.high**n - p.low**n) / n for p in plies] for n in (1, 2, 3)])
    first, second, third = np.tensordot(powers, np.array(values), 1)
    return first, second, third


def bends_when_pulled(plies: tuple[Ply, ...]) -> bool:
    """Return whether plies have B ≠ 0: they are not symmetric about the middle."""
    stretching, mixed, _ = resultants(plies)
    return bool(np.abs(mixed).max() > ROUNDING * np.abs(stretching).max())


def misfit(layers: tuple[Layer, ...], sheet: Sheet, material: Material) -> str:
    """Return the reason why layers do not fit a sheet and its material, "" if they fit."""
    total = sum(layer.thickness for layer in layers)
    if abs(total - sheet.thickness) > ROUNDING * sheet.thickness:
        return f"layer: thicknesses add up to {total:g} m; the sheet's is {sheet.thickness:g} m"
    if material.law is not None:
        return f"layer: material.law = '{material.law}': layers need a linear material"
    return ""
