"""Linear buckling of shell and solid (`sheetbench.numerics.continuation.buckling`).

The plate's strains are linear, so that its stiffness does not depend on the load.
"""

import numpy as np

from fem_reference.discrete.static import Static, StaticState
from fem_reference.sheets import SHEETS
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.answers.modes import STILL, Buckling, require_flat_and_dead
from sheetbench.choices import STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.buckling import buckling_modes
from sheetbench.scenes import AnyScene, require_static, scene_of


def buckling(scene: AnyScene, model: str = "shell", elements: Elements = 16, count: int = 1) -> Buckling:
    """Return the lowest load factors at which a flat shell or solid buckles, and the shapes.

    Parameters
    ----------
    scene : Scene, str or path
        A scene with dead loads, the name of one in the catalogue, or a scene file.
    model : {"shell", "solid"}
        The reference model.
    elements : int or (int, int)
        Number of elements along the shorter side, or along x and y.
    count : int
        Number of load factors.

    Returns
    -------
    Buckling
        Factors of the scene's loads (count,) and shapes; `displacement(points)` gives them at plan points
        [m].

    Raises
    ------
    BadInput
        For the plate, loads that follow the sheet, obstacles or actuators, as `lumped.buckling` does.

    Examples
    --------
    >>> import fem_reference
    >>> from sheetbench.scenes import load
    >>> on_edge = load("one-edge-clamped").replace(gravity={"acceleration": (0.0, -9.81, 0.0)})
    >>> fem_reference.buckling(on_edge, elements=2).load_factors.shape
    (1,)
    """
    require_static(scene := scene_of(scene), "buckling")
    require_flat_and_dead(scene)
    if model not in ("shell", "solid"):
        raise BadInput(f"model = {model!r}: no buckling, its strains are linear; choose shell or solid")
    started, counts = now(), divisions(scene.sheet, elements)
    sheet = SHEETS[model](scene, counts, law=scene.material.law or STRAIN_LAW)
    smallest = STILL * max(scene.sheet.lengths)

    def middles(state: StaticState) -> np.ndarray:
        return sheet.middles(sheet.displacement(state.q))

    load_factors, states = buckling_modes(Static(sheet), sheet.solver(), middles, count, smallest)
    shapes = [sheet.displacement(state.q) for state in states]
    return Buckling(
        model=model,
        label=f"{model} {counts[0]} × {counts[1]}",
        settings={"elements": list(counts)},
        load_factors=load_factors,
        unknowns=sheet.unknowns,
        seconds=now() - started,
        displacement=lambda points: np.stack([sheet.sample(shape, points) for shape in shapes]),
    )
