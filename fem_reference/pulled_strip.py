"""A strip pulled along its sides, free to contract: a scene, and how a law of strain bends its course.

Pulled one way by the force P per area of the unstrained section it is stretched by ε,
P = E ε (1 + c ε + …); the laws' whole courses are in `fem_reference.verification.strain_laws`.
"""

from __future__ import annotations

from sheetbench.scenes import EdgeLoad, Held, Material, Scene, Sheet

SHEET = Sheet(length_x=0.2, length_y=0.1, thickness=0.01)
MATERIAL = Material(young=1e6, poisson=0.3, density=1000.0)


def curving(law: str, poisson: float) -> float:
    """c of P = E ε (1 + c ε + …) one way."""
    neo = (1.0 - 2.0 * poisson**3) / (1.0 + poisson) - 1.5
    return {"biot": 0.0, "st-venant-kirchhoff": 1.5, "neo-hookean": neo}[law]


def pulled(pulls: tuple[float, float], sheet: Sheet = SHEET, material: Material = MATERIAL) -> Scene:
    """A strip free to contract, under forces per length [N/m] on x1 along x and on y1 along y."""
    held = (Held(edge="x0", components=("x", "z")), Held(edge="y0", components=("y", "z")))
    along_x = EdgeLoad(edge="x1", force_per_length=(pulls[0], 0.0, 0.0))
    along_y = EdgeLoad(edge="y1", force_per_length=(0.0, pulls[1], 0.0))
    return Scene(name="pulled", sheet=sheet, material=material, supports=held, loads=(along_x, along_y))
