"""Sheets given by their stiffnesses, as cloth is measured: [material] kind = "stiffness".

    membrane = { x = 1e4, y = 1e4, shear = 1e3 }     A11, A22, A66 [N/m], coupling A12
    bending = { x = 2e-6, y = 1e-6 }                 D11, D22, D66 [N·m], coupling D12
    area_density = "150 g/m²"

A number is x and y at once. Coupling is ν √(x y) and shear (1 − ν) √(x y)/2 unless given, ν the `poisson` of
the material, 0 unless given. A scene replaces it by a laminate with the given stiffnesses to rounding, of
thickness h with a core of c h: with a = A/h and d = 12 D/h³,

    (1 − c) Qo + c Qi = a,    (1 − c³) Qo + c³ Qi = d,    Qo = (d − c² a)/(1 − c²),  Qi = (a − (1 − c) Qo)/c,

and Qo and Qi are positive definite if the eigenvalues of a⁻¹ d lie between c² and 1 + c + c². The thickness
is the sheet's or, if it has none, makes the largest eigenvalue 1. The transverse shear modulus is
G = max(A11, A22)/h, to which thin sheets are insensitive.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from sheetbench.scenes.language.units import numbers
from sheetbench.scenes.objects.orthotropy import NEEDED
from sheetbench.scenes.objects.quantities import Frozen, Number, Positive

KEYS = ("membrane", "bending", "area_density")
ONE_LAYER = 1e-9  # of the eigenvalues, within which one layer has both stiffnesses


class Stiffnesses(Frozen):
    """Membrane or bending stiffness: along x, along y, their coupling, and in shear or twist."""

    x: Positive
    """A11 or D11."""
    y: Positive
    """A22 or D22."""
    coupling: Number | None = None
    """A12 or D12; ν √(x y) unless given."""
    shear: Positive | None = None
    """A66 or D66; (1 − ν) √(x y)/2 unless given."""

    def form(self, poisson: float) -> np.ndarray:
        """Return the stiffness (3, 3) over (x, y, xy)."""
        mean = (self.x * self.y) ** 0.5
        mixed = poisson * mean if self.coupling is None else self.coupling
        shear = 0.5 * (1.0 - poisson) * mean if self.shear is None else self.shear
        return np.array([[self.x, mixed, 0.0], [mixed, self.y, 0.0], [0.0, 0.0, shear]])


def as_laminate(data: Mapping[str, Any], material: Any) -> dict[str, Any]:
    """Return a scene's keys with thickness, orthotropic material and layers in place of the stiffnesses.
    Raises ValueError for stiffnesses that no laminate has."""
    replaced = (*KEYS, "poisson", "kind")
    rest = {key: value for key, value in dict(data["material"]).items() if key not in replaced}
    sheet = dict(data["sheet"]) if isinstance(data.get("sheet"), Mapping) else data["sheet"].model_dump()
    membrane, bending = material.stiffness("membrane"), material.stiffness("bending")
    for key, form in (("membrane", membrane), ("bending", bending)):
        if np.linalg.eigvalsh(form)[0] <= 0.0:
            raise ValueError(f"material.{key}: coupling² must be below x·y, or stretching would give energy")
    root = np.linalg.inv(np.linalg.cholesky(membrane))
    ratios = 12.0 * np.linalg.eigvalsh(root @ bending @ root.T)  # h² times the eigenvalues of a⁻¹ d
    thickness = _thickness(sheet, float(ratios[-1]))
    low, high = (float(one) / thickness**2 for one in ratios[[0, -1]])
    stretching, bent = membrane / thickness, 12.0 * bending / thickness**3
    core = (0.5 * min(low, 1.0)) ** 0.5
    if high >= 1.0 + core + core**2:
        raise ValueError(
            f"sheet.thickness = {thickness:g} m: too thin for that bending stiffness beside that membrane's; "
            f"at least {float(ratios[-1]) ** 0.5:.3g} m, which is taken where no thickness is given"
        )
    shear = float(np.diag(stretching)[:2].max())
    density = float(material.area_density) / thickness
    across = {"shear_13": shear, "shear_23": shear}
    more = {"kind": "orthotropic", "density": density, **across}
    layers = list(data.get("layer", data.get("layers", ())))
    if layers:
        raise ValueError("layer: of a material of kind = 'stiffness' layers follow; leave one out")
    outer = (bent - core**2 * stretching) / (1.0 - core**2)
    inner = (stretching - (1.0 - core) * outer) / core
    if high - low < ONE_LAYER and abs(high - 1.0) < ONE_LAYER:
        single = {**rest, **more, **_constants(stretching)}
        return {**data, "sheet": {**sheet, "thickness": thickness}, "material": single}
    sides = {"thickness": 0.5 * (1.0 - core) * thickness}
    middle = {"thickness": thickness - 2.0 * sides["thickness"], **across, **_constants(inner)}
    laminate = {**data, "sheet": {**sheet, "thickness": thickness}, "layer": [sides, middle, sides]}
    return {**laminate, "material": {**rest, **more, **_constants(outer)}}


def _thickness(sheet: Mapping[str, Any], ratio: float) -> float:
    if sheet.get("thickness") is None:
        return float(ratio**0.5)
    given = numbers(sheet, {"thickness": "m"})
    if not given or given["thickness"] <= 0.0:
        raise ValueError(f"sheet.thickness = {sheet['thickness']!r}: must be a length greater than 0")
    return given["thickness"]


def _constants(form: np.ndarray) -> dict[str, float]:
    """Return the constants of a ply with a plane-stress stiffness (3, 3) [Pa]."""
    (along, mixed), (_, across) = np.linalg.inv(form[:2, :2])  # 1/E₁, −ν₁₂/E₁ and 1/E₂
    values = 1.0 / along, 1.0 / across, 0.0 - mixed / along, form[2, 2]
    return dict(zip(NEEDED, map(float, values), strict=True))
