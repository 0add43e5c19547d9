"""Orthotropic materials: the constants of a ply in its own axes, and the conditions that they must satisfy.

Axis 1 lies in the plane at an `angle` [rad] from x towards y, axis 2 across it in the plane, axis 3 is the
normal. The compliances are, with ν₂₁ = ν₁₂ E₂/E₁,

    ε₁ = σ₁/E₁ − ν₁₂ σ₂/E₁ − ν₁₃ σ₃/E₁,   ε₂ = −ν₁₂ σ₁/E₁ + σ₂/E₂ − ν₂₃ σ₃/E₂,   γ_ij = τ_ij/G_ij.

The energy of a sheet without normal stress is positive if all moduli are and 1 − ν₁₂² E₂/E₁ > 0; in space the
3 × 3 matrix of 1/E and ν/E must be positive definite.
Source: R. M. Jones, Mechanics of Composite Materials (1999), 2.3 and 2.4.
"""

from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

import numpy as np
from pydantic import Field

from sheetbench.scenes.objects.quantities import Frozen, Modulus, Number, Unit

NEEDED = ("young_1", "young_2", "poisson_12", "shear_12")
MODULI = ("young_1", "young_2", "young_3", "shear_12", "shear_13", "shear_23")
THROUGH = ("poisson_13", "poisson_23")
KEYS = (*NEEDED, "shear_13", "shear_23", "young_3", *THROUGH, "angle")
KIND = "kind = 'orthotropic'"
FIBRES = f"material.{KIND}"
LARGEST_POISSON = 0.49  # of the isotropic material that stands for one with fibres


class Fibres(Frozen):
    """The constants of a material or a layer with fibres, in its plane and across it."""

    young_1: Modulus | None = Field(default=None, kw_only=True)
    """Young's modulus along axis 1, the direction of the fibres: orthotropic."""
    young_2: Modulus | None = Field(default=None, kw_only=True)
    """Young's modulus across them, in the plane: orthotropic."""
    poisson_12: Number | None = Field(default=None, kw_only=True)
    """Poisson's ratio: contraction along 2 when pulled along 1; its square is below young_1/young_2."""
    shear_12: Modulus | None = Field(default=None, kw_only=True)
    """Shear modulus in the plane: orthotropic."""
    shear_13: Modulus | None = Field(default=None, kw_only=True)
    """Transverse shear modulus along 1; shear_12 unless given."""
    shear_23: Modulus | None = Field(default=None, kw_only=True)
    """Transverse shear modulus along 2; shear_12 unless given."""
    expansion: Annotated[Number | tuple[Number, Number], Unit("1/K")] | None = Field(
        default=None, kw_only=True
    )
    """Thermal expansion, or [along axis 1, across it]; see [temperature]."""

    @property
    def expansions(self) -> tuple[float, float] | None:
        """Return the expansion along axis 1 and across it [1/K], None if it is not given."""
        return self.expansion if isinstance(self.expansion, tuple | None) else 2 * (self.expansion,)


class Ply(NamedTuple):
    """A ply of a laminate. low, high: heights of its faces over the thickness, −½ to ½. Constants, angle
    [rad] of axis 1 from x and density [kg/m³] are numbers, or arrays over points or cells."""

    low: float
    high: float
    young_1: Any
    young_2: Any
    young_3: Any
    poisson_12: Any
    poisson_13: Any
    poisson_23: Any
    shear_12: Any
    shear_13: Any
    shear_23: Any
    angle: Any
    density: Any


def in_own_axes(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the constants of a ply from the keys of a material, patch or layer. A missing constant of an
    orthotropic material is taken from another axis; `young` and `poisson` are the constants of an isotropic
    material."""
    constants = {key: value for key, value in given.items() if key in Ply._fields}
    if "young_1" in given:
        shear, poisson = dict.fromkeys(("shear_13", "shear_23"), given["shear_12"]), given["poisson_12"]
        usual = {"young_3": given["young_2"], **shear, **dict.fromkeys(THROUGH, poisson)}
    elif "young" in given:
        young, poisson = given["young"], given["poisson"]
        usual = dict.fromkeys(MODULI[:3], young) | dict.fromkeys(("poisson_12", *THROUGH), poisson)
        usual |= dict.fromkeys(MODULI[3:], young / (2.0 * (1.0 + poisson)))
    else:
        return constants
    return {**usual, "angle": 0.0, **constants}


def like_isotropic(given: Mapping[str, float]) -> tuple[float, float]:
    """Return E = √(E₁ E₂) and ν = √(ν₁₂ ν₂₁), scales of an orthotropic material that no model solves with."""
    young = (given["young_1"] * given["young_2"]) ** 0.5
    poisson = given["poisson_12"] * (given["young_2"] / given["young_1"]) ** 0.5
    return young, min(max(poisson, -LARGEST_POISSON), LARGEST_POISSON)


def impossible(given: Mapping[str, Any]) -> str:
    """Return the reason why an orthotropic material's given constants are impossible, "" if possible."""
    if missing := [key for key in NEEDED if key not in given]:
        return f"{KIND}: {', '.join(missing)} missing; it takes {', '.join(NEEDED)}"
    poisson, ratio = given["poisson_12"], given["young_1"] / given["young_2"]
    if poisson**2 >= ratio:
        return (
            f"poisson_12 = {poisson:g}: its square must be below young_1/young_2 = {ratio:.4g}, "
            "or stretching would give energy"
        )
    through = {"young_3", *THROUGH} & given.keys()
    return impossible_in_space(Ply(-0.5, 0.5, **{"density": 0.0, **in_own_axes(given)})) if through else ""


def impossible_in_space(ply: Ply) -> str:
    """Return the reason why a ply's constants of all three axes are impossible, "" if they are possible."""
    e1, e2, e3, n12, n13, n23 = ply[2:8]
    mixed = np.array([[0.0, n12 / e1, n13 / e1], [0.0, 0.0, n23 / e2], [0.0, 0.0, 0.0]])
    compliance = np.diag([1.0 / e1, 1.0 / e2, 1.0 / e3]) - mixed - mixed.T
    scale = np.sqrt(np.diag(compliance))
    if np.linalg.eigvalsh(compliance / np.outer(scale, scale))[0] > 0.0:
        return ""
    return (
        f"poisson_12 = {n12:g}, poisson_13 = {n13:g}, poisson_23 = {n23:g}: with young_1 = {e1:g}, "
        f"young_2 = {e2:g}, young_3 = {e3:g} Pa some strain would give energy; poisson_13 and poisson_23 are "
        "poisson_12 and young_3 is young_2 unless given"
    )
