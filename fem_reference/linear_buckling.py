"""Linear buckling of shell and solid (`sheetbench.numerics.continuation.buckling`).

The plate's strains are linear, and so its stiffness is the same under every load.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fem_reference.shell import statics as shell
from fem_reference.solid import statics as solid
from fem_reference.surface.location import interpolate
from fem_reference.surface.mesh import Elements, divisions, mesh_of
from sheetbench.choices import STRAIN_LAW
from sheetbench.clock import now
from sheetbench.errors import BadInput
from sheetbench.numerics.continuation.buckling import buckling_modes
from sheetbench.numerics.direct import DirectSolver
from sheetbench.scenes import AnyScene, require_static, scene_of
from sheetbench.scenes.modes import STILL, Buckling, require_flat_and_dead


def buckling(scene: AnyScene, model: str = "shell", elements: Elements = 16, count: int = 1) -> Buckling:
    """The `count` lowest factors of a scene's dead loads at which a flat shell or solid buckles, and their
    shapes. Raises what `lumped.buckling` does, and BadInput for the plate.

    >>> import fem_reference
    >>> from sheetbench.scenes import load
    >>> on_edge = load("one-edge-clamped").replace(gravity={"acceleration": (0.0, -9.81, 0.0)})
    >>> fem_reference.buckling(on_edge, elements=2).load_factors.shape
    (1,)
    """
    require_static(scene := scene_of(scene))
    require_flat_and_dead(scene)
    begin, counts = now(), divisions(scene.sheet, elements)
    law = scene.material.law or STRAIN_LAW
    structure: Any
    if model == "shell":
        mesh = mesh_of(scene, counts, graded=True)
        structure, _ = shell.discretise(mesh, scene, law=law)
        solver = DirectSolver(fronts=structure.fronts)

        def surface(state: Any) -> np.ndarray:
            return state.change[0]

        def sample(state: Any, points: np.ndarray) -> np.ndarray:
            return interpolate(mesh, structure.element_nodes, state.change[0], points)

    elif model == "solid":
        structure = solid.discretise(solid.plan_mesh(scene, counts, "edges"), scene, law=law)
        solver, columns = DirectSolver(), structure.columns

        def surface(state: Any) -> np.ndarray:
            return state.displacement[:, columns.layers]

        def sample(state: Any, points: np.ndarray) -> np.ndarray:
            return columns.sample(state.displacement, points)

    else:
        raise BadInput(f"model = {model!r}: buckling is of shell and solid; the plate's strains are linear")
    factors, states = buckling_modes(structure, solver, surface, count, STILL * max(scene.sheet.lengths))
    return Buckling(
        model=model,
        label=f"{model} {counts[0]} × {counts[1]}",
        settings={"elements": list(counts)},
        load_factors=factors,
        unknowns=structure.unknowns,
        seconds=now() - begin,
        displacement=lambda points: np.stack([sample(state, points) for state in states]),
    )
