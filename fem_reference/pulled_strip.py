"""A strip pulled along its sides, free to contract."""

from __future__ import annotations

from sheetbench.scenes import EdgeLoad, Held, Material, Scene, Sheet

SHEET = Sheet(length_x=0.2, length_y=0.1, thickness=0.01)
MATERIAL = Material(young=1e6, poisson=0.3, density=1000.0)


def pulled(pulls: tuple[float, float], sheet: Sheet = SHEET, material: Material = MATERIAL) -> Scene:
    """A strip free to contract, under forces per length [N/m] on x1 along x and on y1 along y."""
    held = (Held(edge="x0", components=("x", "z")), Held(edge="y0", components=("y", "z")))
    along_x = EdgeLoad(edge="x1", force_per_length=(pulls[0], 0.0, 0.0))
    along_y = EdgeLoad(edge="y1", force_per_length=(0.0, pulls[1], 0.0))
    return Scene(name="pulled", sheet=sheet, material=material, supports=held, loads=(along_x, along_y))
