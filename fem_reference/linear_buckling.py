"""Linear buckling of shell and solid (`sheetbench.numerics.continuation.buckling`).

The plate's strains are linear, and so its stiffness is the same under every load.
"""

from __future__ import annotations

import numpy as np

from fem_reference.discrete.static import Static
from fem_reference.sheets import SHEETS
from fem_reference.surface.mesh import Elements, divisions
from sheetbench.answers.modes import STILL, Buckling, require_flat_and_dead
from sheetbench.choices import STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.buckling import buckling_modes
from sheetbench.scenes import AnyScene, require_static, scene_of


def buckling(scene: AnyScene, model: str = "shell", elements: Elements = 16, count: int = 1) -> Buckling:
    """The `count` lowest factors of a scene's dead loads at which a flat shell or solid buckles, and their
    shapes. Raises what `lumped.buckling` does, and BadInput for the plate.

    >>> import fem_reference
    >>> from sheetbench.scenes import load
    >>> on_edge = load("one-edge-clamped").replace(gravity={"acceleration": (0.0, -9.81, 0.0)})
    >>> fem_reference.buckling(on_edge, elements=2).load_factors.shape
    (1,)
    """
    require_static(scene := scene_of(scene), "buckling")
    require_flat_and_dead(scene)
    if model not in ("shell", "solid"):
        raise BadInput(f"model = {model!r}: buckling is of shell and solid; the plate's strains are linear")
    begin, counts = now(), divisions(scene.sheet, elements)
    sheet = SHEETS[model](scene, counts, law=scene.material.law or STRAIN_LAW)
    smallest = STILL * max(scene.sheet.lengths)
    found, states = buckling_modes(
        Static(sheet),
        sheet.solver(),
        lambda state: sheet.middles(sheet.displacement(state.q)),
        count,
        smallest,
    )
    shapes = [sheet.displacement(state.q) for state in states]
    return Buckling(
        model=model,
        label=f"{model} {counts[0]} × {counts[1]}",
        settings={"elements": list(counts)},
        load_factors=found,
        unknowns=sheet.unknowns,
        seconds=now() - begin,
        displacement=lambda points: np.stack([sheet.sample(shape, points) for shape in shapes]),
    )
