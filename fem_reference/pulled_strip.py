"""A strip pulled along its sides, free to contract: a scene, and how a law of strain bends its course.

Pulled one way by the force P per area of the unstrained section it is stretched by ε,
P = E ε (1 + c ε + …); the laws' whole courses are in `fem_reference.verification.strain_laws`. Of a rubber
(`sheetbench.scenes.objects.material`) ⅓ c E is what its energy has of ε³ where the strip contracts by ν ε:

    2 f″ p₁ p₂ + ⁴⁄₃ f‴ p₁³ + 2 c₀₁ (p₁ p₂ − p₃) − ⅓ m p₃ − ½ Λ p₁ p₂,     p_n = 1 + 2 (−ν)ⁿ.
"""

from __future__ import annotations

from sheetbench.choices import STRAIN_LAWS
from sheetbench.scenes import EdgeLoad, Held, Material, Scene, Sheet
from sheetbench.scenes.objects.material import Energy

SHEET = Sheet(length_x=0.2, length_y=0.1, thickness=0.01)
MATERIAL = Material(young=1e6, poisson=0.3, density=1000.0)


def laws_of(material: Material) -> list[str]:
    """Names of the laws that a material may be given: those of any, and its own."""
    own = material.law
    return [*STRAIN_LAWS, own] if own is not None and own not in STRAIN_LAWS else list(STRAIN_LAWS)


def curving(law: str, material: Material) -> float:
    """c of P = E ε (1 + c ε + …) one way, of one of `laws_of` the material."""
    if law in ("biot", "st-venant-kirchhoff"):
        return 0.0 if law == "biot" else 1.5
    young, poisson = material.young, material.poisson
    energy = material.energy if law == material.law else Energy(young / (4.0 * (1.0 + poisson)))
    first, second, third = (1.0 + 2.0 * (-poisson) ** n for n in (1, 2, 3))
    bend = 6.0 * energy.c30 + (2.0 * energy.c10 / energy.limit**2 if energy.limit else 0.0)  # f‴(0)
    cubic = 2.0 * energy.stiffening * first * second + 4.0 / 3.0 * bend * first**3
    cubic += 2.0 * energy.c01 * (first * second - third) - 0.5 * energy.volume(poisson) * first * second
    return 3.0 / young * (cubic - (2.0 * energy.c10 + 4.0 * energy.c01) * third / 3.0)


def pulled(pulls: tuple[float, float], sheet: Sheet = SHEET, material: Material = MATERIAL) -> Scene:
    """A strip free to contract, under forces per length [N/m] on x1 along x and on y1 along y."""
    held = (Held(edge="x0", components=("x", "z")), Held(edge="y0", components=("y", "z")))
    along_x = EdgeLoad(edge="x1", force_per_length=(pulls[0], 0.0, 0.0))
    along_y = EdgeLoad(edge="y1", force_per_length=(0.0, pulls[1], 0.0))
    return Scene(name="pulled", sheet=sheet, material=material, supports=held, loads=(along_x, along_y))
