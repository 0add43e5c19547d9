"""Scenes of the study of drawn sheets: five of the catalogue, and ten of soft sheets that bend far."""

from typing import Any

from sheetbench.scenes import Scene, load

CATALOGUE = ("ray-fin", "kirigami-strip", "fabric-square", "pouch", "gripper-finger")
OBLIQUE = {  # rims that are not along the axes
    "ray-fin",
    "gripper-finger",
    "round-hole",
    "two-round-holes",
    "parallelogram",
    "octagon",
    "disc-held",
}


def _rectangle(x0: float, x1: float, y0: float, y1: float) -> dict[str, Any]:
    return {"shape": {"rectangle": {"x": [x0, x1], "y": [y0, y1]}}}


def _disc(x: float, y: float, radius: float) -> dict[str, Any]:
    return {"shape": {"circle": {"centre": [x, y], "radius": radius}}}


def _scene(
    name: str,
    *cutouts: dict[str, Any],
    size: tuple[float, float] = (0.2, 0.1),
    edges: str = "x0",
    **keys: Any,
) -> Scene:
    """Return a sheet of 3 mm and 5 MPa under its weight, clamped at edges. keys: outline, support."""
    outline = keys.pop("outline", None)
    sheet = {"length_x": size[0], "length_y": size[1], "thickness": 3e-3}
    return Scene.model_validate(
        {
            "name": name,
            "sheet": sheet if outline is None else {**sheet, "outline": outline},
            "material": {"young": 5e6, "poisson": 0.45, "density": 1e3},
            "gravity": {"acceleration": [0.0, 0.0, -9.81]},
            "support": [{"kind": "clamped", "edge": edge} for edge in edges.split()],
            "cutout": list(cutouts),
            **keys,
        }
    )


def drawn() -> list[Scene]:
    """Return ten sheets: five with rims along the axes, then five with oblique and round ones."""
    square = (0.15, 0.15)
    held = {"kind": "clamped", "where": _disc(0.06, 0.06, 0.02)["shape"]}
    return [
        _scene("hole-on-lines", _rectangle(0.05, 0.1, 0.025, 0.075)),
        _scene("hole-off-lines", _rectangle(0.053, 0.101, 0.027, 0.073)),
        _scene("l-shape", outline=[[0, 0], [0.2, 0], [0.2, 0.05], [0.1, 0.05], [0.1, 0.1], [0, 0.1]]),
        _scene(
            "window",
            _rectangle(0.03, 0.07, 0.04, 0.11),
            _rectangle(0.095, 0.125, 0.04, 0.11),
            size=square,
            edges="x0 y0",
        ),
        _scene("notch", _rectangle(0.07, 0.11, 0.06, 0.1)),
        _scene("round-hole", _disc(0.083, 0.047, 0.03)),
        _scene(
            "two-round-holes", _disc(0.05, 0.06, 0.02), _disc(0.11, 0.1, 0.025), size=square, edges="x0 y0"
        ),
        _scene("parallelogram", outline=[[0, 0], [0.13, 0], [0.2, 0.1], [0.07, 0.1]], edges="y0"),
        _scene(
            "octagon",
            outline=[
                [0, 0.045], [0.045, 0], [0.105, 0], [0.15, 0.045],
                [0.15, 0.105], [0.105, 0.15], [0.045, 0.15], [0, 0.105],
            ],
            size=square,
        ),
        _scene("disc-held", size=(0.12, 0.12), edges="", support=[held]),
    ]  # fmt: skip


def drawn_sheets() -> list[Scene]:
    """Return all fifteen scenes."""
    return [*(load(name) for name in CATALOGUE), *drawn()]
